"""Crosshatch: strokes cover what the tone asks for, lie where they should, and only ever become more."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.stylize.crosshatch import Crosshatch

BLACK_ON_WHITE = {"ink": (0.0, 0.0, 0.0, 1.0), "paper": (1.0, 1.0, 1.0, 1.0)}


def flat(tone: float, side: int = 120) -> np.ndarray:
    light = tone / 12.92 if tone <= 0.04045 else ((tone + 0.055) / 1.055) ** 2.4
    picture = np.ones((side, side, 4), np.float32)
    picture[..., :3] = light
    return picture


@pytest.mark.parametrize("layers", [1, 2, 4])
@pytest.mark.parametrize("tone", [0.0, 0.2, 0.55, 0.9, 1.0])
def test_strokes_cover_what_the_tone_asks_for(run, layers, tone):
    """Of layers in different directions, paper stays free by the product of what each leaves free."""
    node = Crosshatch(layers=layers, thickness=0.6, size=6.1, angle=33.0, **BLACK_ON_WHITE)
    free = run(node, {"image": flat(tone, 240)})[..., 0].mean()
    strokes = np.clip((1.0 - tone) * layers - np.arange(layers), 0.0, 1.0) * 0.6
    assert free == pytest.approx(np.prod(1.0 - strokes), abs=0.012)


@pytest.mark.parametrize("angle", [0.0, 45.0, -60.0])
def test_one_layer_equals_its_definition(run, angle):
    y, x = np.mgrid[:30, :40]
    free = np.zeros((30, 40))
    for i in range(9):
        px, py = (x + (i % 3 + 0.5) / 3) / 7.0, (y + (i // 3 + 0.5) / 3) / 7.0
        across = px * np.sin(np.radians(angle)) + py * np.cos(np.radians(angle))
        free += np.abs(across % 1.0 - 0.5) * 2.0 >= 0.3
    node = Crosshatch(layers=1, thickness=0.3, size=7.0, angle=angle, **BLACK_ON_WHITE)
    found = run(node, {"image": flat(0.0)[:30, :40]})[..., 0]
    error = np.abs(found - free / 9.0)
    assert (error > 1e-5).mean() <= 0.01 and error.max() <= 3.01 / 9.0


def test_strokes_of_lighter_tones_stay(run):
    before = np.ones((60, 60))
    for tone in (0.9, 0.7, 0.5, 0.3, 0.0):
        found = run(Crosshatch(**BLACK_ON_WHITE), {"image": flat(tone, 60)})[..., 0]
        assert (found <= before + 1e-6).all()
        before = found


def test_colors_and_alpha(run, hdr):
    picture = hdr(20, 14)
    found = run(Crosshatch(ink=(0.2, 0.1, 0.4, 1.0), paper=(0.2, 0.1, 0.4, 1.0)), {"image": picture})
    np.testing.assert_allclose(found[..., :3], np.array([0.2, 0.1, 0.4]) * picture[..., 3:], rtol=1e-5)
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])
    white = run(Crosshatch(paper=(1.0, 1.0, 1.0, 1.0)), {"image": np.full((9, 9, 4), 1.0)})
    np.testing.assert_allclose(white, 1.0)
