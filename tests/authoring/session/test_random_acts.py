"""Whatever a person does, in whatever order: the document stays one that can be saved, and everything can be undone."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest
from halation.authoring.edits.align import Side
from halation.authoring.edits.elements import list_elements, place
from halation.authoring.session import Session
from halation.document import dumps, loads
from halation.errors import HalationError
from halation.graph import Graph, Group, Keys, Port, problems, signature
from halation.nodes import Kind
from toy_nodes import TOYS, random_graph, random_value

Act = Callable[[Session, Random], object]


def any_node(session: Session, rng: Random) -> str:
    return rng.choice([*session.graph.nodes, "nobody"])


def any_group(session: Session, rng: Random) -> str:
    groups = [id for id, item in session.graph.nodes.items() if isinstance(item, Group)]
    return rng.choice([*groups, any_node(session, rng)])


def any_key(session: Session, rng: Random) -> str:
    return rng.choice([*session.elements, "nobody"])


def some_keys(session: Session, rng: Random) -> list[str]:
    known = [*session.elements]
    return rng.sample(known, min(len(known), rng.choice([0, 1, 2, 3, 9])))


def any_target(session: Session, rng: Random) -> Port:
    graph = session.graph
    sockets = [
        Port(id, name)
        for id, item in graph.nodes.items()
        for name in (*signature(item).inputs, *signature(item).values)
    ]
    return rng.choice([*graph.links, *sockets, *(Port("outputs", name) for name in graph.outputs), Port("no", "body")])


def any_source(session: Session, rng: Random) -> Port:
    graph = session.graph
    sockets = [Port(id, name) for id, item in graph.nodes.items() for name in signature(item).outputs]
    return rng.choice([*sockets, *(Port("inputs", name) for name in graph.inputs), Port("no", "body")])


def any_value(session: Session, rng: Random) -> Port:
    graph = session.graph
    return rng.choice(
        [Port("no", "body"), *(Port(id, name) for id, item in graph.nodes.items() for name in signature(item).values)]
    )


def spot(rng: Random) -> tuple[float, float]:
    return rng.uniform(-500, 500), rng.choice([0.0, 100.0, rng.uniform(-500, 500)])


def any_setting(session: Session, rng: Random) -> None:
    port = any_value(session, rng)
    item = session.graph.nodes.get(port.node)
    kind = type(item) if not isinstance(item, Group) else TOYS["gain"]
    value = random_value(rng, kind, port.socket) if port.socket in getattr(kind, "values", {}) else rng.choice([1, "a"])
    session.set(port, value, rng.choice(["", "drag"]))


def some_animated(session: Session, rng: Random) -> Port:
    return rng.choice([*session.graph.animation, *session.graph.animation, any_value(session, rng)])


def any_frame(session: Session, rng: Random) -> str:
    return rng.choice([key.removeprefix("frames.") for key in session.elements if key.startswith("frames.")] or ["f1"])


def any_comment(session: Session, rng: Random) -> str:
    found = [key.removeprefix("comments.") for key in session.elements if key.startswith("comments.")]
    return rng.choice(found or ["c1"])


def any_dot(session: Session, rng: Random) -> str:
    return rng.choice([key.removeprefix("dots.") for key in session.elements if key.startswith("dots.")] or ["d1"])


ACTS: dict[str, Act] = {
    "select": lambda s, r: s.select(some_keys(s, r), r.choice(["replace", "add", "remove", "toggle"])),
    "select_all": lambda s, r: s.select_all(),
    "select_none": lambda s, r: s.select_none(),
    "select_inverse": lambda s, r: s.select_inverse(),
    "select_upstream": lambda s, r: s.select_upstream(),
    "select_downstream": lambda s, r: s.select_downstream(),
    "select_linked": lambda s, r: s.select_linked(),
    "add_node": lambda s, r: s.add_node(
        r.choice([*TOYS, "glsl"]), spot(r), r.choice([None, any_source(s, r), any_target(s, r)]), r.random() < 0.5
    ),
    "insert": lambda s, r: s.insert(
        r.choice([*TOYS, "glsl", any_node(s, r)]), any_target(s, r), r.choice([None, spot(r)])
    ),
    "splice": lambda s, r: s.splice(some_keys(s, r), any_target(s, r), spot(r), None, r.choice(["", "drag"])),
    "abandon": lambda s, r: s.abandon(r.choice(["", "drag"])),
    "connect": lambda s, r: s.connect(any_source(s, r), any_target(s, r)),
    "disconnect": lambda s, r: s.disconnect(any_target(s, r)),
    "disconnect_all": lambda s, r: s.disconnect_all(any_key(s, r)),
    "cut": lambda s, r: s.cut([any_target(s, r), any_target(s, r)]),
    "move_link": lambda s, r: s.move_link(any_target(s, r), any_target(s, r)),
    "swap_inputs": lambda s, r: s.swap_inputs(any_node(s, r)),
    "delete": lambda s, r: s.delete(r.random() < 0.7),
    "extract": lambda s, r: s.extract(r.choice(["", "drag"])),
    "replace": lambda s, r: s.replace(any_node(s, r), r.choice([*TOYS, "glsl"])),
    "rename": lambda s, r: s.rename(any_node(s, r), r.choice(["a", "b", "blur", "frames", "inputs", "a.b", "x/y"])),
    "mute": lambda s, r: s.mute(),
    "collapse": lambda s, r: s.collapse(),
    "cut_out": lambda s, r: s.cut_out(),
    "paste": lambda s, r: s.paste(s.copy(), r.choice([None, spot(r)]), r.random() < 0.5),
    "duplicate": lambda s, r: s.duplicate(),
    "set": any_setting,
    "reset": lambda s, r: s.reset(any_value(s, r)),
    "reset_all": lambda s, r: s.reset_all(any_node(s, r)),
    "expose": lambda s, r: s.expose(any_value(s, r), r.choice(["", "a", "b"])),
    "hide": lambda s, r: s.hide(r.choice([*s.graph.controls, "no"])),
    "rename_control": lambda s, r: s.rename_control(r.choice([*s.graph.controls, "no"]), r.choice("abc")),
    "set_control_doc": lambda s, r: s.set_control_doc(r.choice([*s.graph.controls, "no"]), "Label", "Doc\ud800."),
    "add_frame": lambda s, r: s.add_frame("t", r.choice([None, spot(r)])),
    "set_frame": lambda s, r: s.set_frame(any_frame(s, r), r.choice([None, "x"]), (0.1, 0.2, 0.3)),
    "resize_frame": lambda s, r: s.resize_frame(any_frame(s, r), *spot(r), *spot(r), r.choice(["", "drag"])),
    "add_comment": lambda s, r: s.add_comment(spot(r), "note"),
    "set_comment": lambda s, r: s.set_comment(any_comment(s, r), r.choice(["", "über\n"])),
    "resize_comment": lambda s, r: s.resize_comment(any_comment(s, r), *spot(r), 80.0),
    "add_dot": lambda s, r: s.add_dot(any_target(s, r), spot(r)),
    "join_dot": lambda s, r: s.join_dot(any_dot(s, r), any_target(s, r)),
    "remove_dot": lambda s, r: s.remove_dot(any_dot(s, r)),
    "move": lambda s, r: s.move(some_keys(s, r), *spot(r), r.choice(["", "drag"])),
    "place_at": lambda s, r: s.place_at(any_key(s, r), *spot(r)),
    "align": lambda s, r: s.align(r.choice(Side.__args__)),
    "arrange": lambda s, r: s.arrange(),
    "make_group": lambda s, r: s.make_group(r.choice(["", "glow", "a.b"])),
    "ungroup": lambda s, r: s.ungroup(any_group(s, r)),
    "enter": lambda s, r: s.enter(any_group(s, r)),
    "leave": lambda s, r: s.leave(r.choice([0, 1, 1, 2])),
    "make_local": lambda s, r: s.make_local(any_group(s, r)),
    "add_input": lambda s, r: s.add_input(r.choice("abc"), r.choice([*Kind]), r.randint(2, 4), spot(r)),
    "add_output": lambda s, r: s.add_output(r.choice("abc"), r.choice([*Kind]), r.randint(2, 4)),
    "remove_end": lambda s, r: s.remove_end(any_key(s, r)),
    "rename_end": lambda s, r: s.rename_end(any_key(s, r), r.choice("abc")),
    "set_input": lambda s, r: s.set_input(
        r.choice([*s.graph.inputs, "no"]), file="a.exr", default=r.choice([None, 1.0, (1.0, 2.0), "x", True])
    ),
    "set_output": lambda s, r: s.set_output(r.choice([*s.graph.outputs, "no"]), layer="Z", view="none"),
    "set_size": lambda s, r: s.set_size(r.choice([None, (64, 48), (0, 3)])),
    "view": lambda s, r: s.view(any_source(s, r), r.choice(["A", "B"])),
    "view_nothing": lambda s, r: s.view_nothing(),
    "view_node": lambda s, r: s.view_node(any_key(s, r)),
    "assign_viewer": lambda s, r: s.assign_viewer(r.randint(0, 9), r.choice([None, any_source(s, r)])),
    "recall_viewer": lambda s, r: s.recall_viewer(r.randint(1, 9)),
    "seek": lambda s, r: s.seek(r.randint(-3, 40)),
    "set_frames": lambda s, r: s.set_frames(r.choice([None, 1, 9]), r.choice([None, 5, 24])),
    "set_rate": lambda s, r: s.set_rate(r.choice([0.0, 24.0, 25.0])),
    "set_preroll": lambda s, r: s.set_preroll(r.choice([None, -1, 0, 6])),
    "set_color": lambda s, r: s.set_color(working=r.choice([None, "", "ACEScg"]), config=r.choice([None, "no.ocio"])),
    "key": lambda s, r: s.key(any_value(s, r), r.choice([None, None, 0.5]), r.choice(["", "drag"])),
    "unkey": lambda s, r: s.unkey(some_animated(s, r)),
    "toggle_key": lambda s, r: s.toggle_key(some_animated(s, r)),
    "animate": lambda s, r: s.animate(
        some_animated(s, r), r.choice([None, Keys(), Keys().set(2, 1.0).set(8.5, 0.5, "bezier")]), "Animate"
    ),
    "express": lambda s, r: s.express(
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
    ),
    "bake": lambda s, r: s.bake(some_animated(s, r), r.choice([None, [1, 3], []])),
    "set_code": lambda s, r: s.set_code(
        r.choice([*s.graph.nodes, "no"]),
        r.choice(["", "nonsense", "vec4 f(vec4 a) { return a; }", "float g(vec4 b, float k /* = 1 */) { return k; }"]),
        merge=r.choice(["", "burst"]),
    ),
    "inline_code": lambda s, r: s.inline_code(r.choice([*s.graph.nodes, "no"])),
    "look_again": lambda s, r: s.look_again(),
    "undo": lambda s, r: s.undo(),
    "redo": lambda s, r: s.redo(),
    "seal": lambda s, r: s.seal(),
    "bind": lambda s, r: s.bind(r.choice([*s.root.inputs, "no"]), r.choice([None, "a.exr"])),
}

OTHERS = {
    "edit",
    "go",
    "go_to",
    "new",
    "open",
    "open_copy",
    "open_made",
    "open_text",
    "restore",
    "save",
    "save_as",
    "revert",
    "reload",
    "reload_groups",
    "migrate",
    "save_group",
    "add_group",
    "drop_files",
    "add_matte",
    "animate_all",
    "set_all",
    "add_code_file",
    "export_code",
    "save_code",
    "save_drafts",
    "reread_code",
    "note_code_files",
    "keep_draft",
}
"""What needs files or graphs, and what all the others call: tested by name elsewhere."""

QUESTIONS = {
    "value",
    "is_default",
    "linked",
    "control_of",
    "fitting",
    "fitting_files",
    "refusal",
    "relative",
    "position",
    "frame_members",
    "copy",
    "viewed",
    "viewed_in_root",
    "can_animate",
    "animation",
    "key_at",
    "value_now",
    "value_then",
    "animated_outside",
    "expression_fault",
    "key_frames",
    "next_key",
    "previous_key",
    "code",
    "fits_picture",
    "differs_from_disk",
}


def test_every_method_takes_part():
    methods = {name for name, item in inspect.getmembers(Session, inspect.isfunction) if not name.startswith("_")}
    assert methods == ACTS.keys() | OTHERS | QUESTIONS


def check(session: Session) -> None:
    """What is true whenever somebody looks."""
    known = set(list_elements(session.graph))
    assert session.selection <= known
    assert session.active in session.selection or not session.active
    assert all(place(session.graph, key) is not None for key in known)
    assert session.positions.keys() == known
    found = [problem for some in session.problems.values() for problem in some]
    assert sorted(map(str, found)) == sorted(map(str, problems(session.graph, session.types)))
    assert session.problems.keys() <= known | {""}
    assert set(session.all_problems) == set(problems(session.root, session.types))
    dots = {key for key in known if key.startswith("dots.")}
    passed = session.graph.ui.get("routes", {})
    assert {str(end) for end in session.graph.links} >= passed.keys()
    assert dots == {f"dots.{dot}" for route in passed.values() for dot in route}
    viewed = session.viewed()
    assert viewed is None or viewed.node in {*session.graph.nodes, "inputs", "outputs"}
    for port in (*session.graph.links, *session.graph.links.values()):
        assert port.node in {*session.graph.nodes, "inputs", "outputs"}


def shot(session: Session) -> tuple[object, ...]:
    return session.root, session.place, session.selection, session.active


@pytest.mark.parametrize("seed", range(40))
def test_random_acts(seed: int):
    rng = Random(seed)
    session = Session(TOYS)
    start = random_graph(rng, 40)
    session.edit("Start", start)
    session._restart(session.root, None, session.root)
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
        assert loads(dumps(session.root), catalogue=TOYS) == session.root, name
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
    assert Path(session.folder) == Path()
    assert isinstance(session.root, Graph)
