"""A panel draws the same wherever it is, and everything twice as large on an interface of twice the size.

Places and lengths follow from the panel's own corner, its size and the scale of the interface: one that does not, a sum
in place of a difference or a length in pixels, breaks one of these. Nothing here knows how a panel looks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from drawn_shapes import Shape
from gui_screens import write_many_things
from halation.authoring.commands import (
    AddComment,
    AddFrame,
    ExposeValue,
    MakeGroup,
    ReplaceGraph,
    SetValue,
)
from halation.authoring.edits.element_id import ElementId
from halation.editor.shared.dialogs import Question
from halation.graph import Graph, Port
from halation.nodes import Light, LightKind, Node, Value, catalogue, number_lights
from still_editor import StillEditor, open_still_editor
from toy_nodes import Lamps, Tint

Screens = Iterator[tuple[str, str]]


def list_typical_nodes() -> list[type[Node]]:
    """Node types, each with a kind of value that none before it has."""
    seen, chosen = set[tuple[object, ...]](), list[type[Node]]()
    for node in catalogue().values():
        new = {describe_kind(value) for value in node.values.values()} - seen
        if new:
            seen |= new
            chosen.append(node)
    return chosen


def describe_kind(value: Value) -> tuple[object, ...]:
    """What the field of a value depends on."""
    parts = value.unit, value.wheel, value.matte, value.space, value.file, value.role, value.items, value.layer_by
    return value.type, value.length, *map(bool, parts), value.has_lines, value.cyclic, value.turns, bool(value.folded)


def show_typical_nodes(still: StillEditor) -> Screens:
    """One field of every kind, at its default and changed."""
    for node in list_typical_nodes():
        still.editor.session.apply(ReplaceGraph("Start", Graph().add("node", node())))
        still.select("node")
        yield node.__name__, "Inspector"


def show_values(still: StillEditor) -> Screens:
    """What can be selected, and what values can be: linked, exposed, with items, in groups."""
    session = still.editor.session
    lights = tuple(Light(kind, color=(1.0, 0.2, 0.1), on=kind != LightKind.SUN) for kind in (*LightKind, *LightKind))
    graph = session.graph.add("curves", Tint()).add("lamps", Lamps(lights=number_lights(lights)))
    session.apply(ReplaceGraph("Add", graph))
    session.apply(ExposeValue(Port("vignette", "falloff")))
    session.apply(SetValue(Port("vignette", "softness"), 0.75))
    for name in ("grade", "bloom", "vignette", "curves", "lamps", "inputs.beauty", "inputs.amount", "outputs.image"):
        still.select(name)
        yield name, "Inspector"
    still.select("grade", "vignette")
    yield "several", "Inspector"
    still.select()
    yield "nothing", "Inspector"
    still.select("grade", "bloom")
    frame = session.apply(AddFrame("Look", sizes={}))
    comment = session.apply(AddComment((40.0, -160.0), "Check the highlights\nwith the client."))
    for element in (frame, comment):
        session.select([ElementId(element)])
        yield element, "Inspector"
    still.select("grade", "bloom")
    session.apply(MakeGroup("look"))
    yield "group", "Inspector"


def show_panels(still: StillEditor) -> Screens:
    """Panels without and with something in them."""
    titles = "History", "Log", "Problems", "Renders", "Passes", "Code", "Scopes", "Viewer", "Graph", "Animation"
    for title in titles:
        yield title, title
    still.editor.session.apply(SetValue(Port("bloom", "intensity"), 0.9))
    still.editor.log.clock = lambda: 1e9
    for level in ("info", "warning", "error"):
        still.editor.log.add(f"a message that is an {level}", level)
    still.editor.faults["Nowhere"] = "Traceback (most recent call last):\n  the details"
    still.select("grade", "bloom")
    for title in titles:
        yield f"{title} again", title


def show_dialogs(still: StillEditor) -> Screens:
    """What lies on top."""
    dialogs = still.editor.dialogs
    for name, title in (("shortcuts", "Shortcuts"), ("preferences", "Preferences"), ("palette", "Command palette")):
        dialogs.open.add(name)
        yield name, title
        dialogs.open.clear()
    answers = (("Save", lambda: None), ("Do not save", lambda: None), ("Cancel", lambda: None))
    dialogs.question = Question("Save the changes?", "'many_things' was changed.", answers)
    yield "question", "Question"
    dialogs.question = None
    dialogs.matches = True
    yield "match", "Match"
    dialogs.matches = False
    still.editor.log.add("saved")
    still.editor.log.add("the graphics card is short of memory", "warning")
    yield "toasts", "Messages"


@pytest.fixture(scope="module")
def draw(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., dict[str, list[Shape]]]:
    folder = tmp_path_factory.mktemp("still")
    path = write_many_things(folder)

    def draw(screens: Callable[[StillEditor], Screens], file: Path | None = path, **options) -> dict[str, list[Shape]]:
        """What each screen draws."""
        with open_still_editor(folder, file, **options) as still:
            return {name: still.show(title, 4) for name, title in screens(still)}

    return draw


def compare(first: list[Shape], second: list[Shape], factor: float, shift: tuple[float, float]) -> str:
    """The first thing that is not where it should be."""
    slack = 1.0 + factor if factor != 1.0 else 0.01  # places are rounded to whole pixels
    for one, other in zip(first, second, strict=False):
        expected = one.change(factor, shift)
        if (one.kind, one.text, one.color) != (other.kind, other.text, other.color):
            return f"{one} has become {other}"
        wanted = [*(number for point in expected.points for number in point), *expected.lengths]
        drawn = [*(number for point in other.points for number in point), *other.lengths]
        if len(wanted) != len(drawn) or any(abs(a - b) > slack for a, b in zip(wanted, drawn, strict=True)):
            return f"{expected} is {other}"
    return "" if len(first) == len(second) else f"{len(first)} shapes have become {len(second)}"


@pytest.mark.parametrize("screens", [show_typical_nodes, show_values, show_panels])
def test_a_panel_that_is_moved_draws_the_same(draw, screens) -> None:
    here, there = draw(screens), draw(screens, at=(220.0, 130.0))
    assert not {name: fault for name in here if (fault := compare(here[name], there[name], 1.0, (200.0, 100.0)))}


@pytest.mark.parametrize("screens", [show_typical_nodes, show_values, show_panels, show_dialogs])
def test_everything_grows_with_the_interface(draw, screens) -> None:
    small, large = draw(screens), draw(screens, scale=2.0)
    faults = {name: fault for name in small if (fault := compare(small[name], large[name], 2.0, (0.0, 0.0)))}
    assert faults.keys() <= {"Graph", "Graph again"}, faults  # its grid has as many lines as pixels allow
