"""Files that other programs have changed, and files that are dropped on the window."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from gui_screens import write_many_things
from halation import document
from halation.authoring.commands import AddNode, LinkCodeFile, SetCode, SetValue
from halation.custom_nodes import CustomNode
from halation.editor.window.dropped_files import take_files
from halation.graph import Graph, Group, Port
from halation.nodes import Node, catalogue
from halation.resources.sandbox import UNRESTRICTED
from still_editor import StillEditor, open_still_editor

KNEE = Port("bloom", "knee")


@pytest.fixture
def still(tmp_path: Path) -> Iterator[StillEditor]:
    with open_still_editor(tmp_path, write_many_things(tmp_path)) as still:
        still.show("Graph")
        yield still


def list_words(still: StillEditor) -> list[str]:
    return [entry.sentence for entry in still.editor.log.entries]


def answer(still: StillEditor, label: str) -> None:
    """Choose an answer of the question that is open."""
    question = still.editor.dialogs.question
    assert question is not None
    dict(question.answers)[label]()
    still.editor.dialogs.question = None


def change_on_disk(still: StillEditor) -> Path:
    """The document's file, in which another program has changed a number."""
    path = still.editor.session.path
    assert path is not None
    other = document.load(path, sandbox=UNRESTRICTED).set(KNEE, 0.125)
    document.save(other, path, sandbox=UNRESTRICTED)
    return path


def test_a_document_without_changes_is_loaded_again(still) -> None:
    path = change_on_disk(still)
    still.contexts.documents.load_changed_file(path)
    assert still.editor.dialogs.question is None and still.editor.session.graph.value(KNEE) == 0.125
    assert list_words(still) == [f"{path.name} changed on disk and was loaded again"]


@pytest.mark.parametrize(("label", "knee"), [("Load theirs", 0.125), ("Keep mine", 0.75)])
def test_unsaved_work_is_not_lost_without_asking(still, label: str, knee: float) -> None:
    still.editor.session.apply(SetValue(KNEE, 0.75))
    path = change_on_disk(still)
    still.contexts.documents.load_changed_file(path)
    assert still.editor.session.graph.value(KNEE) == 0.75 and path.name in still.editor.dialogs.question.sentence
    answer(still, label)
    assert still.editor.session.graph.value(KNEE) == knee
    assert bool(list_words(still)) == (label == "Keep mine")


@pytest.mark.parametrize("label", ["", "Load theirs", "Keep mine"])
def test_code_is_read_again_and_a_draft_is_asked_for(still, tmp_path: Path, label: str) -> None:
    session = still.editor.session
    added = session.apply(AddNode("glsl"))
    text = session.code_files.find_code(added).text
    path = tmp_path / "tint.glsl"
    path.write_text(text)
    session.apply(LinkCodeFile(added, path))
    session.code_files.read_missing()
    if label:
        session.apply(SetCode(added, text + "// mine\n"))
    path.write_text(text + "// theirs\n")
    still.contexts.code_files.reread(path)
    assert (still.editor.dialogs.question is not None) == bool(label)
    if label:
        answer(still, label)
    expected = text + ("// mine\n" if label == "Keep mine" else "// theirs\n")
    assert session.code_files.find_code(added).text == expected
    assert ("tint.glsl changed on disk and was loaded again" in list_words(still)) == (label != "Keep mine")


def drop(still: StillEditor, *paths: Path, scope: Any = "graph") -> list[str]:
    """Names of nodes that are new after files were dropped."""
    before = set(still.editor.session.graph.nodes)
    still.editor.scope, still.editor.canvas.pointer = scope, (120.0, -40.0)
    take_files(still.editor, still.contexts.documents, paths)
    return sorted(set(still.editor.session.graph.nodes) - before)


def test_pictures_and_code_become_nodes_where_they_fall(still, tmp_path: Path) -> None:
    code = tmp_path / "tint.glsl"
    code.write_text("vec4 tint(vec4 image) { return image; }\n")
    (name,) = drop(still, code)
    session = still.editor.session
    assert isinstance(session.graph.nodes[name], CustomNode) and session.code_files.find_code(name).file == "tint.glsl"
    (name,) = drop(still, tmp_path / "samples" / "studio.exr")
    item = session.graph.nodes[name]
    assert isinstance(item, Node) and Path(session.graph.value(Port(name, "path"))).name == "studio.exr"
    place = next(place for key, place in session.positions.items() if str(key) == name)
    assert place[0] == 120.0, "as far below as there is room"
    session.undo()
    assert name not in session.graph.nodes, "one step"


def test_a_graph_becomes_a_group_on_the_canvas_and_is_opened_elsewhere(still, tmp_path: Path) -> None:
    path = tmp_path / "other.json"
    document.save(Graph().add("noise", catalogue()["noise"]()), path, sandbox=UNRESTRICTED)
    (name,) = drop(still, path)
    assert isinstance(still.editor.session.graph.nodes[name], Group)
    still.editor.session.undo()
    drop(still, path, scope="viewer")
    assert set(still.editor.session.graph.nodes) == {"noise"} and still.editor.session.path == path


@pytest.mark.parametrize("whole", [True, False])
def test_one_frame_of_a_sequence_is_asked_for(still, tmp_path: Path, whole: bool) -> None:
    paths = [tmp_path / f"shot.{frame:04d}.exr" for frame in (1, 2, 3)]
    for path in paths:
        shutil.copy(tmp_path / "samples" / "studio.exr", path)
    assert drop(still, paths[1]) == []
    question = still.editor.dialogs.question
    assert "shot.0002.exr is one of 3 frames of shot.####.exr" in question.sentence
    before = set(still.editor.session.graph.nodes)
    labels = [label for label, _ in question.answers]
    answer(still, labels[0 if whole else 1])
    (name,) = set(still.editor.session.graph.nodes) - before
    value = Path(still.editor.session.graph.value(Port(name, "path"))).name
    assert value == ("shot.####.exr" if whole else "shot.0002.exr"), labels
    assert (drop(still, *paths) != [] and still.editor.dialogs.question is None) or not whole
