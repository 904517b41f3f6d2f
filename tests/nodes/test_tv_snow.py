"""Snow: its definition on numpy's own integers in 64 bits, and what a set's channel does to it."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Port
from halation.nodes.stylize.tv_snow import TvSnow
from halation.renderer import RenderRequest
from hashes import hash3, pcg3d

FRAME = 1


def encode(light: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decode(code: np.ndarray) -> np.ndarray:
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055).clip(0) ** 2.4)


def snow(node: TvSnow, width: int, height: int, frame: int = FRAME) -> np.ndarray:
    """The codes of the snow alone: [h, w, 3]."""
    y, x = ((np.mgrid[:height, :width] + 0.5) / max(node.size, 1.0)).astype(int)
    moment = np.full_like(y, frame // node.hold)
    if node.interlaced:
        moment = (moment + y % 2) // 2
    flakes, levels = (pcg3d(np.array([node.seed, number, 0], np.uint32)) for number in (0, 1))
    found = sum(part * hash3((x + tap, y, moment), flakes) for tap, part in ((-1, 0.25), (0, 0.5), (1, 0.25)))
    found = np.moveaxis(found - 0.5, 0, -1)
    found = node.color * found + (1 - node.color) * found[..., :1]
    level = (hash3((y, moment, 0), levels)[0] - 0.5)[..., None]
    fine = min(node.size, 1.0)
    return (0.5 + node.contrast * (fine * found + np.sqrt(fine) * node.lines * level)).clip(0, 1)


def gray(level: float, width: int, height: int) -> np.ndarray:
    picture = np.full((height, width, 4), level, np.float32)
    picture[..., 3] = 1.0
    return picture


def frames(renderer, node: TvSnow, picture: np.ndarray, *numbers: int) -> list[np.ndarray]:
    graph, targets = graph_of(node, {"image": picture}), {"out": Port("outputs", "out")}
    return [
        renderer.render(graph, RenderRequest({"image": picture}, targets, precision="float", frame=number))["out"]
        for number in numbers
    ]


@pytest.mark.parametrize("mode", ["mix", "multiply"])
@pytest.mark.parametrize(
    "values",
    [
        {},
        {"size": 1.0, "color": 0.7, "lines": 1.0, "seed": 5},
        {"size": 3.3, "interlaced": True, "amount": 1.0},
        {"size": 0.4, "lines": 0.0, "hold": 3, "contrast": 3.0},
    ],
)
def test_it_is_the_definition(run, hdr, mode, values):
    node, picture = TvSnow(mode=mode, **values), hdr(37, 26)
    code, flakes = encode(picture[..., :3].astype(np.float64) / picture[..., 3:]), snow(node, 37, 26)
    mixed = {"mix": code + node.amount * (flakes - code), "multiply": code * (1 + node.amount * (2 * flakes - 1))}
    found = run(node, {"image": picture})
    np.testing.assert_allclose(found[..., :3], decode(mixed[mode]) * picture[..., 3:], rtol=1e-4, atol=1e-6)
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


def test_a_line_is_band_limited_and_lines_are_strangers(run):
    """Three taps of white noise: 3/8 of its variance, correlations 2/3 and 1/6 along, none farther, none across."""
    node = TvSnow(amount=1.0, size=1.0, lines=0.0, contrast=1.0)
    code = encode(run(node, {"image": gray(0.5, 256, 256)})[..., 0].astype(np.float64))
    assert code.mean() == pytest.approx(0.5, abs=0.005) and code.var() == pytest.approx(3 / 8 / 12, rel=0.03)
    code = code - code.mean()
    for lag, expected in ((1, 2 / 3), (2, 1 / 6), (3, 0.0), (5, 0.0)):
        assert (code[:, lag:] * code[:, :-lag]).mean() / code.var() == pytest.approx(expected, abs=0.02)
        assert abs((code[lag:] * code[:-lag]).mean() / code.var()) < 0.02


def test_whole_lines_differ_as_much_as_asked(run):
    def spread(lines: float) -> float:
        node = TvSnow(amount=1.0, size=1.0, lines=lines, contrast=0.8)
        return float(encode(run(node, {"image": gray(0.5, 512, 256)})[..., 0]).mean(1).std())

    still, half = spread(0.0), spread(0.5)
    assert still < 0.02 and half == pytest.approx(0.8 * 0.5 * 12**-0.5, rel=0.1)


def test_color_is_on_demand(run):
    picture = gray(0.3, 64, 64)
    plain, colored = (run(TvSnow(color=color), {"image": picture}) for color in (0.0, 1.0))
    np.testing.assert_array_equal(plain[..., 0], plain[..., 2])
    assert np.abs(colored[..., 0] - colored[..., 2]).max() > 0.1


def test_fields_take_turns(renderer):
    """In the next frame only every second line is new, in the one after that the others are."""
    one, two, three = frames(renderer, TvSnow(interlaced=True, size=1.0), gray(0.3, 32, 32), 2, 3, 4)
    for first, then, kept in ((one, two, 0), (two, three, 1)):
        np.testing.assert_array_equal(first[kept::2], then[kept::2])
        assert (first[1 - kept :: 2] != then[1 - kept :: 2]).any(axis=(1, 2)).all()


def test_frames_differ_repeat_and_hold(renderer):
    one, again, next_ = frames(renderer, TvSnow(), gray(0.3, 24, 24), 6, 6, 7)
    assert np.array_equal(one, again) and not np.array_equal(one, next_)
    held = frames(renderer, TvSnow(hold=3), gray(0.3, 24, 24), 6, 8, 9)
    assert np.array_equal(held[0], held[1]) and not np.array_equal(held[1], held[2])


def test_a_proxy_averages(run):
    node = TvSnow(amount=1.0, lines=0.0, contrast=1.0)
    picture = {"image": gray(0.3, 256, 256)}
    full, half, quarter = (encode(run(node, picture, scale=scale)[..., 0].astype(float)) for scale in (1.0, 0.5, 0.25))
    np.testing.assert_allclose(half, full[::2, ::2], atol=1e-5)
    assert quarter.mean() == pytest.approx(full.mean(), abs=0.02)
    assert quarter.std() == pytest.approx(full.reshape(64, 4, 64, 4).mean((1, 3)).std(), rel=0.25)


def test_without_amount_it_vanishes():
    assert TvSnow(amount=0.0).identity() == "image" and TvSnow().identity() is None
