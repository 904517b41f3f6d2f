"""Every command: documented, frozen, labelled; it applies without a window, and undo gives back the document before."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest
from halation import document
from halation.authoring import commands as c
from halation.authoring.commands import EditCommand
from halation.authoring.edits.clipboard import copy_elements
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.errors import GraphError
from halation.graph import Graph, Keys, Port
from halation.nodes import Light, number_lights
from halation.resources.sandbox import UNRESTRICTED
from msgspec import structs
from toy_nodes import TOYS, chain


def port(text: str) -> Port:
    return Port(*text.split("."))


GAIN, LIGHTS = port("gain.gain"), port("lamps.lights")
POINTS = Port("masks", "shapes.shape_1.points")
CORNERS = tuple((float(x), float(y), *(0.0,) * 5) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
CODE = "float f(float a, float k /* = 1 */) { return a * k; }"
EXAMPLES: dict[type[EditCommand], Callable[[Session, Path], EditCommand]] = {
    c.AddNode: lambda s, p: c.AddNode("soften", (5.0, 6.0), port("n1.out")),
    c.AppendNode: lambda s, p: c.AppendNode(c.AddNode("soften", (5.0, 6.0))),
    c.AddGroupFile: lambda s, p: c.AddGroupFile(p / "group.json"),
    c.AddCodeFile: lambda s, p: c.AddCodeFile(p / "code.glsl"),
    c.AddMatte: lambda s, p: c.AddMatte("render"),
    c.InsertNode: lambda s, p: c.InsertNode("soften", port("n1.image")),
    c.SpliceChain: lambda s, p: c.SpliceChain(["gain"], port("n1.image"), (1.0, 2.0)),
    c.DropFiles: lambda s, p: c.DropFiles([p / "group.json", p / "code.glsl", p / "a.png"]),
    c.Connect: lambda s, p: c.Connect(port("n0.out"), port("gain.image")),
    c.ConnectNodes: lambda s, p: c.ConnectNodes(port("n0.out"), port("gain.image")),
    c.ConnectSelection: lambda s, p: s.select(map(ElementId, ("n0", "soften"))) or c.ConnectSelection(),
    c.Disconnect: lambda s, p: c.Disconnect(port("n1.image")),
    c.DisconnectAll: lambda s, p: c.DisconnectAll(ElementId("n1")),
    c.CutLinks: lambda s, p: c.CutLinks([port("n1.image"), port("n2.image")]),
    c.MoveLink: lambda s, p: c.MoveLink(port("n1.image"), port("gain.image")),
    c.SwapInputs: lambda s, p: c.SwapInputs("blend"),
    c.DeleteSelection: lambda s, p: c.DeleteSelection(),
    c.ExtractSelection: lambda s, p: c.ExtractSelection(),
    c.ReplaceNode: lambda s, p: c.ReplaceNode("n1", "soften"),
    c.RenameNode: lambda s, p: c.RenameNode("n1", "other"),
    c.ToggleMute: lambda s, p: c.ToggleMute(),
    c.ToggleCollapse: lambda s, p: c.ToggleCollapse(),
    c.SetValue: lambda s, p: c.SetValue(GAIN, 0.25),
    c.SetValues: lambda s, p: c.SetValues({GAIN: 0.25}, "Set both"),
    c.ConvertLength: lambda s, p: c.ConvertLength((port("soften.sigma"),), "height", 1080),
    c.AddItem: lambda s, p: c.AddItem(LIGHTS, "spot", {"intensity": 2.0}),
    c.DuplicateItem: lambda s, p: c.DuplicateItem(LIGHTS, "lamp_1"),
    c.RemoveItem: lambda s, p: c.RemoveItem(LIGHTS, "lamp_1"),
    c.ExchangeItems: lambda s, p: c.ExchangeItems(LIGHTS, "lamp_1", "lamp_2"),
    c.RenameItem: lambda s, p: c.RenameItem(LIGHTS, "lamp_1", "rim"),
    c.ResetValue: lambda s, p: c.ResetValue(GAIN),
    c.ResetNode: lambda s, p: c.ResetNode("gain"),
    c.ExposeValue: lambda s, p: c.ExposeValue(port("n2.gain")),
    c.HideControl: lambda s, p: c.HideControl("strength"),
    c.RenameControl: lambda s, p: c.RenameControl("strength", "power"),
    c.DescribeControl: lambda s, p: c.DescribeControl("strength", "Strength", "How much."),
    c.MovePoints: lambda s, p: c.MovePoints(POINTS, CORNERS, "Move points"),
    c.ChangePoints: lambda s, p: c.ChangePoints(POINTS, lambda points: points[1:], "Remove a point"),
    c.KeyPoints: lambda s, p: c.KeyPoints(POINTS, (1,), "Key a point"),
    c.DropPointKeys: lambda s, p: c.DropPointKeys(POINTS, (2,), "Key points together"),
    c.SetKey: lambda s, p: c.SetKey(GAIN),
    c.RemoveKey: lambda s, p: c.RemoveKey(port("n0.gain")),
    c.ToggleKey: lambda s, p: c.ToggleKey(GAIN),
    c.AnimateValue: lambda s, p: c.AnimateValue(GAIN, Keys().set(1, 0.5), "Animate"),
    c.AnimateValues: lambda s, p: c.AnimateValues({GAIN: Keys().set(1, 0.5)}, "Animate"),
    c.SetExpression: lambda s, p: c.SetExpression(GAIN, "= frame / 9"),
    c.BakeKeys: lambda s, p: c.BakeKeys(GAIN, [1, 2]),
    c.SetFrameRange: lambda s, p: c.SetFrameRange(3, 9),
    c.SetFrameRate: lambda s, p: c.SetFrameRate(30.0),
    c.SetPreroll: lambda s, p: c.SetPreroll(4),
    c.SetColorSettings: lambda s, p: c.SetColorSettings(working="ACEScg"),
    c.SetOverscan: lambda s, p: c.SetOverscan(0.1),
    c.SetReferenceHeight: lambda s, p: c.SetReferenceHeight(1080),
    c.SetCanvasSize: lambda s, p: c.SetCanvasSize((64, 48)),
    c.AddFrame: lambda s, p: c.AddFrame("Look"),
    c.EditFrame: lambda s, p: c.EditFrame(ElementId("frames.f1"), "Other", (0.1, 0.2, 0.3)),
    c.ResizeFrame: lambda s, p: c.ResizeFrame(ElementId("frames.f1"), 0.0, 0.0, 500.0, 400.0),
    c.AddComment: lambda s, p: c.AddComment((1.0, 2.0), "text"),
    c.EditComment: lambda s, p: c.EditComment(ElementId("comments.c1"), "other"),
    c.ResizeComment: lambda s, p: c.ResizeComment(ElementId("comments.c1"), 0.0, 0.0, 321.0),
    c.AddDot: lambda s, p: c.AddDot(port("n1.image"), (3.0, 4.0)),
    c.JoinDot: lambda s, p: c.JoinDot(ElementId("dots.d1"), port("blend.second")),
    c.RemoveDot: lambda s, p: c.RemoveDot(ElementId("dots.d1")),
    c.MoveElements: lambda s, p: c.MoveElements([ElementId("n1"), ElementId("frames.f1")], 10.0, 20.0),
    c.PlaceElement: lambda s, p: c.PlaceElement(ElementId("n1"), 10.0, 20.0),
    c.AlignSelection: lambda s, p: c.AlignSelection("left"),
    c.ArrangeElements: lambda s, p: c.ArrangeElements(),
    c.AddInput: lambda s, p: c.AddInput("extra"),
    c.AddOutput: lambda s, p: c.AddOutput("extra"),
    c.RemoveEnd: lambda s, p: c.RemoveEnd(ElementId("outputs.image")),
    c.RenameEnd: lambda s, p: c.RenameEnd(ElementId("inputs.beauty"), "plate"),
    c.SetInput: lambda s, p: c.SetInput("beauty", file="a.exr"),
    c.SetOutput: lambda s, p: c.SetOutput("image", view="none"),
    c.CutSelection: lambda s, p: c.CutSelection(),
    c.PasteText: lambda s, p: c.PasteText(copy_elements(s.graph, s.selection)),
    c.DuplicateSelection: lambda s, p: c.DuplicateSelection(),
    c.MakeGroup: lambda s, p: c.MakeGroup("look"),
    c.Ungroup: lambda s, p: c.Ungroup("body"),
    c.MakeGroupLocal: lambda s, p: c.MakeGroupLocal("lent"),
    c.LinkGroup: lambda s, p: c.LinkGroup("body", p / "body.json", s.graph.nodes["body"].graph),
    c.SetCode: lambda s, p: c.SetCode("code", CODE),
    c.EmbedCode: lambda s, p: c.EmbedCode("filed"),
    c.LinkCodeFile: lambda s, p: c.LinkCodeFile("code", p / "other.glsl"),
    c.AssignViewer: lambda s, p: c.AssignViewer(3, port("n1.out")),
    c.ReplaceDocument: lambda s, p: c.ReplaceDocument("Reload", chain(2)),
    c.ReplaceGraph: lambda s, p: c.ReplaceGraph("Replace", s.graph.disconnect(port("n1.image"))),
}
CLASSES = sorted(
    {item for item in vars(c).values() if isinstance(item, type) and issubclass(item, EditCommand)} - {EditCommand},
    key=lambda item: item.__name__,
)


@pytest.fixture
def session(tmp_path: Path) -> Session:
    """A document with one of everything."""
    document.save(chain(1), tmp_path / "group.json", sandbox=UNRESTRICTED)
    (tmp_path / "code.glsl").write_text(CODE)
    session = Session(sandbox=UNRESTRICTED)
    types = {**session.types, **TOYS}
    session = Session(types, sandbox=UNRESTRICTED)
    graph = chain(3).add("gain", TOYS["gain"]()).add("blend", TOYS["blend"]()).add("render", types["read_render"]())
    graph = graph.connect(port("n0.out"), port("blend.first")).connect(port("n0.out"), port("blend.second"))
    graph = (
        graph.add("masks", types["roto"]())
        .add("soften", TOYS["soften"]())
        .add("lamps", TOYS["lamps"](lights=number_lights([Light(), Light(intensity=2.0)])))
    )
    session.apply(c.ReplaceGraph("Start", dataclasses.replace(graph, folder=str(tmp_path))))
    session.apply(c.SetValue(GAIN, 0.75))
    for name, command in {
        "body": c.AddGroupFile(tmp_path / "group.json"),
        "lent": c.AddGroupFile(tmp_path / "group.json"),
        "code": c.AddNode("glsl"),
        "filed": c.AddCodeFile(tmp_path / "code.glsl"),
    }.items():
        id = session.apply(command)
        if id != name:
            session.apply(c.RenameNode(id, name))
    session.apply(c.MakeGroupLocal("body"))
    session.apply(c.ExposeValue(port("n1.gain"), "strength"))
    session.apply(c.SetKey(port("n0.gain"), 0.5))
    session.apply(c.KeyPoints(POINTS, (2,), "Key a point"))
    session.apply(c.AddFrame("Here", (0.0, 0.0)))
    session.apply(c.AddComment((0.0, 300.0), "text"))
    session.apply(c.AddDot(port("blend.first"), (50.0, 50.0)))
    session.apply(c.PlaceElement(ElementId("n1"), 900.0, 700.0))
    session.select([ElementId("n0"), ElementId("n1")])
    return session


def test_every_command_has_an_example() -> None:
    assert set(EXAMPLES) == set(CLASSES)


@pytest.mark.parametrize("command_class", CLASSES, ids=lambda item: item.__name__)
def test_a_command_is_a_documented_frozen_value(command_class: type[EditCommand]) -> None:
    assert (command_class.__doc__ or "").strip().endswith((".", "`y`.")) and command_class.__struct_config__.frozen


@pytest.mark.parametrize("command_class", CLASSES, ids=lambda item: item.__name__)
def test_undo_gives_back_the_document_before(
    command_class: type[EditCommand], session: Session, tmp_path: Path
) -> None:
    command = EXAMPLES[command_class](session, tmp_path)
    before, steps = (session.root, session.selection), len(session.history.steps)
    edited = command.apply(session)
    assert (session.root, session.selection) == before, "a command changes nothing by itself"
    assert edited.label
    session.apply(command)
    assert session.root != before[0] and session.history.steps[steps:] == (edited.label,)
    after = session.root
    session.undo()
    assert (session.root, session.selection) == before
    session.redo()
    assert session.root == after


@pytest.mark.parametrize("command_class", CLASSES, ids=lambda item: item.__name__)
def test_equal_merge_tokens_make_one_step(command_class: type[EditCommand], session: Session, tmp_path: Path) -> None:
    command = EXAMPLES[command_class](session, tmp_path)
    if "merge" not in command.__struct_fields__:
        pytest.skip("it is never part of a drag")
    before, steps = session.root, len(session.history.steps)
    session.apply(structs.replace(command, merge="drag"))
    session.abandon("drag")
    assert session.root == before and len(session.history.steps) == steps


def test_what_makes_no_sense_changes_nothing(session: Session) -> None:
    before = session.root, session.history.steps
    for command in (c.RenameNode("nobody", "x"), c.Disconnect(Port("n0", "nothing")), c.AddNode("nothing")):
        with pytest.raises(GraphError):
            session.apply(command)
    assert (session.root, session.history.steps) == before
    assert isinstance(session.root, Graph)
