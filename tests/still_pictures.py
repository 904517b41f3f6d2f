"""Screens of a still editor that need pictures, files or clicks: each function yields a screen's name and its panel."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from drawn_shapes import Point
from gui_renders import make_render
from halation.authoring.commands import AddNode, AnimateValues, MovePoints, ReplaceGraph, SetFrameRange
from halation.authoring.flipbook import FlipbookStrip
from halation.authoring.preview.pass_pictures import PassPicture
from halation.editor.canvas.view import Tool
from halation.editor.tutorials.course import COURSE
from halation.export.surface_picture import SurfacePicture
from halation.graph import Expression, Graph, Input, Key, Keys, Output, Port
from halation.nodes import (
    Kind,
    Light,
    LightKind,
    Node,
    RotoShape,
    Value,
    catalogue,
    join_points,
    name_roto_shapes,
    number_lights,
    split_points,
)
from halation.nodes.input.read_image import ReadImage
from imgui_bundle import imgui
from msgspec.structs import replace
from still_editor import StillEditor, name_kind
from still_screens import Screens, describe_kind

RENDER = Path(__file__).parent / "data/blender45_multilayer.exr"
"""A render of Blender with many layers, a camera and a cryptomatte with names."""

HANDLED = (
    "bilateral_blur", "directional_blur", "radial_blur", "chromatic_aberration", "corner_pin", "crop", "kaleidoscope",
    "lens_distortion", "spline_warp", "transform", "paint", "ramp", "roto", "text", "depth_of_field",
    "deferred_lighting", "feedback", "ripple",
)  # fmt: skip
"""Nodes that are changed in the picture, of every kind of handle."""

_ANY_POPUP = int(imgui.PopupFlags_.any_popup)


def make_graph(id: str) -> Graph:
    """A node, and noise or its luminance in all of its inputs that take that."""
    graph = Graph().add("node", catalogue()[id]())
    for name in ("noise", "luminance"):
        graph = graph.add(name, catalogue()[name]())
    graph = graph.connect(Port("noise", "out"), Port("luminance", "image"))
    sources = {Kind.IMAGE: Port("noise", "out"), Kind.FIELD: Port("luminance", "out")}
    for name, socket in catalogue()[id].inputs.items():
        if source := sources.get(socket.kind):
            graph = graph.connect(source, Port("node", name))
    return graph


def find_value(graph: Graph, words: str) -> Value | None:
    """The declaration of the value that a place is named after."""
    node, _, name = words.partition(".")
    item = graph.nodes.get(node)
    return item.values.get(name) if isinstance(item, Node) else None


def show_handles(still: StillEditor) -> Screens:
    """What lies on the picture while a node is selected."""
    session = still.editor.session
    for id in HANDLED:
        session.apply(ReplaceGraph("Start", make_graph(id)))
        still.select("node")
        session.views.show(Port("node", next(iter(catalogue()[id].outputs))))
        still.show("Viewer", 2)
        still.compute()
        yield id, "Viewer"
    points, box = Port("node", "shapes.box.points"), join_points(((0.3, 0.3), (0.7, 0.3), (0.7, 0.7), (0.3, 0.7)))
    shapes = name_roto_shapes(box=RotoShape(points=box))
    graph = Graph().add("node", catalogue()["roto"]()).set(Port("node", "shapes"), shapes)
    session.apply(ReplaceGraph("Start", graph.animate(points, Keys((Key(1, box), Key(9, box))))))
    still.select("node")
    session.views.show(Port("node", next(iter(catalogue()["roto"].outputs))))
    session.time.seek(5)
    moved = [*split_points(box)]
    moved[2] = (0.8, 0.8, *moved[2][2:])
    session.apply(MovePoints(points, tuple(moved), "Move", singly=True))
    for frame in (5, 3):
        session.time.seek(frame)
        still.show("Viewer", 2)
        still.compute()
        yield f"keyed point at {frame}", "Viewer"


def show_lamps(still: StillEditor) -> Screens:
    """Lights of each kind that a camera sees, each of them selected once, and the dome of suns."""
    session, lights = still.editor.session, Port("node", "lights")
    kinds = (*LightKind, LightKind.SPOT, LightKind.SUN)
    lamps = [
        Light(kind, (0.3 * number - 1.2, 0.0, 1.0), (0.3, 0.4, -1.0), intensity=(-1.0 if number == 2 else 1.0))
        for number, kind in enumerate(kinds)
    ]
    graph = make_graph("deferred_lighting").add("camera", catalogue()["camera"]())
    graph = graph.connect(Port("camera", "camera"), Port("node", "camera")).set(lights, number_lights(lamps))
    session.apply(ReplaceGraph("Start", graph))
    still.select("node")
    session.views.show(Port("node", "out"))
    still.show("Viewer", 2)
    still.compute()
    names = ["", *number_lights(lamps)]
    for name in names:
        still.editor.items[str(lights)] = name
        yield f"lamp {name}", "Viewer"
        starts = ("goal", "handle", "size") if name == names[-1] else ("size",)
        for place in [place for place in sorted(still.places) if place.startswith(starts)]:
            still.pane.point(still.find_point(place))
            yield f"over {place}", "Viewer"


def show_viewer(still: StillEditor) -> Screens:
    """Channels, comparing, the table, and what lies over the picture."""
    session, viewer = still.editor.session, still.editor.viewer
    session.views.show(Port("outputs", "image"))
    still.show("Viewer", 2)
    still.compute()
    for channels in ("color", "red", "alpha", "luminance", "false color"):
        viewer.channels = channels
        yield channels, "Viewer"
    viewer.channels = "color"
    session.views.show(Port("grade", "out"), "B")
    for mode in ("wipe", "difference", "toggle", "beside"):
        viewer.compare = mode  # pyright: ignore[reportAttributeAccessIssue]
        still.show("Viewer", 2)
        still.compute()
        yield mode, "Viewer"
    viewer.compare, viewer.exposure, viewer.warn_clipping = "off", 2.0, True
    yield "changed", "Viewer"
    viewer.exposure, viewer.warn_clipping, viewer.table = 0.0, False, True
    viewer.region, viewer.measured = (0.2, 0.2, 0.6, 0.7), (0.3, 0.3, 0.5, 0.5)
    viewer.markers = ((0.25, 0.5), (0.75, 0.25))
    still.show("Viewer", 2)
    still.compute()
    yield "table", "Viewer"
    viewer.table, viewer.region, viewer.measured, viewer.markers = False, None, None, ()
    viewer.paused = True
    yield "paused", "Viewer"
    viewer.paused = False
    for scopes in (("histogram", "waveform", "parade", "vectorscope"), ("waveform",), ()):
        viewer.scopes = {*scopes}
        yield f"{len(scopes)} scopes", "Scopes"
    session.views.show(Port("outputs", "lights"))
    still.show("Viewer", 2)
    still.compute()
    yield "field", "Viewer"


def show_files(still: StillEditor) -> Screens:
    """Nodes that read a render, and inputs and outputs."""
    session = still.editor.session
    graph = Graph().add_input("beauty", Input(Kind.IMAGE, 4, file=str(RENDER), doc="The picture to work on"))
    graph = graph.add_input("shot", Input(Kind.IMAGE, 4, file="shot.####.exr"))
    graph = graph.add_input("amount", Input(Kind.NUMBER, 1, default=0.5)).add_output("image", Output(Kind.IMAGE, 4))
    for id, name in (("read", "read_render"), ("mattes", "cryptomatte"), ("several", "cryptomatte")):
        graph = graph.add(id, catalogue()[name]()).set(Port(id, "path"), str(RENDER))
    graph = graph.add("picture", ReadImage(path=str(RENDER)))
    graph = graph.set(Port("several", "pick"), "*").connect(Port("read", "color"), Port("outputs", "image"))
    session.apply(ReplaceGraph("Start", graph))
    for id in ("read", "mattes", "several", "picture", "inputs.beauty", "inputs.shot", "inputs.amount"):
        still.select(id)
        yield id, "Inspector"
    still.select("outputs.image")
    yield "output", "Inspector"
    still.select("mattes")
    still.show("Inspector")
    still.click("Inspector", next(place for place in still.places if place.startswith("name mattes.pick ")))
    yield "picked", "Inspector"
    still.select("read")
    still.show("Inspector")
    for fold in [place for place in still.places if place.startswith("more ")]:
        still.click("Inspector", fold)
    yield "folds", "Inspector"


def show_passes(still: StillEditor) -> Screens:
    """Passes with short and long texts; one is marked."""
    codes = np.zeros((90, 160, 3), np.uint8)
    made = (
        PassPicture(0, ("plate",), (), (), "1920 x 1080, 4 channels", SurfacePicture(codes, None)),
        PassPicture(1, ("grade",), ("grade",), ("plate",), "1920 x 1080 rgba16f", SurfacePicture(codes, None)),
        PassPicture(
            2, ("bloom", "vignette", "a_very_long_name"), ("downsample", "vignette"), ("1", "plate"),
            "960 x 540 r11g11b10f", SurfacePicture(codes.transpose(1, 0, 2), (0.0, 4.0)),
        ),
    )  # fmt: skip
    passes = still.editor.passes
    passes.passes, passes.seconds, passes.marked = list(made), [0.001, 0.0025], "vignette"
    passes.revision += 1
    yield "passes", "Passes"
    passes.fault, passes.passes = "the graph cannot be rendered", []
    yield "no passes", "Passes"


def show_lessons(still: StillEditor) -> Screens:
    """The card of a tutorial, beside a widget and above one; one that is read only, and the last."""
    progress = still.contexts.tutorials.progress
    for lesson in (COURSE[0], COURSE[2]):
        progress.begin(lesson)
        tasks = [index for index, step in enumerate(lesson.steps) if step.solution]
        for index in sorted({0, 1, tasks[0], len(lesson.steps) - 1}):
            progress.go(index - progress.index)
            still.show("Tutorial", 1)
            step = lesson.steps[index]
            (left, top), scale = still.pane.at, still.editor.store.current.ui_scale
            for x, y in ((100.0, 270.0), (20.0, 700.0)):
                low, high = (left + x * scale, top + y * scale), (left + (x + 100.0) * scale, top + (y + 30.0) * scale)
                progress.widgets = {step.widget: (*low, *high)}
                yield f"{lesson.id} {index} {y:.0f}", "Tutorial"
        progress.begin(None)


def show_opened_fields(still: StillEditor) -> Screens:
    """Menus, lists and pickers of fields that a click opens."""
    yield from _open(still, [("Inspector", name) for name in ("bloom", "grade", "tone_map", "", "inputs.amount")])


def show_opened_panels(still: StillEditor) -> Screens:
    """Menus and lists of other panels that a click opens, one of every kind, and of a viewer with room for all."""
    titles = "Viewer", "Graph", "Animation", "Timeline", "Scopes", "Log", "Code"
    yield from _open(still, [(title, "bloom") for title in titles])
    still.pane.size = 3.0 * still.pane.size[0], still.pane.size[1]
    yield from _open(still, [("Viewer", "luminance")], "lights")


def _open(still: StillEditor, places: Sequence[tuple[str, str]], shown: str = "image") -> Screens:
    session = still.editor.session
    session.apply(SetFrameRange(1, 48))
    intensity, knee = Port("bloom", "intensity"), Port("bloom", "knee")
    moves = {intensity: Keys((Key(1, 0.2), Key(12, 0.9))), knee: Expression("0.5 + 0.1 * sin(time)")}
    session.apply(AnimateValues(moves, "Animate"))
    session.views.show(Port("outputs", shown))
    still.show("Viewer", 2)
    still.compute()
    for title, name in places:
        still.select(*filter(None, (name,)))
        still.show(title)
        seen = set[object]()
        for place in sorted(still.places):
            kind: object = name_kind(place)
            if kind == "field" and (value := find_value(session.graph, place.removeprefix("field "))):
                kind = describe_kind(value)
            if kind in seen:
                continue
            seen.add(kind)
            acts = ((0, 0.5), (0, 0.03), (1, 0.5))
            for button, part in acts[2:] if (title, name) == ("Inspector", "bloom") else acts:
                before = session.root
                if place in still.places:
                    still.click(title, place, button, (part, 0.5))
                    if imgui.is_popup_open("", _ANY_POPUP) or imgui.get_io().want_text_input:
                        yield f"{title} {name} {place} {button} {part}", title
                still.calm(title)
                while session.root is not before and session.history.steps:
                    session.undo()
                still.select(*filter(None, (name,)))
                still.show(title, 2)


def show_gestures(still: StillEditor) -> Screens:
    """The canvas while the mouse is held: a band around nodes, lines through links, and links that are pulled."""
    canvas, io, pane = still.editor.canvas, imgui.get_io(), still.pane
    pane.size = 3.0 * pane.size[0], pane.size[1]
    canvas.fit()
    still.show("Graph", 4)
    canvas.zoom = 0.5
    still.show("Graph", 4)
    near, far = ((pane.at[0] + x * pane.size[0], pane.at[1] + y * pane.size[1]) for x, y in ((0.2, 0.3), (0.8, 0.7)))
    output, fit, loop = map(still.find_point, ("pin out bloom.glow", "pin in tone_map.image", "pin in grade.image"))
    steps: tuple[tuple[str, Tool, Point, Point], ...] = (
        ("band", "", near, far), ("cut", "cut", near, far), ("dots", "dot", far, near), ("pulled", "", output, far),
        ("fits", "", output, fit), ("refused", "", output, loop),
    )  # fmt: skip
    for name, tool, start, end in steps:
        canvas.tool = tool
        pane.point(start)
        yield f"Graph before {name}", "Graph"
        io.add_mouse_button_event(0, True)
        still.show("Graph", 1)
        pane.point(end)
        yield f"Graph {name}", "Graph"
        pane.press(imgui.Key.escape, still.find("Graph").draw)
        io.add_mouse_button_event(0, False)
        canvas.tool = ""
        still.calm("Graph")


def show_wide_panels(still: StillEditor) -> Screens:
    """Panels with room for all of their tools."""
    session, pane = still.editor.session, still.pane
    pane.size = 3.0 * pane.size[0], pane.size[1]
    session.apply(SetFrameRange(1, 48))
    session.apply(AnimateValues({Port("bloom", "intensity"): Keys((Key(1, 0.2), Key(12, 0.9)))}, "Animate"))
    session.views.show(Port("outputs", "image"))
    still.select("bloom")
    still.show("Viewer", 2)
    still.compute()
    for title in ("Animation", "Inspector", "Viewer", "Timeline", "Scopes", "Log", "Problems", "Renders", "Passes"):
        yield f"wide {title}", title
    still.select(session.apply(AddNode("glsl")))
    still.show("Code")
    still.click("Code", "button code help")
    yield "help for code", "Code"


def show_flipbooks(still: StillEditor) -> Screens:
    """Pictures that were rendered, played in the viewer: one strip, two, and two of one name, of which one is new."""
    folder, pane = Path(still.editor.session.graph.folder), still.pane
    pane.size = 3.0 * pane.size[0], pane.size[1]
    render = make_render(folder / "f.png", "running", 2, 5)
    strips = [FlipbookStrip(folder / "samples" / f"{name}.exr", (1, 1)) for name in ("studio", "neon", "neon")]
    for name, chosen in (
        ("one", strips[:1]), ("two", strips[:2]), ("alike", [strips[1], replace(strips[2], export=render)]),
    ):  # fmt: skip
        still.contexts.flipbooks.open(*chosen)
        still.show("Viewer", 2)
        still.compute()
        for title in ("Viewer", "Timeline"):
            yield f"flipbook {name} {title}", title
        still.contexts.flipbooks.close()


def show_search(still: StillEditor) -> Screens:
    """The search for nodes in the graph: all, and some."""
    still.show("Graph")
    still.pane.point(still.find_point("Graph", (0.1, 0.2)) if "Graph" in still.places else still.pane.at)
    still.show("Graph", 1)
    still.editor.canvas.searching = True
    yield "Graph search", "Graph"
    for words in ("blur", "xyz"):
        imgui.get_io().add_input_characters_utf8(words)
        yield f"Graph search {words}", "Graph"
    still.calm("Graph")


def show_status(still: StillEditor) -> Screens:
    """The line at the bottom of the window: hints, messages of each kind, and what the figures may say."""
    editor, preview = still.editor, still.editor.preview
    still.pane.size = 3.0 * still.pane.size[0], still.pane.size[1]
    for place in ("Status", "Viewer", "Graph"):
        still.show(place)
        still.pane.point(still.find_point(place) if place in still.places else still.pane.at)
        yield f"over {place}", "Status"
    preview.paused = True
    yield "paused", "Status"
    preview.paused = False
    for level in ("info", "warning", "error"):
        editor.log.add(f"a message that is an {level}, " + "and is longer than the line has room for, " * 5, level)
        yield level, "Status"
