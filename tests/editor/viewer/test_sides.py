"""What the menus of the two sides of the viewer list is shown there, and on that side alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.graph import Port
from halation.nodes import catalogue
from still_acts import make_graph
from still_editor import StillEditor, open_still_editor


def open_menu(still: StillEditor, side: str) -> dict[str, tuple[float, float, float, float]]:
    still.click("Viewer", f"button viewer {side}")
    return {
        shape.text.rpartition("##")[2]: (*shape.points[0], *shape.points[1])
        for shape in still.pane.widgets
        if shape.kind == "menu_item" and "##" in shape.text
    }


@pytest.mark.parametrize("side", ["A", "B"])
def test_an_entry_is_shown_on_its_side(tmp_path: Path, side: str) -> None:
    with open_still_editor(tmp_path, make_graph(), size=(900.0, 900.0)) as still:
        session = still.editor.session
        session.views.show(Port("outputs", "image"), "A")
        session.views.show(Port("noise", "out"), "B")
        still.editor.viewer.compare = "wipe"
        still.show("Viewer", 3)
        ports = [Port(id, "out") for id in session.root.nodes if "out" in catalogue()[id].outputs]
        assert len(ports) > 2
        other = "B" if side == "A" else "A"
        kept = session.views.find_port(other)
        for port in ports:
            entries = open_menu(still, side)
            assert str(port) in entries, port
            still.pane.click(entries[str(port)], still.find("Viewer").draw)
            still.calm("Viewer")
            assert session.views.find_port(side) == port and session.views.find_port(other) == kept
