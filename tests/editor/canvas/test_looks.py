"""What the canvas says of each node: where it is viewed, what it costs, its faults; and where it is on the minimap."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from drawn_shapes import DrawnShapes
from halation.authoring.edits.element_id import NO_ELEMENT, ElementId
from halation.editor.canvas import looks, minimap
from halation.editor.canvas.brush import make_canvas_colors
from halation.editor.canvas.gestures import LinkGesture
from halation.editor.canvas.minimap import Minimap
from halation.editor.theme.palette import PALETTES
from halation.graph import Port

INK = make_canvas_colors("dark")
PANEL = (100.0, 50.0, 1100.0, 650.0)


def make_context(**preview: Any) -> Any:
    """A graph in a group of another, with three nodes."""
    problems = {
        "glow": (
            SimpleNamespace(severity="warning", sentence="slow"),
            SimpleNamespace(severity="error", sentence="no"),
        ),
        "light": (SimpleNamespace(severity="warning", sentence="bright"),),
    }
    views = {"A": Port("glow", "out"), "B": Port("glow", "out")}
    facts = {"timed": True, "timings": {}, "faults": {}, "thumbnailing": False, "thumbnail": lambda key: None}
    session = SimpleNamespace(
        place=("group",), selection=frozenset({"glow"}), active="light", problems=problems,
        graph=SimpleNamespace(muted=frozenset({"key"})),
        views=SimpleNamespace(find_port=views.get, numbered_ports={1: Port("key", "out"), 3: Port("key", "matte")}),
    )  # fmt: skip
    return SimpleNamespace(session=session, preview=SimpleNamespace(**facts | preview))


def gather(context: Any, gesture: Any = None) -> looks.LookFacts:
    return looks.gather_look_facts(context, INK, gesture, ElementId("light"))


def test_a_look_tells_where_a_node_is_viewed_and_what_is_wrong() -> None:
    facts = gather(make_context())
    glow, light, key = (facts.make_look(ElementId(name), frozenset()) for name in ("glow", "light", "key"))
    assert (glow.viewed, light.viewed, key.badges) == ("AB", "", "1 3")
    assert (glow.fault, glow.warning) == ("no", "") and (light.fault, light.warning) == ("", "bright")
    assert (glow.selected, light.active, key.muted, light.hot) == (True, True, True, True)
    assert not (light.selected or glow.active or glow.muted or glow.hot)
    assert glow.lit is None and glow.picture is None and glow.picture_size == (1, 1)


def test_faults_of_a_render_are_added_once() -> None:
    facts = gather(make_context(faults={"group/light": "it is black", "group/glow": "no", "key": "of another graph"}))
    assert facts.faults(ElementId("light")) == ("it is black",)
    assert facts.faults(ElementId("glow")) == ("no",) and facts.faults(ElementId("key")) == ()
    assert facts.warnings(ElementId("light")) == ("bright",) and facts.warnings(ElementId("key")) == ()


@pytest.mark.parametrize(
    ("seconds", "color"), [(0.036, "error"), (0.034, "warning"), (0.013, "warning"), (0.012, "dim"), (0.0, "dim")]
)
def test_what_takes_a_large_part_of_the_time_is_red(seconds: float, color: str) -> None:
    """More than 35 of 100 milliseconds, or 12. Passes that nodes share count once in the whole."""
    timings = {
        "group/glow/blur": SimpleNamespace(seconds=seconds, bytes=3 << 20, shared=()),
        "group/light": SimpleNamespace(seconds=0.1 - seconds, bytes=512 << 10, shared=("group/key",)),
        "group/key": SimpleNamespace(seconds=0.1 - seconds, bytes=512 << 10, shared=("group/light",)),
    }
    facts = gather(make_context(timings=timings))
    assert facts.total == pytest.approx(0.1)
    glow, light = (facts.make_look(ElementId(name), frozenset()) for name in ("glow", "light"))
    assert glow.overlay == f"{seconds * 1e3:.1f} ms   3.0 MB" and glow.overlay_color == getattr(INK, color)
    assert light.overlay == f"{100.0 - seconds * 1e3:.1f} ms   512 KB"
    assert gather(make_context(timings=timings, timed=False)).make_look(ElementId("glow"), frozenset()).overlay == ""


def test_what_takes_no_time_is_not_marked() -> None:
    timings = {"group/glow": SimpleNamespace(seconds=0.0, bytes=1 << 20, shared=())}
    look = gather(make_context(timings=timings)).make_look(ElementId("glow"), frozenset())
    assert (look.overlay, look.overlay_color) == ("0.0 ms   1.0 MB", INK.dim)


def test_a_dragged_link_lights_what_it_fits() -> None:
    targets = (Port("light", "image"), Port("light", "mask"), Port("key", "image"))
    for output in (True, False):
        gesture = LinkGesture(Port("glow", "out"), output, targets=frozenset(targets))
        facts = gather(make_context(), gesture)
        assert facts.make_look(ElementId("light"), frozenset()).lit == {(not output, "image"), (not output, "mask")}
        assert facts.make_look(ElementId("glow"), frozenset()).lit == {(output, "out")}
        assert facts.make_look(ElementId("other"), frozenset()).lit == frozenset()


class Map:
    """A minimap of a scene, at a scale of the interface."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, scene: Any, visible: Any, mouse: Any = None, scale=1.0) -> None:
        names = ("set_cursor_screen_pos", "set_next_item_allow_overlap", "push_item_flag", "invisible_button")
        imgui = SimpleNamespace(
            **dict.fromkeys((*names, "pop_item_flag"), lambda *words: None), ItemFlags_=SimpleNamespace(no_nav=1),
            is_item_active=lambda: mouse is not None,
            get_mouse_pos=lambda: SimpleNamespace(x=mouse[0], y=mouse[1]),
        )  # fmt: skip
        monkeypatch.setattr(minimap, "imgui", imgui)
        monkeypatch.setattr(minimap, "ui_scale", lambda: scale)
        self.shapes, self.canvas = DrawnShapes(), SimpleNamespace(center=None)
        session = SimpleNamespace(selection=frozenset({next(iter(scene.boxes))}))
        self.context: Any = SimpleNamespace(places={}, palette=PALETTES["dark"], session=session, canvas=self.canvas)
        self.map = Minimap(self.context)
        brush: Any = SimpleNamespace(visible=visible, draw=self.shapes, ink=INK)
        self.map.draw(brush, PANEL, scene)


