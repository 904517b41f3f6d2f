"""What a person does on the canvas and in the inspector."""

from __future__ import annotations

import pytest
from halation import presets
from halation.authoring.commands import (
    AddComment,
    AddDot,
    AddFrame,
    AddGroupFile,
    AddInput,
    AddNode,
    AddOutput,
    CutSelection,
    DeleteSelection,
    DescribeControl,
    DuplicateSelection,
    EditFrame,
    ExposeValue,
    ExtractSelection,
    HideControl,
    InsertNode,
    MakeGroup,
    MakeGroupLocal,
    MoveElements,
    PasteText,
    RemoveDot,
    RemoveEnd,
    RenameControl,
    RenameEnd,
    ReplaceGraph,
    ResetNode,
    ResetValue,
    ResizeComment,
    ResizeFrame,
    SetCanvasSize,
    SetInput,
    SetOutput,
    SetValue,
    SpliceChain,
    ToggleCollapse,
    ToggleMute,
)
from halation.authoring.edits.decor import find_frame_members
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.selection import find_downstream, find_linked, find_upstream, invert_selection
from halation.authoring.edits.values import find_control, is_default
from halation.authoring.session import Session
from halation.authoring.state.group_files import GroupFiles
from halation.document import load
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Port
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain, chain


def port(text: str) -> Port:
    return Port.parse(text)


@pytest.fixture
def session() -> Session:
    made = Session(TOYS, sandbox=UNRESTRICTED)
    made.apply(ReplaceGraph("Start", chain(3)))
    return made


def links(session: Session) -> dict[str, str]:
    return {str(end): str(start) for end, start in session.graph.links.items()}


def test_selecting(session):
    session.select(ElementId("n0"))
    session.select([ElementId("n1"), ElementId("nobody")], "add")
    assert (session.selection, session.active) == ({"n0", "n1"}, "n1")
    session.select([ElementId("n0"), ElementId("n2")], "toggle")
    assert (session.selection, session.active) == ({"n1", "n2"}, "n2")
    session.select(ElementId("n2"), "remove")
    assert (session.selection, session.active) == ({"n1"}, "n1")
    session.select(find_upstream(session.graph, session.selection), "extend")
    assert (session.selection, session.active) == ({"inputs.beauty", "n0", "n1"}, "n1")
    session.select(ElementId("n1"))
    session.select(find_downstream(session.graph, session.selection), "extend")
    assert session.selection == {"n1", "n2", "outputs.image"}
    session.select(invert_selection(session.elements, session.selection))
    assert session.selection == {"inputs.beauty", "n0"}
    session.apply(AddNode("photo"))
    session.select(ElementId("n2"))
    session.select(find_linked(session.graph, session.selection), "extend")
    assert session.selection == {"inputs.beauty", "n0", "n1", "n2", "outputs.image"}
    session.select(())
    assert (session.selection, session.active) == (frozenset(), "")


def test_adding_with_a_link(session):
    assert session.apply(AddNode("blend", (5.0, 6.0), port("n0.out"))) == "blend"
    assert session.apply(AddNode("photo", (0.0, 0.0), port("blend.second"), output=False)) == "photo"
    assert {"blend.first": "n0.out", "blend.second": "photo.out"}.items() <= links(session).items()
    assert session.position(ElementId("blend")) == (5.0, 6.0) and session.active == "photo"
    before = session.root
    with pytest.raises(GraphError, match="fits no input"):
        session.apply(AddNode("photo", link=port("n0.out")))
    assert session.root is before


def test_inserting_new_and_existing_nodes(session):
    assert session.apply(InsertNode("soften", port("n1.image"), (7.0, 8.0))) == "soften"
    assert links(session)["n1.image"] == "soften.out" and session.position(ElementId("soften")) == (7.0, 8.0)
    session.apply(ExtractSelection())
    assert links(session)["n1.image"] == "n0.out"
    session.apply(InsertNode("soften", port("outputs.image")))
    assert links(session)["soften.image"] == "n2.out" and links(session)["outputs.image"] == "soften.out"


