"""Whatever a person does, in whatever order: the document stays one that can be saved, and everything can be undone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest
from halation.authoring import commands
from halation.authoring.commands import (
    AddComment,
    AddDot,
    AddFrame,
    AddInput,
    AddItem,
    AddNode,
    AddOutput,
    AlignSelection,
    AnimateValue,
    AppendNode,
    ArrangeElements,
    AssignViewer,
    BakeKeys,
    Connect,
    ConnectNodes,
    ConnectSelection,
    ConvertLength,
    CutLinks,
    CutSelection,
    DeleteSelection,
    DescribeControl,
    Disconnect,
    DisconnectAll,
    DuplicateItem,
    DuplicateSelection,
    EditCommand,
    EditComment,
    EditFrame,
    EmbedCode,
    ExchangeItems,
    ExposeValue,
    ExtractSelection,
    HideControl,
    InsertNode,
    JoinDot,
    MakeGroup,
    MakeGroupLocal,
    MoveElements,
    MoveLink,
    PasteText,
    PlaceElement,
    RemoveDot,
    RemoveEnd,
    RemoveItem,
    RemoveKey,
    RenameControl,
    RenameEnd,
    RenameItem,
    RenameNode,
    ReplaceGraph,
    ReplaceNode,
    ResetNode,
    ResetValue,
    ResizeComment,
    ResizeFrame,
    SetCanvasSize,
    SetCode,
    SetColorSettings,
    SetExpression,
    SetFrameRange,
    SetFrameRate,
    SetInput,
    SetKey,
    SetOutput,
    SetOverscan,
    SetPreroll,
    SetReferenceHeight,
    SetValue,
    SpliceChain,
    SwapInputs,
    ToggleCollapse,
    ToggleKey,
    ToggleMute,
    Ungroup,
)
from halation.authoring.edits.align import Side
from halation.authoring.edits.clipboard import copy_elements
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import list_decor, list_elements, place
from halation.authoring.edits.selection import find_downstream, find_linked, find_upstream, invert_selection
from halation.authoring.session import Session
from halation.document import dumps, loads
from halation.errors import HalationError
from halation.graph import Graph, Group, Keys, Port, Problem, problems
from halation.graph.rules import UNFED_OUTPUT
from halation.nodes import Kind, LightKind
from halation.resources.sandbox import UNRESTRICTED
from random_choices import (
    any_group,
    any_item,
    any_items,
    any_key,
    any_node,
    any_source,
    any_target,
    any_value,
    some_keys,
    spot,
)
from selection import list_seeds
from toy_nodes import TOYS, random_graph, random_value

Act = Callable[[Session, Random], object]


def any_setting(session: Session, rng: Random) -> None:
    port = any_value(session, rng)
    item = session.graph.nodes.get(port.node)
    kind = type(item) if not isinstance(item, Group) else TOYS["gain"]
    value = random_value(rng, kind, port.socket) if port.socket in getattr(kind, "values", {}) else rng.choice([1, "a"])
    session.apply(SetValue(port, value, rng.choice(["", "drag"])))


def some_animated(session: Session, rng: Random) -> Port:
    return rng.choice([*session.graph.animation, *session.graph.animation, any_value(session, rng)])


def any_frame(session: Session, rng: Random) -> ElementId:
    return rng.choice([*list_decor(session.graph, "frame")] or [ElementId("frames.f1")])


def any_comment(session: Session, rng: Random) -> ElementId:
    return rng.choice([*list_decor(session.graph, "comment")] or [ElementId("comments.c1")])


def any_dot(session: Session, rng: Random) -> ElementId:
    return rng.choice([*list_decor(session.graph, "dot")] or [ElementId("dots.d1")])


ACTS: dict[str, Act] = {
    "select": lambda s, r: s.select(some_keys(s, r), r.choice(["replace", "add", "remove", "toggle"])),
    "select_all": lambda s, r: s.select(s.elements, "extend"),
    "select_none": lambda s, r: s.select(()),
    "select_inverse": lambda s, r: s.select(invert_selection(s.elements, s.selection)),
    "select_upstream": lambda s, r: s.select(find_upstream(s.graph, s.selection), "extend"),
    "select_downstream": lambda s, r: s.select(find_downstream(s.graph, s.selection), "extend"),
    "select_linked": lambda s, r: s.select(find_linked(s.graph, s.selection), "extend"),
    "add_node": lambda s, r: s.apply(
        AddNode(
            r.choice([*TOYS, "glsl"]), spot(r), r.choice([None, any_source(s, r), any_target(s, r)]), r.random() < 0.5
        )
    ),
    "append": lambda s, r: s.apply(AppendNode(AddNode(r.choice([*TOYS, "glsl"]), spot(r)))),
    "insert": lambda s, r: s.apply(
        InsertNode(r.choice([*TOYS, "glsl", any_node(s, r)]), any_target(s, r), r.choice([None, spot(r)]))
    ),
    "splice": lambda s, r: s.apply(
        SpliceChain(some_keys(s, r), any_target(s, r), spot(r), None, r.choice(["", "drag"]))
    ),
    "abandon": lambda s, r: s.abandon(r.choice(["", "drag"])),
    "connect": lambda s, r: s.apply(Connect(any_source(s, r), any_target(s, r))),
    "connect_nodes": lambda s, r: s.apply(ConnectNodes(any_source(s, r), any_target(s, r))),
    "connect_selection": lambda s, r: s.apply(ConnectSelection()),
    "disconnect": lambda s, r: s.apply(Disconnect(any_target(s, r))),
    "disconnect_all": lambda s, r: s.apply(DisconnectAll(any_key(s, r))),
    "cut": lambda s, r: s.apply(CutLinks([any_target(s, r), any_target(s, r)])),
    "move_link": lambda s, r: s.apply(MoveLink(any_target(s, r), any_target(s, r))),
    "swap_inputs": lambda s, r: s.apply(SwapInputs(any_node(s, r))),
    "delete": lambda s, r: s.apply(DeleteSelection(r.random() < 0.7)),
    "extract": lambda s, r: s.apply(ExtractSelection(r.choice(["", "drag"]))),
    "replace": lambda s, r: s.apply(ReplaceNode(any_node(s, r), r.choice([*TOYS, "glsl"]))),
    "rename": lambda s, r: s.apply(
        RenameNode(any_node(s, r), r.choice(["a", "b", "blur", "frames", "inputs", "a.b", "x/y"]))
    ),
    "mute": lambda s, r: s.apply(ToggleMute()),
    "collapse": lambda s, r: s.apply(ToggleCollapse()),
    "cut_out": lambda s, r: s.apply(CutSelection()),
    "paste": lambda s, r: s.apply(
        PasteText(copy_elements(s.graph, s.selection), r.choice([None, spot(r)]), r.random() < 0.5)
    ),
    "duplicate": lambda s, r: s.apply(DuplicateSelection()),
    "set": any_setting,
    "convert_length": lambda s, r: s.apply(
        ConvertLength(
            tuple(any_value(s, r) for _ in range(r.choice([1, 1, 2]))), r.choice(["px", "height", "px@1080", "m"]), 48
        )
    ),
    "add_item": lambda s, r: s.apply(
        AddItem(
            any_items(s, r),
            r.choice([*LightKind, "candle"]),
            r.choice([{}, {"intensity": 2.0}, {"intensity": "bright"}]),
            r.choice(["", "", "rim", "a.b"]),
        )
    ),
    "duplicate_item": lambda s, r: s.apply(DuplicateItem(*any_item(s, r))),
    "remove_item": lambda s, r: s.apply(RemoveItem(*any_item(s, r))),
    "exchange_items": lambda s, r: s.apply(ExchangeItems(*any_item(s, r), r.choice(["lamp_1", "rim", "no"]))),
    "rename_item": lambda s, r: s.apply(RenameItem(*any_item(s, r), r.choice(["rim", "key", "a.b", ""]))),
    "reset": lambda s, r: s.apply(ResetValue(any_value(s, r))),
    "reset_all": lambda s, r: s.apply(ResetNode(any_node(s, r))),
    "expose": lambda s, r: s.apply(ExposeValue(any_value(s, r), r.choice(["", "a", "b"]))),
    "hide": lambda s, r: s.apply(HideControl(r.choice([*s.graph.controls, "no"]))),
    "rename_control": lambda s, r: s.apply(RenameControl(r.choice([*s.graph.controls, "no"]), r.choice("abc"))),
    "set_control_doc": lambda s, r: s.apply(
        DescribeControl(r.choice([*s.graph.controls, "no"]), "Label", "Doc\ud800.")
    ),
    "add_frame": lambda s, r: s.apply(AddFrame("t", r.choice([None, spot(r)]))),
    "set_frame": lambda s, r: s.apply(EditFrame(any_frame(s, r), r.choice([None, "x"]), (0.1, 0.2, 0.3))),
    "resize_frame": lambda s, r: s.apply(ResizeFrame(any_frame(s, r), *spot(r), *spot(r), r.choice(["", "drag"]))),
    "add_comment": lambda s, r: s.apply(AddComment(spot(r), "note")),
    "set_comment": lambda s, r: s.apply(EditComment(any_comment(s, r), r.choice(["", "über\n"]))),
    "resize_comment": lambda s, r: s.apply(ResizeComment(any_comment(s, r), *spot(r), 80.0)),
    "add_dot": lambda s, r: s.apply(AddDot(any_target(s, r), spot(r))),
    "join_dot": lambda s, r: s.apply(JoinDot(any_dot(s, r), any_target(s, r))),
    "remove_dot": lambda s, r: s.apply(RemoveDot(any_dot(s, r))),
    "move": lambda s, r: s.apply(MoveElements(some_keys(s, r), *spot(r), r.choice(["", "drag"]))),
    "place_at": lambda s, r: s.apply(PlaceElement(any_key(s, r), *spot(r))),
    "align": lambda s, r: s.apply(AlignSelection(r.choice(Side.__args__))),
    "arrange": lambda s, r: s.apply(ArrangeElements()),
    "make_group": lambda s, r: s.apply(MakeGroup(r.choice(["", "glow", "a.b"]))),
    "ungroup": lambda s, r: s.apply(Ungroup(any_group(s, r))),
    "enter": lambda s, r: s.enter(any_group(s, r)),
    "leave": lambda s, r: s.leave(r.choice([0, 1, 1, 2])),
    "make_local": lambda s, r: s.apply(MakeGroupLocal(any_group(s, r))),
    "add_input": lambda s, r: s.apply(AddInput(r.choice("abc"), r.choice([*Kind]), r.randint(2, 4), spot(r))),
    "add_output": lambda s, r: s.apply(AddOutput(r.choice("abc"), r.choice([*Kind]), r.randint(2, 4))),
    "remove_end": lambda s, r: s.apply(RemoveEnd(any_key(s, r))),
    "rename_end": lambda s, r: s.apply(RenameEnd(any_key(s, r), r.choice("abc"))),
    "set_input": lambda s, r: s.apply(
        SetInput(r.choice([*s.graph.inputs, "no"]), file="a.exr", default=r.choice([None, 1.0, (1.0, 2.0), "x", True]))
    ),
    "set_output": lambda s, r: s.apply(SetOutput(r.choice([*s.graph.outputs, "no"]), layer="Z", view="none")),
    "set_reference_height": lambda s, r: s.apply(SetReferenceHeight(r.choice([None, 0, 540, 1080]))),
    "set_overscan": lambda s, r: s.apply(SetOverscan(r.choice([0.0, 0.1, 3.0]))),
    "set_size": lambda s, r: s.apply(SetCanvasSize(r.choice([None, (64, 48), (0, 3)]))),
    "view": lambda s, r: s.views.show(any_source(s, r), r.choice(["A", "B"])),
    "view_nothing": lambda s, r: s.views.clear(),
    "view_element": lambda s, r: s.views.show_element(any_key(s, r)),
    "assign_viewer": lambda s, r: s.apply(AssignViewer(r.randint(0, 9), r.choice([None, any_source(s, r)]))),
    "recall_viewer": lambda s, r: s.views.recall(r.randint(1, 9)),
    "seek": lambda s, r: s.time.seek(r.randint(-3, 40)),
    "set_frames": lambda s, r: s.apply(SetFrameRange(r.choice([None, 1, 9]), r.choice([None, 5, 24]))),
    "set_rate": lambda s, r: s.apply(SetFrameRate(r.choice([0.0, 24.0, 25.0]))),
    "set_preroll": lambda s, r: s.apply(SetPreroll(r.choice([None, -1, 0, 6]))),
    "set_color": lambda s, r: s.apply(
        SetColorSettings(working=r.choice([None, "", "ACEScg"]), config=r.choice([None, "no.ocio"]))
    ),
    "key": lambda s, r: s.apply(SetKey(any_value(s, r), r.choice([None, None, 0.5]), r.choice(["", "drag"]))),
    "unkey": lambda s, r: s.apply(RemoveKey(some_animated(s, r))),
    "toggle_key": lambda s, r: s.apply(ToggleKey(some_animated(s, r))),
    "animate": lambda s, r: s.apply(
        AnimateValue(
            some_animated(s, r), r.choice([None, Keys(), Keys().set(2, 1.0).set(8.5, 0.5, "bezier")]), "Animate"
        )
    ),
    "express": lambda s, r: s.apply(
        SetExpression(
            some_animated(s, r),
            r.choice(
                [
                    "",
                    "=frame / 9",
                    "1 +",
                    f"`{any_value(s, r).node}`.{any_value(s, r).socket}",
                    str(any_value(s, r)),
                    r.choice([*s.graph.controls, "no"]),
                ]
            ),
        )
    ),
    "bake": lambda s, r: s.apply(BakeKeys(some_animated(s, r), r.choice([None, [1, 3], []]))),
    "set_code": lambda s, r: s.apply(
        SetCode(
            r.choice([*s.graph.nodes, "no"]),
            r.choice(
                ["", "nonsense", "vec4 f(vec4 a) { return a; }", "float g(vec4 b, float k /* = 1 */) { return k; }"]
            ),
            merge=r.choice(["", "burst"]),
        )
    ),
    "inline_code": lambda s, r: s.apply(EmbedCode(r.choice([*s.graph.nodes, "no"]))),
    "remeasure": lambda s, r: s.time.remeasure(),
    "undo": lambda s, r: s.undo(),
    "redo": lambda s, r: s.redo(),
    "seal": lambda s, r: s.seal(),
    "bind": lambda s, r: s.bind(r.choice([*s.root.inputs, "no"]), r.choice([None, "a.exr"])),
}

TESTED_ELSEWHERE = {
    commands.AddCodeFile,
    commands.AddGroupFile,
    commands.AddMatte,
    commands.AnimateValues,
    commands.ChangePoints,
    commands.KeyPoints,
    commands.DropPointKeys,
    commands.MovePoints,
    commands.ReplaceDocument,
    commands.DropFiles,
    commands.LinkCodeFile,
    commands.LinkGroup,
    commands.ReplaceGraph,
    commands.SetValues,
}
"""Commands that need files or splines, or that others are made of."""


def test_every_command_takes_part():
    classes = {item for item in vars(commands).values() if isinstance(item, type) and issubclass(item, EditCommand)}
    used = {name for act in ACTS.values() for name in act.__code__.co_names}
    missing = {item for item in classes if item.__name__ not in used} - {EditCommand}
    assert missing == TESTED_ELSEWHERE


def list_shown(session: Session, graph: Graph) -> list[Problem]:
    """All problems of a graph, but for outputs that nothing feeds where there is no node yet."""
    found = problems(graph, session.types)
    return [one for one in found if session.graph.nodes or one.rule != UNFED_OUTPUT]


def check(session: Session) -> None:
    """What is true whenever somebody looks."""
    known = set(list_elements(session.graph))
    assert session.selection <= known
    assert session.active in session.selection or not session.active
    assert all(place(session.graph, key) is not None for key in known)
    assert session.positions.keys() == known
    found = [problem for some in session.problems.values() for problem in some]
    assert sorted(map(str, found)) == sorted(map(str, list_shown(session, session.graph)))
    assert session.problems.keys() <= known | {""}
    assert session.place or set(found) == set(list_shown(session, session.root))
    dots = {key.name for key in known if key.kind == "dot"}
    passed = session.graph.ui.get("routes", {})
    assert {str(end) for end in session.graph.links} >= passed.keys()
    assert dots == {dot for route in passed.values() for dot in route}
    viewed = session.views.find_port()
    assert viewed is None or viewed.node in {*session.graph.nodes, "inputs", "outputs"}
    for port in (*session.graph.links, *session.graph.links.values()):
        assert port.node in {*session.graph.nodes, "inputs", "outputs"}


def shot(session: Session) -> tuple[object, ...]:
    return session.root, session.place, session.selection, session.active


@pytest.mark.parametrize("seed", list_seeds(20, 40))
def test_random_acts(seed: int):
    rng = Random(seed)
    session = Session(TOYS, sandbox=UNRESTRICTED)
    start = random_graph(rng, 40)
    session.apply(ReplaceGraph("Start", start))
    session.restart(session.root, saved=session.root)
    first, refused = shot(session), 0
    for _ in range(80):
        name = rng.choice([*ACTS])
        before, steps = shot(session), (session.history.steps, session.history.position)
        try:
            ACTS[name](session, rng)
        except HalationError as error:
            refused += 1
            assert str(error) and ("\n" not in str(error) or str(error).endswith("^"))
            assert shot(session) == before, name
            assert (session.history.steps, session.history.position) == steps or session.history.position <= steps[1]
        if steps[1] == 0 and session.history.position == 1 and name != "redo":
            first = before
        check(session)
        assert loads(dumps(session.root), catalogue=TOYS, sandbox=UNRESTRICTED) == session.root, name
    assert refused < 80
    session.go_to(len(session.history.steps))
    last = shot(session)
    while session.history.can_undo:
        session.undo()
        check(session)
    assert shot(session) == first
    while session.history.can_redo:
        session.redo()
    assert shot(session)[0] == last[0]
    assert Path(session.root.folder) == Path()
    assert isinstance(session.root, Graph)
