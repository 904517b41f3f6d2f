"""The minimap is the graph made smaller: its boxes have the same proportions and distances, and a click goes there."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from drawn_shapes import Shape
from gui_screens import write_many_things
from imgui_bundle import imgui
from still_editor import StillEditor, open_still_editor

SIZE = 900.0, 700.0


def list_marks(still: StillEditor) -> tuple[tuple[float, float, float, float], list[Shape]]:
    """The box of the map, and what is drawn in it."""
    left, top, right, bottom = still.places["minimap"]
    inside = [
        shape
        for shape in still.pane.shapes.list_kinds("filled rect")
        if left < shape.points[0][0] and shape.points[1][0] < right and top < shape.points[0][1] < bottom
        and shape.points[1][1] < bottom and shape.points[1][0] - shape.points[0][0] < (right - left) / 2
    ]  # fmt: skip
    return (left, top, right, bottom), inside


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_nodes_have_their_places_on_the_map(tmp_path: Path, scale: float) -> None:
    path = write_many_things(tmp_path)
    with open_still_editor(tmp_path, path, size=SIZE, scale=scale, screen=(3000.0, 3000.0)) as still:
        still.show("Graph", 4)
        canvas = still.editor.canvas
        nodes = {
            place: box for place, box in still.places.items() if place.startswith("node ") and place != "node plate"
        }
        zoom = canvas.zoom * scale
        places = {name: ((box[0] + box[2]) / 2 / zoom, (box[1] + box[3]) / 2 / zoom) for name, box in nodes.items()}
        canvas.zoom, canvas.center = 3.0, (200.0, 100.0)
        still.show("Graph", 2)
        (left, top, right, bottom), marks = list_marks(still)
        assert len(marks) >= len(nodes)
        spots = [tuple(sum(axis) / 2 for axis in zip(*mark.points, strict=True)) for mark in marks]
        widest = max(math.dist(a, b) for a in places.values() for b in places.values())
        factor = max(math.dist(a, b) for a in spots for b in spots) / widest
        assert 0.0 < factor < 1.0
        anchor = min(places.values())
        origin = min(spots)
        for x, y in places.values():
            expected = origin[0] + (x - anchor[0]) * factor, origin[1] + (y - anchor[1]) * factor
            assert min(math.dist(expected, spot) for spot in spots) < 6.0 * scale
        assert all(left <= x <= right and top <= y <= bottom for x, y in spots)


@pytest.mark.parametrize("part", [(0.3, 0.3), (0.7, 0.6)])
def test_a_press_on_the_map_shows_what_is_there(tmp_path: Path, part: tuple[float, float]) -> None:
    """A node whose mark is pressed is in the middle of the panel."""
    path = write_many_things(tmp_path)
    with open_still_editor(tmp_path, path, size=SIZE) as still:
        still.show("Graph", 4)
        still.editor.canvas.zoom, still.editor.canvas.center = 3.0, (200.0, 100.0)
        still.show("Graph", 2)
        x, y = still.find_point("minimap", part)
        centers = list[tuple[float, float]]()
        for by in (0.0, 10.0, 20.0):
            still.editor.canvas.center = 200.0, 100.0
            still.pane.point((x + by, y + by / 2))
            still.show("Graph", 2)
            imgui.get_io().add_mouse_button_event(0, True)
            still.show("Graph", 1)
            centers.append(still.editor.canvas.center)
            imgui.get_io().add_mouse_button_event(0, False)
            still.show("Graph", 1)
        (x0, y0), (x1, y1), (x2, y2) = centers
        assert x0 < x1 < x2 and y0 < y1 < y2, "to the right and down is to the right and down"
        assert (y1 - y0) / (x1 - x0) == pytest.approx(0.5, abs=0.15), "both axes have one scale"
