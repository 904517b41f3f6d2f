"""What asks for a file writes it there, and a folder that no program shows can be pasted."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from gui_renders import list_renders
from halation import document
from halation.authoring.background.graph_export import ExportOutcome
from halation.authoring.commands import MakeGroup
from halation.editor.exporting import dialog as exporting
from halation.editor.renders import queue_view
from halation.graph import Group, Port
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui
from still_acts import make_graph
from still_editor import open_still_editor


def test_a_group_is_saved_and_linked_to_its_file(tmp_path: Path) -> None:
    """A name without an ending gets that of graphs; what is in the file is what is in the group."""
    with open_still_editor(tmp_path, make_graph()) as still:
        session, dialogs = still.editor.session, still.editor.dialogs
        still.select("bloom")
        session.apply(MakeGroup("look"))
        still.select("look")
        body = session.graph.nodes["look"]
        assert isinstance(body, Group)
        still.editor.actions.run("group.save")
        browse = dialogs.browse
        assert browse is not None and browse.saving and browse.purpose == "graph" and browse.name == "look.json"
        browse.then(tmp_path / "kept.txt")
        kept = document.load(tmp_path / "kept.json", sandbox=UNRESTRICTED)
        assert {*kept.nodes} == {"bloom"} == {*body.graph.nodes}
        linked = session.graph.nodes["look"]
        assert isinstance(linked, Group) and linked.path.endswith("kept.json")
        session.undo()
        assert session.graph.nodes["look"] == body, "the file stays, and the group is as before"


@pytest.mark.parametrize("action", ["file.save_as", "file.open", "file.open_render", "viewer.save", "group.save"])
def test_who_writes_asks_for_a_new_file_and_who_reads_for_one_that_is_there(tmp_path: Path, action: str) -> None:
    with open_still_editor(tmp_path, make_graph()) as still:
        still.editor.session.views.show(Port("outputs", "image"))
        still.show("Viewer", 2)
        still.compute()
        still.select("bloom")
        if action == "group.save":
            still.editor.session.apply(MakeGroup("look"))
            still.select("look")
        still.editor.actions.run(action)
        still.show("Viewer", 2)
        browse = still.editor.dialogs.browse
        assert browse is not None and browse.saving is ("save" in action) and bool(browse.name) is browse.saving


@pytest.mark.parametrize(
    ("name", "written"), [("page", "page.html"), ("page.html", "page.html"), ("page.htm", "page.htm")]
)
def test_an_export_gets_the_ending_of_its_kind_where_it_has_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, written: str
) -> None:
    exports = list[Path]()

    def begin(root: object, choices: object, output: Path, *more: object) -> SimpleNamespace:
        exports.append(output)
        return SimpleNamespace(outcome=ExportOutcome(), choices=choices, output=output, stop=bool)

    monkeypatch.setattr(exporting, "GraphExport", begin)
    with open_still_editor(tmp_path, make_graph()) as still:
        still.editor.dialogs.open.add("export")
        still.show("Export", 4)
        monkeypatch.setattr(imgui, "get_time", lambda: 1e3)  # the trial waits until nothing has changed for a while
        still.click("Export", "export write")
        browse = still.editor.dialogs.browse
        assert browse is not None and browse.saving
        browse.then(tmp_path / name)
        dialog = still.find("Export")
        assert isinstance(dialog, exporting.ExportDialog)
        dialog.close()
    assert exports[-1] == tmp_path / written


@pytest.mark.parametrize("is_shown", [True, False])
def test_a_folder_that_no_program_shows_is_on_the_clipboard(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_shown: bool
) -> None:
    opened = list[Path]()
    monkeypatch.setattr(queue_view, "show_folder", lambda folder: (opened.append(folder), is_shown)[1])
    with open_still_editor(tmp_path, make_graph()) as still:
        still.editor.exports.all = list_renders()
        still.show("Renders")
        imgui.set_clipboard_text("before")
        messages = len(still.editor.log.entries)
        place = next(place for place in still.places if place.startswith("open folder"))
        still.click("Renders", place)
        (folder,) = opened
        assert imgui.get_clipboard_text() == ("before" if is_shown else str(folder))
        assert len(still.editor.log.entries) - messages == (0 if is_shown else 1)
        assert is_shown or str(folder) in still.editor.log.entries[-1].sentence
