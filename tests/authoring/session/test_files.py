"""The document as a file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from halation import presets
from halation.authoring.commands import AddGroupFile, AddMatte, AddNode, DropFiles, MakeGroup, ReplaceGraph, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.document import dumps, load
from halation.errors import DocumentError, GraphError, HalationError, OutputError, UsageError
from halation.graph import Graph, Group, Input, Output, Port
from halation.presets import sample
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain, Photo, Soften, chain


@pytest.fixture
def session() -> Session:
    return Session(TOYS, sandbox=UNRESTRICTED)


def written(path: Path, graph: Graph) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(dumps(graph))
    return path


def test_open_save_and_open_again(session, tmp_path):
    path = written(tmp_path / "a.json", chain(2))
    session.files.open(path)
    assert (session.name, session.path, session.dirty, session.history.steps) == ("a", path, False, ())
    session.apply(SetValue(Port("n0", "gain"), 3.0))
    session.files.save()
    assert not session.dirty and session.history.can_undo
    assert load(path, TOYS, sandbox=UNRESTRICTED) == session.root


def test_a_file_that_cannot_be_read_leaves_the_document(session, tmp_path):
    session.apply(ReplaceGraph("Start", chain(1)))
    (tmp_path / "bad.json").write_text("{")
    for act in (
        lambda: session.files.open(tmp_path / "bad.json"),
        lambda: session.files.open_text("nothing"),
        lambda: session.files.open_copy(tmp_path / "none.json"),
    ):
        with pytest.raises(DocumentError):
            act()
    assert "n0" in session.graph.nodes and session.history.can_undo


def test_save_needs_a_file_and_a_folder(session, tmp_path):
    with pytest.raises(UsageError, match="Save As"):
        session.files.save()
    with pytest.raises(UsageError, match="no file to read again"):
        session.files.reload()
    session.apply(ReplaceGraph("Start", chain(1)))
    with pytest.raises(OutputError):
        session.files.save_as(tmp_path / "none" / "a.json")
    assert session.path is None and session.dirty


def test_saving_elsewhere_still_finds_pictures_and_groups(session, tmp_path):
    inner = Graph(nodes={"p": Photo(path="b.exr")}, outputs={"image": Output()})
    written(tmp_path / "one/lib/inner.json", inner)
    graph = Graph(inputs={"plate": Input(file="plates/a.exr")}, folder=str(tmp_path / "one"))
    graph = graph.add("g", Group(load(tmp_path / "one/lib/inner.json", TOYS, sandbox=UNRESTRICTED), "lib/inner.json"))
    graph = graph.add("p", Photo(path="plates/c.exr")).add("q", Photo(path="/far/d.exr")).add("r", Photo())
    session.files.open(written(tmp_path / "one/doc.json", graph))
    session.select(ElementId("p"))
    session.apply(MakeGroup("local"))
    (tmp_path / "two").mkdir()
    session.files.save_as(tmp_path / "two/doc.json")
    root = load(tmp_path / "two/doc.json", TOYS, sandbox=UNRESTRICTED)
    assert root == session.root and not session.dirty
    assert root.inputs["plate"].file == "../one/plates/a.exr"
    assert root.nodes["g"].path == "../one/lib/inner.json" and root.nodes["g"].graph == inner
    assert root.nodes["local"].graph.nodes["p"].path == "../one/plates/c.exr"
    assert [root.nodes[id].path for id in "qr"] == ["/far/d.exr", ""]
    session.undo()
    assert session.graph.value(Port("p", "path")) == "../one/plates/c.exr", "the past moved too"
    session.redo()
    assert not session.dirty


def test_a_document_is_not_saved_into_itself(session, tmp_path):
    path = written(tmp_path / "lib.json", chain(1))
    session.apply(AddGroupFile(path))
    with pytest.raises(UsageError, match="used as a group"):
        session.files.save_as(path)
    session.files.save_as(tmp_path / "doc.json")
    with pytest.raises(GraphError, match="cannot hold itself"):
        session.apply(AddGroupFile(tmp_path / "doc.json"))
    with pytest.raises(UsageError, match="of the document itself"):
        session.select(ElementId(session.apply(AddNode("gain"))))
        session.files.save_group(session.apply(MakeGroup()), tmp_path / "doc.json")
    outer = Session(TOYS, sandbox=UNRESTRICTED)
    outer.files.open(path)
    with pytest.raises(GraphError, match="cannot hold itself"):
        outer.apply(AddGroupFile(tmp_path / "doc.json"))


def test_a_preset_opens_as_a_new_document_that_finds_its_files(session, tmp_path):
    path = written(tmp_path / "presets/look.json", Graph(nodes={"p": Photo(path="samples/a.exr")}))
    session.files.open_copy(path)
    assert session.path is None and not session.dirty
    session.files.save_as(tmp_path / "mine.json")
    assert session.graph.value(Port("p", "path")) == "presets/samples/a.exr"
    assert load(path, TOYS, sandbox=UNRESTRICTED).nodes["p"] == Photo(path="samples/a.exr")


def test_a_preset_as_a_node_depends_on_no_file(tmp_path):
    session = Session(sandbox=UNRESTRICTED)
    id = session.apply(AddGroupFile(next(path for path in presets.paths() if path.stem == "soft_bloom")))
    item = session.graph.nodes[id]
    assert isinstance(item, Group) and not item.path
    assert [end.file for end in item.graph.inputs.values()] == ["" for _ in item.graph.inputs]
    session.enter(id)
    assert session.borrowed == ""
    session.files.save_as(tmp_path / "doc.json")
    assert "sample" not in (tmp_path / "doc.json").read_text()


def test_pasted_text_is_an_unsaved_document(session):
    session.files.open_text(dumps(chain(2)))
    assert session.dirty and session.path is None and "n1" in session.graph.nodes


def test_revert_and_reload_can_be_undone_and_keep_the_view(session, tmp_path):
    path = written(tmp_path / "a.json", chain(3))
    session.files.open(path)
    session.select([ElementId("n1"), ElementId("n2")])
    session.views.show_element(ElementId("n1"))
    session.apply(SetValue(Port("n0", "gain"), 3.0))
    session.files.revert()
    assert session.graph.value(Port("n0", "gain")) == 1.5 and not session.dirty
    assert session.selection == {"n1", "n2"} and session.views.find_port() == Port("n1", "out")
    session.undo()
    assert session.graph.value(Port("n0", "gain")) == 3.0 and session.dirty
    written(path, chain(2))
    session.files.reload()
    assert set(session.graph.nodes) == {"n0", "n1"} and session.selection == {"n1"}
    assert session.history.steps == ("Set n0.gain", "Reload")
    session.files.reload()
    assert session.history.steps == ("Set n0.gain", "Reload"), "nothing was new"


def test_reloading_leaves_a_group_that_is_gone(session, tmp_path):
    session.apply(ReplaceGraph("Start", chain(2)))
    session.select(ElementId("n0"))
    session.enter(session.apply(MakeGroup()))
    session.files.save_as(tmp_path / "a.json")
    written(tmp_path / "a.json", chain(1))
    session.files.reload()
    assert session.place == ()


def test_groups_are_read_again_everywhere(session, tmp_path):
    path = written(tmp_path / "lib.json", chain(1))
    id = session.apply(AddGroupFile(path, (5.0, 5.0)))
    session.apply(AddNode("gain"))
    session.files.save_as(tmp_path / "doc.json")
    written(path, chain(4))
    session.files.reload_groups()
    assert len(session.graph.nodes[id].graph.nodes) == 4 and not session.dirty
    session.undo()
    assert len(session.graph.nodes[id].graph.nodes) == 4, "in the past too"
    path.write_text("{")
    with pytest.raises(DocumentError):
        session.files.reload_groups()
    assert len(session.graph.nodes[id].graph.nodes) == 4


def test_a_change_of_classes_reaches_the_whole_history(session):
    session.apply(ReplaceGraph("Start", Graph(nodes={"n": Gain()})))
    session.apply(AddNode("soften"))
    session.migrate(lambda graph: Graph(nodes={id: Soften() for id in graph.nodes}, ui=graph.ui))
    assert session.graph.nodes["n"] == Soften() and len(session.history.steps) == 2
    session.undo()
    assert session.graph.nodes == {"n": Soften()}


def test_dropped_files(tmp_path):
    session = Session(sandbox=UNRESTRICTED)
    session.files.save_as(tmp_path / "doc.json")
    path = written(tmp_path / "my look.json", Graph(outputs={"image": Output()}))
    ids = session.apply(DropFiles([tmp_path / "plates/shot 1.exr", "/far/b.png", path], (10.0, 200.0)))
    assert ids == ("shot_1", "b", "my_look")
    assert [session.graph.nodes[id].path for id in ids] == ["plates/shot 1.exr", "/far/b.png", "my look.json"]
    assert session.selection == set(ids) and session.position(ElementId("shot_1")) == (10.0, 200.0)
    assert session.history.steps == ("Drop 3 files",)
    with pytest.raises(HalationError):
        session.apply(DropFiles([tmp_path / "none.json"]))
    assert json.loads((tmp_path / "doc.json").read_text()) == {
        "halation": 1,
        "outputs": {"image": {"type": "Image"}},
        "settings": {"reference_height": 1080},
        "ui": {"nodes": {"outputs.image": {"x": 0.0, "y": 0.0}}},
    }


def test_a_dropped_render_is_read_as_one():
    session = Session(sandbox=UNRESTRICTED)
    (id,) = session.apply(DropFiles([sample()]))
    assert session.graph.nodes[id].id == "read_render"
    matte = session.apply(AddMatte(id, "object"))
    assert session.graph.nodes[matte].path == session.graph.nodes[id].path and session.selection == {matte}
    assert session.history.steps == (f"Drop {id}", f"Add {matte}")
