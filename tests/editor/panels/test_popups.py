"""What a field opens lies below it, and all of it on the screen."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.graph import Graph
from halation.nodes import catalogue
from imgui_bundle import imgui
from still_editor import open_still_editor

SCREEN = 600.0, 700.0


@pytest.mark.parametrize(("node", "field"), [("constant", "color"), ("merge", "mode")])
@pytest.mark.parametrize("at", [(20.0, 30.0), (20.0, 400.0), (400.0, 400.0), (400.0, 30.0)])
def test_what_a_field_opens_is_on_the_screen(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, node: str, field: str, at: tuple[float, float]
) -> None:
    boxes = list[tuple[float, ...]]()
    end = imgui.end_popup

    def note() -> None:
        low, size = imgui.get_window_pos(), imgui.get_window_size()
        boxes.append((low.x, low.y, low.x + size.x, low.y + size.y))
        end()

    monkeypatch.setattr(imgui, "end_popup", note)
    graph = Graph().add("node", catalogue()[node]())
    with open_still_editor(tmp_path, graph, screen=SCREEN, size=(190.0, 350.0), at=at) as still:
        still.select("node")
        still.show("Inspector", 4)
        place = still.places[f"field node.{field}"]
        still.click("Inspector", f"field node.{field}", 0, (0.1, 0.5))
        still.show("Inspector", 6)
    left, top, right, bottom = boxes[-1]
    assert min(left, top) >= 0.0 and right <= SCREEN[0] and bottom <= SCREEN[1]
    if place[3] + bottom - top <= SCREEN[1] and place[0] + right - left <= SCREEN[0]:
        assert (left, top) == pytest.approx((place[0], place[3]), abs=1.0), "right below the field"
