"""Nodes of code in a session: typing, files, undo, and everything else that editors do with nodes."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.authoring.commands import (
    AddNode,
    Connect,
    DropFiles,
    DuplicateSelection,
    EmbedCode,
    ExposeValue,
    ExtractSelection,
    MakeGroup,
    PasteText,
    RenameNode,
    ReplaceGraph,
    ReplaceNode,
    SetCode,
    SetKey,
    SetValue,
    ToggleMute,
    Ungroup,
)
from halation.authoring.edits import coding
from halation.authoring.edits.clipboard import copy_elements
from halation.authoring.edits.coding import BrokenCodeNode
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.wiring import list_fitting_types
from halation.authoring.session import Session
from halation.custom_nodes import CustomNode
from halation.document import dumps, loads
from halation.errors import GraphError
from halation.graph import Graph, Input, Keys, Output, Port, Unknown
from halation.graph.paths import rebase_paths
from halation.resources.sandbox import UNRESTRICTED

GAIN = 'vec4 gain(vec4 image, float k // = 2, 0..4, "How Much"\n) { return image * k; }'
HEAD = '/*{"ISFVSN": "2", "INPUTS": [{"NAME": "inputImage", "TYPE": "image"}]}*/'
GLOW = HEAD + "\nvoid main() { gl_FragColor = vec4(1.0); }"


def start(text: str = GAIN) -> Session:
    """A session with one node of code, `code`, between the ends."""
    session = Session(sandbox=UNRESTRICTED)
    session.apply(ReplaceGraph("Begin", Graph().add_input("image", Input()).add_output("out", Output(width=4))))
    session.apply(AddNode("glsl", link=Port("inputs", "image")))
    session.apply(Connect(Port("code", "out"), Port("outputs", "out")))
    session.apply(SetCode("code", text))
    return session


def written(session: Session, id: str = "code") -> CustomNode:
    item = session.graph.nodes[id]
    assert isinstance(item, CustomNode)
    return item


def test_a_new_node_is_linked_and_says_what_it_is() -> None:
    session = Session(sandbox=UNRESTRICTED)
    session.apply(ReplaceGraph("Begin", Graph().add_input("image", Input())))
    types = coding.with_code_type(session.types)
    assert "glsl" in list_fitting_types(session.graph, Port("inputs", "image"), True, types)
    id = session.apply(AddNode("glsl", link=Port("inputs", "image")))
    item = written(session, id)
    assert (id, item.title, item.category) == ("code", "tint", "code")
    assert session.graph.links.get(Port("code", "image")) == Port("inputs", "image")
    assert item.values["amount"].doc == "How much of it." and item.values["shade"].length == 3


def test_broken_code_keeps_what_it_was_given_and_comes_back() -> None:
    session = start()
    session.apply(SetValue(Port("code", "k"), 3.0))
    session.apply(ExposeValue(Port("code", "k")))
    links = session.graph.links
    session.apply(SetCode("code", "uniform " + GAIN))
    item = session.graph.nodes["code"]
    assert isinstance(item, BrokenCodeNode) and "line 1: 'uniform'" in item.fault
    assert session.graph.links == links and "k" in session.graph.controls
    assert session.problems["code"][0].severity == "error"
    again = loads(dumps(session.root), sandbox=UNRESTRICTED)
    assert dumps(again) == dumps(session.root) and isinstance(again.nodes["code"], Unknown)
    session.apply(SetCode("code", GAIN))
    assert written(session).k == 3.0 and session.graph.links == links
    assert session.graph.controls["k"].label == "How Much"


def test_typing_is_one_step_whatever_was_typed_between() -> None:
    session = start()
    session.apply(SetValue(Port("code", "k"), 3.0))
    session.apply(SetKey(Port("code", "k"), 1.5))
    before, steps = session.root, session.history.steps
    for text in ("", GAIN.replace("k", "ki"), "vec4 f(vec4 other) { return other; }", "vec4 gain(", GAIN + "\n"):
        session.apply(SetCode("code", text, merge="burst"))
    assert session.history.steps == (*steps, "Edit code of code")
    assert session.graph.links == before.links and isinstance(session.graph.animation[Port("code", "k")], Keys)
    session.undo()
    assert session.root == before
    session.redo()
    assert session.code_files.find_code("code").text == GAIN + "\n"  # pyright: ignore[reportOptionalMemberAccess]
    session.apply(SetCode("code", GAIN + "\n// more", merge="another"))
    session.apply(SetCode("code", GAIN + "\n", merge="another"))
    session.seal()
    assert session.history.steps == (*steps, "Edit code of code")


def test_a_default_that_was_not_touched_follows_the_code() -> None:
    session = start()
    session.apply(SetCode("code", GAIN.replace("= 2", "= 3")))
    assert written(session).k == 3.0
    session.apply(SetValue(Port("code", "k"), 1.0))
    session.apply(SetCode("code", GAIN.replace("= 2", "= 3").replace("k", "gain")))
    assert isinstance(session.graph.nodes["code"], CustomNode)
    session.undo()
    session.apply(SetCode("code", GAIN))
    assert written(session).k == 1.0
    session.apply(
        SetCode("code", GAIN.replace("float k // = 2", "vec3 k // = 1, color").replace("* k", "* vec4(k, 1.0)"))
    )
    assert written(session).k == (1.0, 1.0, 1.0)


def test_a_color_without_alpha_takes_what_pickers_make() -> None:
    session = start("vec4 f(vec4 image, vec3 shade /* = 1, color */) { return image; }")
    session.apply(SetValue(Port("code", "shade"), (0.1, 0.2, 0.3, 1.0)))
    assert written(session).shade == (0.1, 0.2, 0.3)
    session.apply(SetKey(Port("code", "shade")))
    session.apply(SetValue(Port("code", "shade"), (0.4, 0.5, 0.6, 0.7)))
    assert session.time.evaluate(Port("code", "shade")) == (0.4, 0.5, 0.6)


@pytest.fixture
def filed(tmp_path: Path) -> Session:
    """A saved document with two nodes whose code is in one file, one of them in a group."""
    (tmp_path / "shaders").mkdir()
    (tmp_path / "shaders/gain.glsl").write_text(GAIN)
    session = start()
    session.files.save_as(tmp_path / "graph.json")
    session.apply(DropFiles([tmp_path / "shaders/gain.glsl"]))
    session.apply(MakeGroup())
    session.apply(DropFiles([tmp_path / "shaders/gain.glsl"]))
    session.files.save()
    session.code_files.read_missing()
    return session


def test_code_in_a_file_is_a_draft_until_it_is_saved(filed: Session, tmp_path: Path) -> None:
    file = tmp_path / "shaders/gain.glsl"
    assert (
        filed.code_files.find_code("gain").file == "shaders/gain.glsl"
        and not filed.code_files.drafts
        and not filed.dirty
    )  # pyright: ignore
    more = GAIN.replace("k;", "k * 2.0;")
    filed.apply(SetCode("gain", more))
    assert filed.code_files.drafts == {file: more} and filed.dirty and file.read_text() == GAIN
    assert filed.history.steps[-1] == "Edit code of gain"
    inside = next(item for item in filed.root.nodes.values() if hasattr(item, "graph"))
    assert [coding.read_node_code(item, "", sandbox=UNRESTRICTED).text for item in inside.graph.nodes.values()] == [
        more
    ]  # pyright: ignore
    kept = loads(dumps(filed.code_files.recoverable_root), folder=str(tmp_path), sandbox=UNRESTRICTED)
    assert kept.nodes["gain"].code.text == more and not kept.nodes["gain"].code.file  # pyright: ignore
    assert filed.code_files.save("gain") == file
    assert file.read_text() == more and not filed.code_files.drafts and not filed.dirty
    filed.undo()
    assert (
        filed.code_files.drafts == {file: GAIN}
        and filed.code_files.save_drafts() == (file,)
        and file.read_text() == GAIN
    )


def test_what_another_program_writes_is_taken_over(filed: Session, tmp_path: Path) -> None:
    file = tmp_path / "shaders/gain.glsl"
    steps = filed.history.steps
    file.write_text(GAIN.replace("= 2", "= 3"))
    filed.code_files.reread(file)
    assert written(filed, "gain").k == 3.0 and filed.history.steps == steps and not filed.dirty
    file.write_text("nonsense")
    filed.code_files.reread(file)
    assert isinstance(filed.graph.nodes["gain"], Unknown) and "gain.glsl" in filed.problems["gain"][0].sentence
    file.unlink()
    filed.code_files.reread(file)
    assert "there is no such file" in filed.problems["gain"][0].sentence
    file.write_text(GAIN)
    filed.code_files.reread(file)
    assert written(filed, "gain").k == 2.0 and not filed.dirty


def test_code_moves_between_the_graph_and_a_file(filed: Session, tmp_path: Path) -> None:
    filed.apply(EmbedCode("gain"))
    assert filed.code_files.find_code("gain").file == "" and filed.code_files.find_code("gain").text == GAIN  # pyright: ignore
    with pytest.raises(GraphError, match="in no file"):
        filed.apply(EmbedCode("gain"))
    filed.code_files.export("gain", tmp_path / "other.glsl")
    assert filed.code_files.find_code("gain").file == "other.glsl" and (tmp_path / "other.glsl").read_text() == GAIN  # pyright: ignore
    assert not filed.code_files.drafts
    with pytest.raises(GraphError, match="not made of code"):
        filed.apply(SetCode(next(id for id in filed.root.nodes if id.startswith("group")), ""))


def test_files_of_code_are_found_from_another_folder(filed: Session, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    filed.files.save_as(tmp_path / "elsewhere/copy.json")
    assert filed.code_files.find_code("gain").file == "../shaders/gain.glsl"  # pyright: ignore[reportOptionalMemberAccess]
    again = Session(sandbox=UNRESTRICTED)
    again.files.open(tmp_path / "elsewhere/copy.json")
    assert again.root == filed.root
    filed.select(ElementId("gain"))
    other = Session(sandbox=UNRESTRICTED)
    other.files.save_as(tmp_path / "third.json")
    other.apply(PasteText(copy_elements(filed.graph, filed.selection)))
    assert other.code_files.find_code("gain").file == "shaders/gain.glsl"  # pyright: ignore[reportOptionalMemberAccess]
    broken = Graph(folder=str(tmp_path)).add(
        "x", coding.make_file_node("none.glsl", str(tmp_path), sandbox=UNRESTRICTED)
    )
    assert rebase_paths(broken, str(tmp_path / "elsewhere")).nodes["x"].raw["file"] == "../none.glsl"  # pyright: ignore


def test_shaders_of_another_format_are_dropped_too(tmp_path: Path) -> None:
    (tmp_path / "Glow 2.fs").write_text(GLOW)
    session = Session(sandbox=UNRESTRICTED)
    (id,) = session.apply(DropFiles([tmp_path / "Glow 2.fs"]))
    assert (id, written(session, id).id) == ("Glow_2", "isf")


def acts(session: Session) -> None:
    """What editors do with nodes."""
    session.select(ElementId("code"))
    session.apply(DuplicateSelection())
    session.apply(PasteText(copy_elements(session.graph, session.selection)))
    session.select(ElementId("code"))
    session.apply(ToggleMute())
    session.apply(ToggleMute())
    session.apply(MakeGroup())
    group = session.active
    session.enter(group)
    session.apply(SetCode("code", GAIN.replace("= 2", "= 3")))
    session.leave()
    session.apply(Ungroup(group))
    session.apply(RenameNode("code", "renamed"))
    session.apply(ExtractSelection())


@pytest.mark.parametrize("broken", [False, True])
def test_code_survives_all_acts(broken: bool) -> None:
    session = start("nonsense" if broken else GAIN)
    acts(session)
    copies = [item for item in session.graph.nodes.values() if coding.read_node_code(item, "", sandbox=UNRESTRICTED)]
    assert len(copies) == 3
    assert all(isinstance(item, Unknown) == (broken and id != "renamed") for id, item in session.graph.nodes.items())
    assert loads(dumps(session.root), sandbox=UNRESTRICTED) == session.root or broken


def test_code_is_replaced_and_replaces() -> None:
    session = start()
    session.apply(ReplaceNode("code", "exposure"))
    assert session.graph.nodes["code"].id == "exposure"  # pyright: ignore[reportAttributeAccessIssue]
    assert Port("code", "image") in session.graph.links
    session.apply(ReplaceNode("code", "glsl"))
    assert written(session).title == "tint" and Port("outputs", "out") in session.graph.links


def test_code_of_a_group_from_a_file_is_not_changed_here(filed: Session, tmp_path: Path) -> None:
    group = next(id for id in filed.root.nodes if hasattr(filed.root.nodes[id], "graph"))
    filed.files.save_group(group, tmp_path / "group.json", link=True)
    filed.enter(group)
    with pytest.raises(GraphError, match="make it local first"):
        filed.apply(SetCode(next(iter(filed.graph.nodes)), "x"))