def test_a_node_without_a_place_is_inserted_halfway_along_the_link(session):
    session.apply(MoveElements((ElementId("n1"),), 900.0, 200.0))
    (x0, y0), (x1, y1) = (session.position(ElementId(id)) for id in ("n0", "n1"))
    new = session.apply(InsertNode("soften", port("n1.image")))
    assert session.position(ElementId(new)) == ((x0 + x1) / 2, (y0 + y1) / 2) and y0 != y1 and x0 + x1


def test_deleting_all_kinds_of_things(session):
    frame, note = session.apply(AddFrame("f", (0.0, 0.0))), session.apply(AddComment((0.0, 0.0), "c"))
    dot = session.apply(AddDot(port("n1.image"), (1.0, 1.0)))
    session.select(
        [
            ElementId("n0"),
            ElementId("inputs.beauty"),
            frame,
            note,
            dot,
        ]
    )
    session.apply(DeleteSelection())
    assert set(session.elements) == {"n1", "n2", "outputs.image"}
    assert session.selection == frozenset()
    assert links(session) == {"n2.image": "n1.out", "outputs.image": "n2.out"}
    with pytest.raises(GraphError, match="nothing is selected"):
        session.apply(DeleteSelection())


def test_delete_heals_unless_told_otherwise(session):
    session.select(ElementId("n1"))
    session.apply(DeleteSelection())
    assert links(session)["n2.image"] == "n0.out"
    session.undo()
    session.apply(DeleteSelection(heal=False))
    assert "n2.image" not in links(session)


def test_mute_and_collapse_toggle_all_of_the_selection(session):
    session.select(ElementId("n0"))
    session.apply(ToggleMute())
    session.select([ElementId("n0"), ElementId("n1")])
    session.apply(ToggleMute())
    assert session.graph.muted == {"n0", "n1"}
    session.apply(ToggleMute())
    assert session.graph.muted == frozenset()
    session.apply(ToggleCollapse())
    assert session.graph.ui["nodes"]["n0"]["collapsed"] is True
    session.apply(ToggleCollapse())
    assert "collapsed" not in session.graph.ui["nodes"]["n0"]


def test_values(session):
    gain, tint = port("n0.gain"), port("n0.tint")
    session.apply(SetValue(gain, 2, "drag"))
    session.apply(SetValue(gain, 3, "drag"))
    session.apply(SetValue(tint, [1, 0, 0, 1]))
    assert (session.graph.value(gain), session.graph.value(tint)) == (3.0, (1.0, 0.0, 0.0, 1.0))
    assert len(session.history.steps) == 3 and not is_default(session.graph, gain)
    session.apply(ResetValue(gain))
    assert is_default(session.graph, gain) and session.graph.value(gain) == 1.0
    session.apply(ResetNode("n0"))
    assert session.graph.nodes["n0"] == Gain()
    for value, said in ((99.0, "outside the range"), ("a", "takes a number"), (float("nan"), "not a finite")):
        with pytest.raises(GraphError, match=said):
            session.apply(SetValue(gain, value))
    assert session.graph.links.get(port("n1.image")) == port("n0.out") and session.graph.links.get(gain) is None


def test_controls(session):
    gain = port("n0.gain")
    assert session.apply(ExposeValue(gain)) == "gain" and find_control(session.graph, gain) == "gain"
    assert session.apply(ExposeValue(port("n1.gain"))) == "gain2"
    with pytest.raises(GraphError, match="control 'gain' already"):
        session.apply(ExposeValue(gain))
    session.apply(RenameControl("gain", "glow"))
    session.apply(DescribeControl("glow", label="Glow"))
    session.apply(DescribeControl("glow", doc="How much."))
    assert session.graph.controls["glow"] == Control(gain, "Glow", "How much.")
    session.apply(HideControl("glow"))
    assert find_control(session.graph, gain) is None


