"""Masks and letters go on beyond the frame: what is moved into it is what a larger picture has there."""

from __future__ import annotations

import numpy as np
import pytest
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Filter, RotoShape, catalogue, join_points, name_roto_shapes

NODES = catalogue()
WIDTH, HEIGHT = 96, 64
MARGIN = (30, 25)
LARGE = (WIDTH + 2 * MARGIN[0], HEIGHT + 2 * MARGIN[1])
CORNERS = np.array([(-30.0, 10.0), (60.0, -20.0), (120.0, 50.0), (40.0, 90.0)])
"""In pixels of the frame: each side of it is crossed."""


def draw_roto(origin: np.ndarray, size: tuple[int, int], feather: float) -> Filter:
    points = join_points(map(tuple, ((CORNERS + origin) / size).tolist()))
    return NODES["roto"](shapes=name_roto_shapes(a=RotoShape(points=points, feather=feather / size[1])))


def draw_text(origin: np.ndarray, size: tuple[int, int], outline: float) -> Filter:
    anchor = tuple((np.array([0.5 * WIDTH, 0.5 * HEIGHT]) + origin) / size)
    return NODES["text"](text="Halation", anchor=anchor, size=30.0 / size[1], outline_width=outline / size[1])


@pytest.mark.parametrize("way", [(1, 1), (-1, -1), (1, -1)])
@pytest.mark.parametrize(("make", "soft"), [(draw_roto, 0.0), (draw_roto, 6.0), (draw_text, 0.0), (draw_text, 2.0)])
def test_what_was_drawn_outside_is_moved_into_the_frame(run, make, soft: float, way: tuple[int, int]) -> None:
    def render(node: Filter, size: tuple[int, int], overscan: float, by: np.ndarray) -> np.ndarray:
        graph = Graph(settings=Settings(size, overscan=overscan)).add("drawn", node).add_output("out", Output())
        graph = graph.add("move", NODES["transform"](position=tuple(map(float, by)), kernel="nearest"))
        graph = graph.connect(Port("drawn", "out"), Port("move", "image"))
        return run(graph.connect(Port("move", "out"), Port("outputs", "out")), size=size)

    by = np.array(way) * MARGIN
    moved = render(make(np.zeros(2), (WIDTH, HEIGHT), soft), (WIDTH, HEIGHT), 0.5, by)
    across, down = np.array(MARGIN) - by
    whole = render(make(np.array(MARGIN), LARGE, soft), LARGE, 0.0, np.zeros(2))
    np.testing.assert_allclose(moved, whole[down:, across:][:HEIGHT, :WIDTH], atol=1e-4)
    assert moved.any()
