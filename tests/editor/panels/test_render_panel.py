"""Where the form for a render and the queue of renders lie in their panel."""

from __future__ import annotations

from pathlib import Path

import pytest
from gui_renders import list_renders
from halation import document
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import ImVec2, imgui
from still_acts import make_graph
from still_editor import open_still_editor


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize(("room", "is_beside"), [(758.0, False), (762.0, True), (1500.0, True)])
def test_the_queue_is_beside_the_form_where_there_is_room(
    tmp_path: Path, scale: float, room: float, is_beside: bool
) -> None:
    with open_still_editor(tmp_path, make_graph(), size=(1e3, 1e3), scale=scale, screen=(4e3, 4e3)) as still:
        still.editor.exports.all = list_renders()
        padding = imgui.get_style().window_padding.x
        still.pane.size = ImVec2(room * scale + 2.0 * padding, 1800.0 * scale)
        still.show("Renders", 5)
        left, _, _, bottom = still.places["render"]
        row_left, row_top, _, _ = still.places["export 0"]
        assert (row_left > left + 400.0 * scale and row_top < bottom) is is_beside
        assert (row_top > bottom) is not is_beside


def test_nothing_moves_when_the_first_file_is_written(tmp_path: Path) -> None:
    """Files that are there are counted below the form, while somebody is about to click on the render."""
    document.save(make_graph(), tmp_path / "shot.json", sandbox=UNRESTRICTED)
    with open_still_editor(tmp_path, tmp_path / "shot.json", size=(1200.0, 360.0)) as still:
        still.editor.store.note_folder("export", tmp_path / "x.exr")
        still.editor.exports.all = list_renders()[:1]
        still.show("Renders", 5)
        before, start = still.places["open folder 0"], still.places["render"]
        (tmp_path / "shot.exr").write_bytes(b"")
        for _ in range(90):  # the disk is looked at again after a second
            still.show("Renders", 1)
            assert still.places["open folder 0"] == before and still.places["render"] == start
        assert "render exists" in still.places
