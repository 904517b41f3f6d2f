"""What panels and dialogs can show, for a still editor: each function yields the name of a screen and its panel."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from gui_renders import list_renders
from gui_screens import SAMPLES
from halation.authoring.background.graph_fit import FitOutcome, FitStep, FittedNumberReport
from halation.authoring.commands import (
    AddComment,
    AddFrame,
    AddNode,
    AnimateValues,
    ExposeValue,
    LinkCodeFile,
    MakeGroup,
    ReplaceGraph,
    SetCode,
    SetFrameRange,
    SetValue,
)
from halation.authoring.edits.element_id import ElementId
from halation.authoring.recovery.recovery import RecoveredWork
from halation.editor.shared.dialogs import Browse, Purpose, Question
from halation.editor.shared.window_commands import PanelTitle
from halation.graph import Expression, Graph, Key, Keys, Port
from halation.nodes import Light, LightKind, Node, Value, catalogue, number_lights
from imgui_bundle import imgui
from still_editor import StillEditor
from toy_nodes import Lamps, Tint

Screens = Iterator[tuple[str, str]]

PURPOSES: tuple[tuple[Purpose, bool], ...] = (("image", False), ("graph", False), ("export", True))


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
    yield from _show_code(still)


def _show_code(still: StillEditor) -> Screens:
    """Code in the graph, code that is broken, and code in a file, as it is there and as a draft."""
    session = still.editor.session
    added = session.apply(AddNode("glsl"))
    still.select(added)
    yield "code", "Code"
    text = session.code_files.find_code(added).text  # pyright: ignore[reportOptionalMemberAccess]
    session.apply(SetCode(added, text.replace("vec4", "vec5", 1)))
    yield "broken code", "Code"
    session.apply(SetCode(added, text))
    session.apply(LinkCodeFile(added, "still.glsl"))
    yield "code file", "Code"
    session.apply(SetCode(added, text + "// more"))
    yield "draft of a code file", "Code"


def show_dialogs(still: StillEditor) -> Screens:
    """What lies on top."""
    dialogs = still.editor.dialogs
    for name, title in (("shortcuts", "Shortcuts"), ("preferences", "Preferences"), ("palette", "Command palette")):
        dialogs.open.add(name)
        yield name, title
        if name == "palette":
            imgui.get_io().add_input_characters_utf8("node")
            yield "palette with letters", title
        dialogs.open.clear()
    answers = (("Save", lambda: None), ("Do not save", lambda: None), ("Cancel", lambda: None))
    dialogs.question = Question("Save the changes?", "'many_things' was changed.", answers)
    yield "question", "Question"
    dialogs.question = None
    dialogs.matches = True
    yield "match", "Match"
    yield from _show_search_for_values(still)
    dialogs.matches = False
    still.editor.log.add("saved")
    still.editor.log.add("the graphics card is short of memory", "warning")
    yield "toasts", "Messages"


def _show_search_for_values(still: StillEditor) -> Screens:
    """The window of a search: before its first picture, while it runs, and each way that it ends."""
    window: Any = still.find("Match")
    values = tuple(
        FittedNumberReport(f"grade.gain.{number}", 1.0, 0.5 + 0.123456 * number, number % 3 != 0)
        for number in range(12)
    )
    found = FitOutcome(error=(0.25, 0.0123), delta_e=(12.0, 1.5), values=values, renders=321, seconds=14.6)
    for name, step, outcome in (
        ("match begins", None, None),
        ("match runs", FitStep({}, 0.05, 17, 0.4), None),
        ("match found", None, found),
        ("match found less", None, FitOutcome(error=(0.25, 0.2), values=values[:2], renders=1)),
        (
            "match failed",
            None,
            FitOutcome(fault="the reference has 3 rows, and the picture has 4: choose one of its size"),
        ),
    ):
        window._search._fit = SimpleNamespace(step=step, outcome=outcome, stop=lambda: None)
        yield name, "Match"
    window.close()


def show_more_dialogs(still: StillEditor) -> Screens:
    """Pages, files and pictures on top."""
    dialogs, session = still.editor.dialogs, still.editor.session
    dialogs.open.add("preferences")
    for page in ("System", "Shortcuts"):
        still.click("Preferences", f"page {page}")
        yield f"preferences {page}", "Preferences"
    dialogs.open.clear()
    still.select("bloom")
    for name, title in (("about", "About"), ("export", "Export"), ("preset", "Save as preset"), ("node", "Node")):
        dialogs.open.add(name)
        yield name, title
        dialogs.open.clear()
    dialogs.page = PanelTitle.RENDERS
    dialogs.open.add("panel")
    yield "panel", "Panel"
    dialogs.open.clear()
    for path in (Path("/pictures/one.json"), Path("/pictures/a/long/way/down/gone_with_the_wind.json")):
        still.editor.store.note_opened(path)
    dialogs.open.add("start")
    yield "start", "Start"
    start: Any = still.find("Start")
    start._recovered = tuple(
        RecoveredWork(Path("left.json"), path, time=1e9, nodes=nodes, fault=fault)
        for nodes, fault, path in ((1, "", None), (17, "", Path("/pictures/one.json")), (0, "it is damaged", None))
    )
    yield "start with work that was lost", "Start"
    dialogs.open.clear()
    for purpose, saving in PURPOSES:
        still.editor.store.note_folder(purpose, (SAMPLES if purpose == "image" else SAMPLES.parent) / "x")
        dialogs.browse = Browse(f"Choose: {purpose}", purpose, lambda path: None, saving, "halation.png")
        for look in ("grid", "list"):
            yield f"{purpose} {look}", "Files"
            still.click("Files", "list or grid")
        dialogs.browse = None
    session.select([])


def show_animation(still: StillEditor) -> Screens:
    """Keys, curves and formulas, in the Animation panel, the inspector and on the timeline."""
    session, curves = still.editor.session, still.editor.curves
    intensity, gain, knee = Port("bloom", "intensity"), Port("grade", "gain"), Port("bloom", "knee")
    session.apply(SetFrameRange(1, 48))
    keys = {
        intensity: Keys((Key(1, 0.2), Key(12, 0.9), Key(24, 0.9), Key(40, 0.1, "constant"))),
        knee: Keys((Key(5, 0.2, "bezier"), Key(20, 1.0, "bezier"), Key(30, 0.4, "linear")), "loop"),
        gain: Keys((Key(1, (1.0,) * 4), Key(10, (1.5, 0.7, 0.8, 1.0), "linear"), Key(30, (0.8, 1.2, 1.4, 1.0)))),
        Port("tone_map", "exposure"): Expression("0.3 + 0.1 * sin(time * tau)"),
    }
    session.apply(AnimateValues(keys, "Animate"))
    session.time.seek(16)
    for name in ("bloom", "grade", "tone_map"):
        still.select(name)
        yield name, "Inspector"
    for mode in ("sheet", "curves"):
        curves.mode = mode
        for count in (0, 1, 3):
            curves.choose(frozenset([(intensity, 12.0, 0), (intensity, 24.0, 0), (knee, 20.0, 0)][:count]))
            curves.fit()
            yield f"{mode} {count}", "Animation"
    yield "History", "History"
    yield "timeline", "Timeline"
    session.time.seek(40)
    yield "timeline later", "Timeline"


def show_renders(still: StillEditor) -> Screens:
    """Renders in every state, and the form for many files."""
    still.editor.exports.all = list_renders()
    yield "queue", "Renders"
    still.click("Renders", "notes 3")
    yield "notes", "Renders"
    still.click("Renders", "compare 5")
    yield "compare", "Renders"
