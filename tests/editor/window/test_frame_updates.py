"""What the window does before each frame: which files it watches, and what it does when one of them changes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from gui_screens import write_many_things
from halation.authoring.commands import AddNode, LinkCodeFile, SetValue
from halation.editor.window.frame_updater import OVER_BUDGET, FrameUpdater
from halation.graph import Port
from halation.nodes import catalogue
from halation.watch.reloading import shader_folder
from halation.watch.watching import FileChange, Kind
from msgspec.structs import replace
from still_editor import StillEditor, open_still_editor


@pytest.fixture
def still(tmp_path: Path) -> Iterator[StillEditor]:
    with open_still_editor(tmp_path, write_many_things(tmp_path)) as still:
        still.show("Viewer")
        yield still


@pytest.fixture
def updater(still: StillEditor) -> FrameUpdater:
    return FrameUpdater(still.editor, still.contexts)


def list_words(still: StillEditor) -> list[str]:
    return [entry.sentence for entry in still.editor.log.entries]


def record(patch: pytest.MonkeyPatch, place: object, name: str, seen: list[Any], answer: Any = None) -> None:
    """Write down calls of a method in place of it."""

    def note(*words: Any) -> Any:
        seen.append((name, *words))
        return answer

    patch.setattr(place, name, note, raising=False)


def test_the_files_of_the_graph_are_watched_and_named_anew_when_it_changes(monkeypatch, still, updater, tmp_path):
    seen: list[Any] = []
    record(monkeypatch, still.editor.watcher, "watch", seen)
    session = still.editor.session
    added = session.apply(AddNode("glsl"))
    (tmp_path / "tint.glsl").write_text(session.code_files.find_code(added).text)
    session.apply(LinkCodeFile(added, "tint.glsl"))
    updater.update()
    updater.update()
    assert len(seen) == 1, "the list of files is made when it may have changed, not in each frame"
    _, graph, _, pictures, shaders, nodes, code = seen[0]
    assert graph == session.path and shaders == [shader_folder()] and len(nodes) == 1
    assert {Path(path).name for path in pictures} >= {"studio.exr", "neon.exr"}
    assert [Path(path).name for path in code] == ["tint.glsl"]
    session.apply(SetValue(Port("plate", "path"), "samples/studio.exr"))
    updater.update()
    assert len(seen) == 2 and "neon.exr" not in {Path(path).name for path in seen[1][3]}


@pytest.mark.parametrize("kind", ["graph", "group", "picture", "code", "shader", "node"])
def test_what_another_program_has_written_is_read_again(monkeypatch, still, updater, kind: Kind) -> None:
    editor, seen = still.editor, list[Any]()
    path, documents, codes = Path("/elsewhere/changed.file"), SimpleNamespace(), SimpleNamespace()
    monkeypatch.setattr(updater, "_contexts", replace(still.contexts, documents=documents, code_files=codes))
    for place, names in (
        (documents, ("load_changed_file",)), (codes, ("reread",)), (editor.session.files, ("reload_groups",)),
        (editor.preview, ("refresh", "reload")), (editor.session.time, ("remeasure",)),
        (editor.session, ("migrate",)), (updater._nodes, ("reload",)),
    ):  # fmt: skip
        for name in names:
            record(monkeypatch, place, name, seen, "")
    monkeypatch.setattr(editor.watcher, "poll", lambda: [FileChange(kind, path, True)])
    updater.update()
    calls = {
        "graph": [("load_changed_file", path)], "group": [("reload_groups",)], "code": [("reread", path)],
        "picture": [("refresh",), ("remeasure",)],
    }  # fmt: skip
    words = {
        "picture": ["changed.file changed on disk and was read again"],
        "shader": ["shader changed.file was loaded again"], "node": ["node changed.file was loaded again"],
    }  # fmt: skip
    if kind in calls:
        assert seen == calls[kind]
    else:
        assert [name for name, *_ in seen] == {"shader": ["reload"], "node": ["reload", "migrate"]}[kind]
    assert list_words(still) == words.get(kind, [])


def test_a_node_that_cannot_be_read_says_so(monkeypatch, still, updater) -> None:
    monkeypatch.setattr(updater._nodes, "reload", lambda: "line 3 is no Python")
    monkeypatch.setattr(still.editor.watcher, "poll", lambda: [FileChange("node", Path("it.py"), True)])
    updater.update()
    assert [(entry.sentence, entry.level) for entry in still.editor.log.entries] == [("line 3 is no Python", "error")]


@pytest.mark.parametrize(
    ("kind", "said"),
    [("graph", "saving writes it again"), ("picture", "put it back"), ("group", "stays"), ("code", "stays"),
     ("shader", "loaded again")],
)  # fmt: skip
def test_a_file_that_is_gone_is_told_with_what_follows(monkeypatch, still, updater, kind: Kind, said: str) -> None:
    seen: list[Any] = []
    record(monkeypatch, still.editor.preview, "refresh", seen)
    record(monkeypatch, still.editor.session.time, "remeasure", seen)
    monkeypatch.setattr(still.editor.watcher, "poll", lambda: [FileChange(kind, Path("/a/gone.file"), False)])
    updater.update()
    (words,) = list_words(still)
    assert "gone.file" in words and said in words
    assert [name for name, *_ in seen] == (["refresh", "remeasure"] if kind == "picture" else [])


def test_pictures_over_the_budget_are_told_after_a_while_and_again_if_they_come_back(monkeypatch, still, updater):
    """A look once a second: a single picture may exceed the budget for a moment."""
    used, seconds = [0], [0.0]
    monkeypatch.setattr(type(still.editor.preview), "memory", property(lambda preview: (used[0], 2**20 * 512)))
    monkeypatch.setattr("halation.editor.window.frame_updater.imgui.get_time", lambda: seconds[0])

    def pass_second(is_over: bool) -> int:
        used[0], seconds[0] = 2**20 * (513 if is_over else 512), seconds[0] + 1.01
        updater.update()
        seconds[0] += 0.5
        updater.update()  # within the same second nothing is counted
        return sum("more memory than the budget of 512 MiB" in words for words in list_words(still))

    assert [pass_second(True) for _ in range(OVER_BUDGET + 2)] == [0] * (OVER_BUDGET - 1) + [1] * 3
    still.editor.log.entries.clear()
    assert pass_second(False) == 0
    assert [pass_second(True) for _ in range(OVER_BUDGET)] == [0] * (OVER_BUDGET - 1) + [1]


def test_classes_of_nodes_are_loaded_while_nothing_else_is_to_be_done(monkeypatch, still, updater) -> None:
    loads = updater._unloaded_nodes
    assert sorted(loads) == sorted(catalogue())
    monkeypatch.setattr(still.editor.preview, "work", lambda *budgets: True)
    updater.update()
    assert len(loads) == len(catalogue()) and updater.is_working, "pictures come first"
    monkeypatch.setattr(still.editor.preview, "work", lambda *budgets: False)
    still.editor.interface.dragging = True
    updater.update()
    assert len(loads) == len(catalogue()) and not updater.is_working, "a drag is not held up"
    still.editor.interface.dragging = False
    updater.update()
    assert len(loads) < len(catalogue())
    while updater.is_working:
        updater.update()
    assert not loads
