"""Every panel and dialog of the editor in every state that looks different: each function yields names of pictures."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

from gui_driver import Ui
from gui_keys import animation
from gui_lessons import lessons
from gui_renders import exporting, renders
from halation import presets
from halation.authoring.commands import AddComment, AddFrame, ArrangeElements, Disconnect, MakeGroup, ReplaceGraph
from halation.authoring.edits.element_id import ElementId
from halation.authoring.recovery.recovery import RecoveryFile
from halation.document import save
from halation.editor.shared.dialogs import Browse, Purpose, Question
from halation.editor.window.editor import Editor
from halation.graph import Control, Graph, Input, Output, Port, Settings
from halation.nodes import Kind, Light, LightKind, catalogue, number_lights
from halation.nodes.input.read_image import ReadImage
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import Lamps, Tint

SAMPLES = presets.paths()[0].parent / "samples"
Screens = Iterator[str]


def write_many_things(folder: Path) -> Path:
    """A graph file with nodes of many kinds, a group, a file with layers, and something of everything that is drawn."""
    shutil.copytree(SAMPLES, folder / "samples", dirs_exist_ok=True)
    node = catalogue()
    graph = Graph(settings=Settings((320, 180)))
    graph = graph.add_input("beauty", Input(Kind.IMAGE, 4, file="samples/studio.exr", doc="The picture to work on"))
    graph = graph.add_input("amount", Input(Kind.NUMBER, 1, default=0.5))
    graph = graph.add_output("image", Output(Kind.IMAGE, 4)).add_output("lights", Output(Kind.FIELD, 1))
    for id in ("grade", "noise", "bloom", "vignette", "tone_map", "convolve3x3", "luminance"):
        graph = graph.add(id, node[id]())
    graph = graph.add("plate", ReadImage(path="samples/neon.exr"))
    for source, target in (
        ("inputs.beauty", "grade.image"),
        ("grade.out", "bloom.image"),
        ("bloom.out", "vignette.image"),
        ("vignette.out", "tone_map.image"),
        ("tone_map.out", "outputs.image"),
        ("inputs.amount", "vignette.amount"),
        ("tone_map.out", "luminance.image"),
        ("luminance.out", "outputs.lights"),
        ("noise.out", "convolve3x3.image"),
    ):
        graph = graph.connect(Port.parse(source), Port.parse(target))
    graph = graph.add_control("glow", Control(Port("bloom", "intensity")))
    path = folder / "many_things.json"
    save(graph, path, sandbox=UNRESTRICTED)
    return path


# --- the main window -------------------------------------------------------------------------------------------------


def window(ui: Ui) -> Screens:
    """All panels at once, with a node selected."""
    ui.session.apply(ArrangeElements(ui.editor.canvas.sizes or {}, ui.editor.canvas.find_pins()))
    ui.editor.canvas.fit()
    ui.session.select([ElementId("bloom")])
    ui.settled()
    yield "window"


def inspector(ui: Ui) -> Screens:
    """What can be selected."""
    lamps = Lamps(
        lights=number_lights(
            tuple(
                Light(kind, color=(1.0, 0.2 * place, 0.1), intensity=4.0 - 3.0 * place, on=kind != LightKind.SUN)
                for place, kind in enumerate((LightKind.SPOT, LightKind.SUN, *LightKind, *LightKind))
            )
        )
    )
    ui.session.apply(ReplaceGraph("Add", ui.session.graph.add("curves", Tint()).add("lamps", lamps)))
    for id in ("grade", "noise", "bloom", "vignette", "tone_map", "convolve3x3", "plate", "curves", "lamps"):
        ui.session.select(ElementId(id))
        ui.wait(3)
        yield f"inspector_{id}"
    for name, keys in (
        ("input", ["inputs.beauty"]),
        ("input_number", ["inputs.amount"]),
        ("output", ["outputs.image"]),
        ("several", ["grade", "vignette"]),
        ("nothing", []),
    ):
        ui.session.select([ElementId(key) for key in keys])
        ui.wait(3)
        yield f"inspector_{name}"
    ui.session.bind("beauty", str(SAMPLES / "neon.exr"))
    ui.session.select([ElementId("inputs.beauty")])
    ui.wait(3)
    yield "inspector_bound"
    ui.session.bind("beauty", None)
    ui.session.select([ElementId("grade"), ElementId("bloom")])
    frame = ui.session.apply(AddFrame("Look", sizes=ui.editor.canvas.sizes or {}))
    ui.session.select([frame])
    ui.wait(3)
    yield "inspector_frame"
    comment = ui.session.apply(AddComment((40.0, -160.0), "Check the highlights\nwith the client."))
    ui.session.select([comment])
    ui.wait(3)
    yield "inspector_comment"
    ui.session.select([ElementId("grade"), ElementId("bloom")])
    ui.session.apply(MakeGroup("look"))
    ui.wait(3)
    yield "inspector_group"
    for _ in range(3):
        ui.session.undo()


def fields(ui: Ui) -> Screens:
    """What fields open."""
    ui.session.select([ElementId("grade")])
    ui.wait(3)
    ui.click("field grade.gain", fraction=(0.03, 0.5))
    yield "color_picker"
    ui.keys("Escape")
    ui.session.select([ElementId("tone_map")])
    ui.wait(3)
    ui.click("field tone_map.operator")
    yield "choice"
    ui.keys("Escape")
    ui.click("name tone_map.exposure", button=1)
    yield "value_menu"
    ui.keys("Escape")
    ui.click("field tone_map.exposure")
    ui.type("1.5*2", enter=False)
    yield "number_typed"
    ui.keys("Escape")
    ui.move("name tone_map.bias")
    ui.ctx.sleep_no_skip(1.0, 0.1)
    yield "tooltip"
    ui.move((3.0, 3.0))
    ui.session.select([ElementId("plate")])
    ui.wait(3)
    ui.click("field plate.layer")
    ui.wait(10)
    yield "layers"
    ui.keys("Escape")


# --- the viewer ------------------------------------------------------------------------------------------------------


def viewer(ui: Ui) -> Screens:
    """Channels, comparing, warnings and what lies over the picture."""
    seen = ui.editor.viewer
    ui.session.views.show(Port("outputs", "image"))
    ui.session.select([])
    ui.settled()
    for channels in ("red", "alpha", "luminance", "false color"):
        seen.show(channels)
        ui.wait(2)
        yield f"viewer_{channels.replace(' ', '_')}"
    seen.show("false color")
    ui.session.views.show(Port("grade", "out"), "B")
    for mode in ("wipe", "difference", "toggle"):
        seen.toggle_comparison(mode)
        ui.settled()
        yield f"viewer_{mode}"
    seen.compare = "off"
    seen.warn_clipping, seen.exposure = True, 2.0
    ui.wait(3)
    yield "viewer_clipping"
    seen.warn_clipping, seen.exposure = False, 0.0
    seen.table, seen.region, seen.measured = True, (0.2, 0.2, 0.6, 0.7), (0.3, 0.3, 0.5, 0.5)
    seen.markers = ((0.25, 0.5), (0.75, 0.25))
    ui.move("viewer image")
    ui.wait(4)
    yield "viewer_table"
    ui.click("viewer image", button=1)
    yield "viewer_menu"
    ui.keys("Escape")
    seen.table, seen.region, seen.measured, seen.markers = False, None, None, ()
    ui.session.select([ElementId("vignette")])
    ui.session.views.show(Port("outputs", "lights"))
    ui.settled()
    yield "viewer_field"
    ui.session.views.show(Port("bloom", "out"))
    ui.settled()
    ui.click("button view" if "button view" in ui.editor.places else "button more tools")
    yield "viewer_views"
    ui.keys("Escape")
    ui.keys("Escape")
    seen.paused = True
    ui.wait(2)
    yield "viewer_paused"
    seen.paused = False
    ui.session.apply(ReplaceGraph("Add", ui.session.graph.add("retouch", catalogue()["paint"]())))
    ui.session.select(ElementId("retouch"))
    ui.session.views.show(Port("retouch", "out"))
    ui.wait(6)
    yield "viewer_brush"
    ui.session.undo()
    ui.session.views.show(Port("outputs", "image"))


def scopes(ui: Ui) -> Screens:
    """All four, and one."""
    ui.editor.viewer.scopes = {"histogram", "waveform", "parade", "vectorscope"}
    ui.show_panel("Scopes")
    ui.settled()
    ui.wait(8)
    yield "scopes_all"
    ui.editor.viewer.scopes = {"waveform"}
    ui.wait(8)
    yield "scopes_waveform"
    ui.editor.viewer.scopes = set()
    ui.wait(2)
    yield "scopes_none"
    ui.editor.viewer.scopes = {"histogram", "waveform"}


# --- panels ----------------------------------------------------------------------------------------------------------


def panels(ui: Ui) -> Screens:
    """Problems, log, history."""
    ui.show_panel("Problems")
    yield "problems_none"
    ui.session.apply(Disconnect(Port("bloom", "image")))
    ui.editor.faults["Nowhere"] = "Traceback (most recent call last):\n  the details"
    ui.wait(4)
    yield "problems"
    ui.editor.faults.clear()
    ui.show_panel("Graph")
    yield "problems_on_the_canvas"
    ui.session.undo()
    ui.show_panel("History")
    yield "history"
    ui.editor.log.add("opened many_things.json")
    ui.editor.log.add("the picture beauty.exr has changed on disk and was read again", "warning")
    ui.editor.log.add("'grade.out' (Image) cannot go into 'vignette.amount' (Number)", "error", "the\ndetails")
    ui.show_panel("Log")
    yield "log"
    ui.editor.log.entries.clear()
    ui.show_panel("Graph")


# --- over everything -------------------------------------------------------------------------------------------------


def files(ui: Ui) -> Screens:
    """The file browser as pictures and as a list, opening and saving."""
    purposes: tuple[tuple[Purpose, bool], ...] = (("image", False), ("graph", False), ("export", True))
    for purpose, saving in purposes:
        ui.editor.store.note_folder(purpose, (SAMPLES if purpose == "image" else SAMPLES.parent) / "x")
        ui.editor.dialogs.browse = Browse(f"Choose: {purpose}", purpose, lambda path: None, saving, "halation.png")
        ui.wait(12)
        yield f"files_{purpose}"
        if purpose == "image":
            ui.click("list or grid")
            ui.wait(3)
            yield "files_list"
            ui.click("list or grid")
        ui.editor.dialogs.browse = None
        ui.wait(2)


def dialogs(ui: Ui) -> Screens:
    """Everything that lies on top."""
    for name in ("shortcuts", "about", "palette", "preferences"):
        ui.editor.dialogs.open.add(name)
        ui.wait(4)
        yield name
        if name == "palette":
            ui.type("light", enter=False)
            yield "palette_typed"
        if name == "preferences":
            ui.click("page System")
            yield "preferences_system"
            ui.click("page Shortcuts")
            yield "preferences_shortcuts"
            ui.click("shortcut file.new")
            ui.keys("Ctrl+O")
            yield "preferences_conflict"
        ui.editor.dialogs.open.clear()
        ui.wait(2)
    ui.editor.dialogs.matches = True
    ui.wait(4)
    yield "match"
    ui.editor.dialogs.matches = False
    ui.editor.dialogs.question = Question(
        "Save the changes?",
        "'many_things' was changed since it was saved.",
        (("Save", lambda: None), ("Do not save", lambda: None), ("Cancel", lambda: None)),
    )
    ui.wait(3)
    yield "question"
    ui.editor.dialogs.question = None
    ui.editor.log.add("saved many_things.json")
    ui.editor.log.add("the graphics card is short of memory: results are kept for less long", "warning")
    ui.editor.log.add("cannot connect 'noise.out' to 'vignette.amount': an Image is no Number", "error")
    ui.wait(4)
    yield "toasts"
    ui.editor.log.entries.clear()


def canvas(ui: Ui) -> Screens:
    """What the graph opens: search, context menus, the menu bar."""
    ui.move("Graph")
    ui.wait(2)
    ui.keys("Tab")
    ui.type("bl", enter=False)
    yield "search"
    ui.keys("Escape")
    ui.keys("Escape")
    ui.click("title bloom", button=1)
    yield "node_menu"
    ui.keys("Escape")
    ui.ctx.menu_click("//##MainMenuBar/Viewer")
    ui.wait(3)
    yield "menu"
    ui.keys("Escape")
    ui.keys("Escape")


def start(ui: Ui) -> Screens:
    """The start screen at the first start, and later with files and unsaved work."""
    ui.session.files.new()
    ui.wait(3)
    yield "empty"
    for title in ("Scopes", "History", "Renders"):
        ui.show_panel(title)
        yield f"empty_{title.lower()}"
    ui.editor.log.entries.clear()
    ui.show_panel("Log")
    yield "empty_log"
    ui.show_panel("Graph")
    _open_start(ui.editor)
    ui.wait(6)
    yield "start_first"
    ui.editor.dialogs.open.clear()
    ui.wait(2)
    lost = RecoveryFile(ui.editor.store.file.parent, 0.05)
    lost.note(Graph().add("noise", catalogue()["noise"]()), Path("/pictures/lost_look.json"), True)
    lost.close(keep=True)
    for path in (*presets.paths()[:4], Path("/pictures/a/long/way/down/gone_with_the_wind.json")):
        ui.editor.store.note_opened(path)
    _open_start(ui.editor)
    ui.wait(6)
    yield "start_later"
    ui.editor.dialogs.open.clear()
    ui.wait(2)


def _open_start(editor: Editor) -> None:
    editor.dialogs.open.add("start")


SCREENS: tuple[Callable[[Ui], Screens], ...] = (
    window,
    inspector,
    fields,
    viewer,
    scopes,
    panels,
    animation,
    renders,
    exporting,
    files,
    dialogs,
    lessons,
    canvas,
    start,
)
