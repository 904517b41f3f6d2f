"""The slate in upright, square and wide pictures: nothing lies over anything else, and nothing leaves the frame."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from halation import document
from halation.graph import Port
from halation.presets import paths
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

SLATE = document.load(next(path for path in paths() if path.stem == "slate"), sandbox=UNRESTRICTED)
TEXTS = ("title", "shot", "facts", "note")
LONG = {"shot": "sq020_sh_0010_v012", "title": "The Long Way Back to the Harbor"}
"""Names that are wider than their columns at the size of the preset."""
MARGINS = (0.046, 0.954)
"""Where the lines of the slate begin and end, as parts of the width."""
SMALL = 0.42
"""The small picture relative to the frame."""
PIVOT = np.array([0.9207, 0.5224])
"""The point of the frame around which the picture is made small."""


def render(renderer: Renderer, size: tuple[int, int], beauty: float, texts: dict[str, str]) -> np.ndarray:
    graph = SLATE
    for name, text in texts.items():
        graph = graph.set(Port(name, "text"), text)
    picture = np.full((size[1], size[0], 4), beauty, np.float32)
    return renderer.render(graph, RenderRequest({"beauty": picture}, size=size))["image"]


def measure_box(differs: np.ndarray) -> np.ndarray:
    """The first and the last column and row of a mask, as parts of the picture: x, y, x, y."""
    rows, columns = np.nonzero(differs)
    height, width = differs.shape
    return np.array(
        [columns.min() / width, rows.min() / height, (columns.max() + 1) / width, (rows.max() + 1) / height]
    )


@pytest.mark.parametrize("size", [(480, 270), (270, 480), (320, 320), (640, 268)])
def test_parts_keep_apart_in_pictures_of_any_shape(renderer: Renderer, size: tuple[int, int]) -> None:
    empty = dict.fromkeys(TEXTS, "")
    black, white = (render(renderer, size, light, empty) for light in (0.0, 1.0))
    shown = np.abs(white - black).max(axis=-1)
    corners = np.concatenate([PIVOT * (1.0 - SMALL), PIVOT * (1.0 - SMALL) + SMALL])
    np.testing.assert_allclose(measure_box(shown > 0.5 * shown.max()), corners, atol=1.0 / min(size))
    letters = np.abs(render(renderer, size, 0.0, LONG) - black).max(axis=-1) > 0.02
    assert not (letters & (shown > 0.02)).any()
    left, _, right, _ = measure_box(letters)
    assert MARGINS[0] - 0.01 <= left and right <= MARGINS[1] + 0.01
    texts = {name: LONG.get(name) or str(SLATE.nodes[name].setting("text")) for name in TEXTS}
    drawn = {
        name: np.abs(render(renderer, size, 0.0, empty | {name: text}) - black).max(axis=-1)
        for name, text in texts.items()
    }
    for first, second in pairwise(TEXTS):
        assert not ((drawn[first] > 0.02) & (drawn[second] > 0.02)).any(), f"{first} lies over {second}"


@pytest.mark.parametrize("size", [(480, 270), (270, 480)])
def test_rule_and_gray_steps_go_from_margin_to_margin(renderer: Renderer, size: tuple[int, int]) -> None:
    picture = render(renderer, size, 0.0, dict.fromkeys(TEXTS, ""))
    for row in (0.245, 0.935):
        line = picture[int(row * size[1]), :, 0]
        ends = np.flatnonzero(line > 0.3)
        assert ends[-1] + 1 == round(MARGINS[1] * size[0])
    rule = np.flatnonzero(picture[int(0.245 * size[1]), :, 0] > 0.3)
    assert rule[0] == round(MARGINS[0] * size[0])