def test_values_of_a_group_and_of_what_is_inside(session):
    session.apply(ExposeValue(port("n1.gain"), "glow"))
    session.select([ElementId("n0"), ElementId("n1")])
    id = session.apply(MakeGroup("look"))
    glow = Port(id, "glow")
    session.apply(SetValue(glow, 4.0))
    assert not is_default(session.graph, glow)
    session.enter(id)
    assert session.graph.value(port("n1.gain")) == 4.0, "the value that the group sets"
    session.apply(SetValue(port("n0.gain"), 0.5))
    session.apply(RenameControl("glow", "shine"))
    session.apply(RenameEnd(ElementId("inputs.image"), "plate"))
    session.leave()
    assert session.graph.value(Port(id, "shine")) == 4.0
    assert session.graph.controls["glow"].target == Port(id, "shine")
    assert links(session)["look.plate"] == "inputs.beauty"
    session.enter(id)
    session.apply(RemoveEnd(ElementId("inputs.plate")))
    session.leave()
    assert "look.plate" not in links(session)
    session.undo()
    assert session.place == (id,) and "plate" in session.graph.inputs
    session.leave()
    assert links(session)["look.plate"] == "inputs.beauty"


def test_groups_from_files(session, tmp_path):
    session.select([ElementId("n0"), ElementId("n1")])
    id = session.apply(MakeGroup("look"))
    session.files.save_as(tmp_path / "doc.json")
    session.files.save_group(id, tmp_path / "look.json")
    assert session.borrowed == "" and not session.dirty
    session.files.save_group(id, tmp_path / "look.json", link=True)
    assert session.graph.nodes[id].path == "look.json"
    session.enter(id)
    assert session.borrowed == "look.json" and session.crumbs == (("doc", ()), ("look", ("look",)))
    with pytest.raises(GraphError, match=r"'look' comes from the file 'look.json': make it local first"):
        session.apply(SetValue(port("n0.gain"), 2.0))
    session.leave()
    session.files.save()
    assert load(tmp_path / "doc.json", TOYS, sandbox=UNRESTRICTED) == session.root
    session.apply(MakeGroupLocal(id))
    session.enter(id)
    session.apply(SetValue(port("n0.gain"), 2.0))
    assert session.borrowed == ""
    session.leave()
    with pytest.raises(GraphError, match="part of this document already"):
        session.apply(MakeGroupLocal(id))


def test_entering_and_leaving(session):
    session.select(ElementId("n1"))
    session.enter(session.apply(MakeGroup("a")))
    session.select(ElementId("n1"))
    session.enter(session.apply(MakeGroup("b")))
    assert session.place == ("a", "b") and session.crumbs == (("untitled", ()), ("a", ("a",)), ("b", ("a", "b")))
    session.leave(2)
    assert (session.place, session.active) == ((), "a")
    session.go(("a", "b"))
    session.go(("a",))
    assert session.active == "b"
    for act in (lambda: session.enter("n1"), lambda: session.enter("inputs.image"), lambda: session.go(("x",))):
        with pytest.raises(GraphError):
            act()
    assert isinstance(session.root.nodes["a"], Group)


def test_ends(session):
    assert session.apply(AddInput("depth", "Field", at=(1.0, 2.0))) == "inputs.depth"
    assert session.graph.inputs["depth"] == Input(Kind.FIELD) and session.position(ElementId("inputs.depth")) == (
        1.0,
        2.0,
    )
    assert session.apply(AddOutput("flow", Kind.VECTOR, 2)) == "outputs.flow"
    session.apply(SetInput("depth", file="a.exr", layer="Z", doc="Far."))
    session.apply(SetInput("depth", default=1.0))
    assert session.graph.inputs["depth"] == Input(Kind.FIELD, 1, "a.exr", "Z", 1.0, "Far.")
    session.apply(SetInput("depth", default=None, missing="hold"))
    assert session.graph.inputs["depth"] == Input(Kind.FIELD, 1, "a.exr", "Z", None, "Far.", "hold")
    for default in ((1.0, 2.0), "far", True, float("inf")):
        with pytest.raises(GraphError, match="default"):
            session.apply(SetInput("depth", default=default))
    session.apply(SetOutput("image", layer="rgba", view="none"))
    assert (session.graph.outputs["image"].layer, session.graph.outputs["image"].view) == ("rgba", "none")
    session.apply(SetCanvasSize((64, 48)))
    assert session.root.settings.size == (64, 48)
    session.apply(RemoveEnd(ElementId("inputs.beauty")))
    assert "n0.image" not in links(session)
    with pytest.raises(GraphError, match=r"no 'inputs\.beauty'"):
        session.apply(RenameEnd(ElementId("inputs.beauty"), "x"))