@pytest.mark.parametrize("scale", [1.0, 1.5])
def test_the_minimap_shows_all_elements_and_what_is_in_view(monkeypatch, scene, scale: float) -> None:
    """At the lower right, 12 pixels from the border; all is as far apart as on the canvas, but smaller."""
    left, top, right, bottom = scene.bounds
    visible = (left + 100.0, top - 50.0, right + 60.0, bottom - 40.0)
    drawn = Map(monkeypatch, scene, visible, scale=scale)
    box = (1100.0 - 180.0 * scale, 650.0 - 124.0 * scale, 1100.0 - 12.0 * scale, 650.0 - 12.0 * scale)
    ground = drawn.shapes.shapes[0].points
    assert drawn.context.places["minimap"] == (*ground[0], *ground[1]) == pytest.approx(box)
    boxes = [element for element in scene.boxes.values() if element.sort != "dot"]
    marks = drawn.shapes.list_kinds("filled rect")[1 : 1 + len(boxes)]
    view = drawn.shapes.list_kinds("rect")[0].points
    ratio = (view[1][0] - view[0][0]) / (visible[2] - visible[0])
    assert ratio == pytest.approx((view[1][1] - view[0][1]) / (visible[3] - visible[1]))
    for element, mark in zip(boxes, marks, strict=True):
        assert mark.points[0][0] - view[0][0] == pytest.approx((element.x - visible[0]) * ratio)
        assert mark.points[0][1] - view[0][1] == pytest.approx((element.y - visible[1]) * ratio)
        assert mark.points[1][0] - mark.points[0][0] == pytest.approx(max(element.w * ratio, 2.0))
        assert mark.points[1][1] - mark.points[0][1] == pytest.approx(max(element.h * ratio, 1.5))
    assert [mark.color == INK.accent for mark in marks] == [True] + [False] * (len(marks) - 1)
    corners = [at for shape in (*marks, drawn.shapes.list_kinds("rect")[0]) for at in shape.points]
    xs, ys = zip(*corners, strict=True)
    room = min(min(xs) - box[0], box[2] - max(xs)), min(min(ys) - box[1], box[3] - max(ys))
    assert min(room) == pytest.approx(6.0 * scale, abs=1.0) and max(room) >= 6.0 * scale - 1e-6
    assert min(xs) - box[0] == pytest.approx(box[2] - max(xs), abs=1.5)


def test_a_press_on_the_minimap_centers_the_view_there(monkeypatch, scene) -> None:
    left, top, right, bottom = scene.bounds
    visible = (left + 100.0, top, right, bottom)
    shown = Map(monkeypatch, scene, visible)
    element = next(element for element in scene.boxes.values() if element.sort == "node")
    order = [other for other in scene.boxes.values() if other.sort != "dot"].index(element)
    at = shown.shapes.list_kinds("filled rect")[1 + order].points[0]
    pressed = Map(monkeypatch, scene, visible, mouse=at)
    assert pressed.map.dragging and pressed.canvas.center == pytest.approx((element.x, element.y))


def test_the_minimap_is_there_while_something_is_out_of_view(monkeypatch, scene) -> None:
    left, top, right, bottom = scene.bounds
    for visible, is_needed in (
        ((left, top, right, bottom), False),
        ((left + 1.0, top, right, bottom), True),
        ((left, top + 1.0, right, bottom), True),
        ((left, top, right - 1.0, bottom), True),
        ((left, top, right, bottom - 1.0), True),
    ):
        drawn = Map(monkeypatch, scene, visible)
        assert drawn.map.is_needed is is_needed and bool(drawn.shapes.shapes) is is_needed
    needed = Minimap(drawn.context, is_needed=True)
    assert needed.find_rect((0.0, 0.0, 370.0, 247.0)) == (190.0, 123.0, 358.0, 235.0)
    assert needed.find_rect((0.0, 0.0, 369.0, 247.0)) is None and needed.find_rect((0.0, 0.0, 370.0, 246.0)) is None
    assert NO_ELEMENT not in scene.boxes