def test_bound_files_follow_their_input(session):
    session.bind("beauty", "shot.exr")
    session.apply(RenameEnd(ElementId("inputs.beauty"), "plate"))
    assert session.bindings == {"plate": "shot.exr"}
    session.undo()
    assert session.bindings == {"beauty": "shot.exr"}
    session.bind("beauty", None)
    assert session.bindings == {}
    with pytest.raises(GraphError, match="no input 'x'"):
        session.bind("x", "a.exr")


def test_frames_hold_what_lies_inside(session):
    session.select([ElementId("n0"), ElementId("n1")])
    frame = session.apply(AddFrame("Grade"))
    assert find_frame_members(session.graph, frame, session.positions) == {"n0", "n1"} and session.active == frame
    session.select(frame)
    outer = session.apply(AddFrame())
    assert find_frame_members(session.graph, outer, session.positions) == {"n0", "n1", frame}
    session.apply(MoveElements([*find_frame_members(session.graph, outer, session.positions), outer], 1000.0, 0.0))
    assert find_frame_members(session.graph, frame, session.positions) == {"n0", "n1"}
    session.apply(ResizeFrame(frame, 0.0, 0.0, 1.0, 1.0))
    assert session.graph.ui["frames"][frame.name]["w"] == 40.0, "never too small to be grabbed"
    session.apply(EditFrame(frame, color=(0.5, 0.25, 0.125)))
    assert session.graph.ui["frames"][frame.name]["title"] == "Grade"
    assert session.graph.ui["frames"][frame.name]["color"] == (0.5, 0.25, 0.125)
    with pytest.raises(GraphError, match="there is no frame 'x'"):
        session.apply(EditFrame(ElementId("frames.x")))
    with pytest.raises(GraphError, match="there is no comment 'x'"):
        session.apply(ResizeComment(ElementId("comments.x"), 0.0, 0.0, 9.0))
    with pytest.raises(GraphError, match="there is no dot 'x'"):
        session.apply(RemoveDot(ElementId("dots.x")))


def test_cut_copy_and_paste(session):
    session.select([ElementId("n1")])
    text = session.apply(CutSelection())
    assert links(session) == {"n0.image": "inputs.beauty", "n2.image": "n0.out", "outputs.image": "n2.out"}
    assert session.apply(PasteText(text)) == ("n1",)
    assert session.selection == {"n1"} and "n1.image" not in links(session)
    assert session.apply(DuplicateSelection()) == ("n3",)
    other = Session(TOYS, sandbox=UNRESTRICTED)
    assert other.apply(PasteText(text, (50.0, 60.0))) == ("n1",) and other.position(ElementId("n1")) == (50.0, 60.0)
    assert isinstance(other.root, Graph)


def test_a_chain_is_inserted_in_one_step_and_a_cancelled_drag_leaves_no_trace(session):
    before, steps = session.root, session.history.position
    session.select([ElementId("n1")])
    session.apply(ExtractSelection("drag"))
    assert links(session)["n2.image"] == "n0.out"
    session.apply(MoveElements([ElementId("n1")], 0.0, 300.0, "drag"))
    session.abandon("drag")
    assert session.root == before and session.history.steps == session.history.steps[:steps]
    assert not session.history.can_redo
    session.abandon("drag")
    assert session.root == before, "there is nothing unfinished"
    session.apply(ExtractSelection("drag"))
    session.apply(SpliceChain(["n1"], port("outputs.image"), (900.0, 0.0), merge="drag"))
    session.seal()
    assert session.history.position == steps + 1
    assert links(session)["n1.image"] == "n2.out" and links(session)["outputs.image"] == "n1.out"
    session.undo()
    assert session.root == before


def test_presets_that_fit_a_port():
    session, files = Session(sandbox=UNRESTRICTED), presets.paths()
    session.apply(AddNode("gaussian_blur"))
    groups = GroupFiles()
    some = groups.list_fitting(files, session, port("gaussian_blur.out"), True)
    assert some and set(some) <= set(files)
    id = session.apply(AddGroupFile(some[0], link=port("gaussian_blur.out")))
    assert [str(end.node) for end, start in session.graph.links.items() if str(start) == "gaussian_blur.out"] == [id]
    assert groups.list_fitting(files, session, port("gaussian_blur.image"), False) == files, (
        "all of them make a picture"
    )
