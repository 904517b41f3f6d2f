"""Where the ruler, the current frame, the bar and the keys of the Curves panel, and the timeline are drawn."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Callable
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_shapes import DrawnShapes
from halation.editor.curves import frame as frames
from halation.editor.curves import paint, plot
from halation.editor.curves.paint import find_grips, paint_key
from halation.editor.theme.palette import PALETTES
from halation.editor.theme.style import u32
from halation.editor.timeline import ruler
from halation.editor.toolkit.plane import Plane, View
from halation.graph import Port

FIRST, LAST, NOW = 10, 90, 50
KEYS, CACHED, MISSING = (20, 50), (30, 31, 32, 60), [(70, 72)]
PORT = Port("gain", "gain")


class Panel:
    """A panel of 1000x400 at (40, 80) that shows the frames from 0 to 100: ten pixels each. Letters are 6.5 wide."""

    def __init__(
        self, monkeypatch: pytest.MonkeyPatch, scale: float = 1.0, shift: tuple[float, float] = (0, 0)
    ) -> None:
        def place(*at: float) -> Any:
            return tuple(part * scale + shift[axis % 2] for axis, part in enumerate(at))

        self.shapes, self.scale = DrawnShapes(13.0 * scale), scale
        imgui = SimpleNamespace(
            get_window_draw_list=lambda: self.shapes,
            calc_text_size=self.shapes.measure,
            get_font=lambda: None,
            get_font_size=lambda: self.shapes.em,
            get_style=lambda: SimpleNamespace(frame_rounding=4.0 * scale),
            get_time=lambda: 1.0,
        )
        for module in (paint, plot, frames, ruler):
            monkeypatch.setattr(module, "imgui", imgui)
        monkeypatch.setattr(ruler, "ui_scale", lambda: scale)

        @contextmanager
        def font(context: Any, name: str, size: float):
            before, self.shapes.em = self.shapes.em, size * scale
            yield
            self.shapes.em = before

        monkeypatch.setattr(ruler, "font", font)
        time = SimpleNamespace(frame=NOW, frames=(FIRST, LAST), list_key_frames=lambda: KEYS)
        session = SimpleNamespace(time=time, root=SimpleNamespace(settings=SimpleNamespace(rate=20.0)))
        timeline = SimpleNamespace(span=lambda session: (25, 75), part=(25, 75))
        self.context: Any = SimpleNamespace(
            places={}, palette=PALETTES["dark"], session=session, fonts=None, timeline=timeline,
            preview=SimpleNamespace(frames=CACHED),
        )  # fmt: skip
        self.plane = Plane(View(0.0, 100.0, -1.0, 3.0), place(40.0, 80.0, 1040.0, 480.0))
        self.frame: Any = SimpleNamespace(
            context=self.context, plane=self.plane, scale=scale, ruler=place(40.0, 20.0, 1040.0, 60.0),
            bar=place(40.0, 60.0, 1040.0, 80.0), state=SimpleNamespace(spots={(PORT, 20.0, 0), (PORT, 60.0, 0)}),
            tips=(SimpleNamespace(root=place(100.0, 100.0), x=place(130.0)[0], y=place(0.0, 140.0)[1]),),
        )  # fmt: skip

    @property
    def lines(self) -> list[tuple[float, float, float, float]]:
        """The lines, each as x, y of its ends."""
        return [(*shape.points[0], *shape.points[1]) for shape in self.shapes.list_kinds("line")]

    @property
    def texts(self) -> dict[str, tuple[float, float]]:
        """Where each text begins."""
        return {shape.text: shape.points[0] for shape in self.shapes.list_kinds("text")}


def paint_timeline(panel: Panel) -> None:
    missing: Any = SimpleNamespace(update=lambda session, now: MISSING)
    ruler.Ruler(panel.context, missing)._paint(panel.plane)  # pyright: ignore


def paint_values(panel: Panel) -> None:
    curves = plot.Plot()
    curves.paint_grid(panel.frame)
    curves.paint_labels(panel.frame)
    curves._paint_tips(panel.frame)  # pyright: ignore


DRAWINGS: tuple[Callable[[Panel], None], ...] = (
    lambda panel: paint.paint_background(panel.frame),
    lambda panel: paint.paint_ruler(panel.frame),
    lambda panel: paint.paint_current_frame(panel.frame, False),
    lambda panel: paint.paint_bar(panel.frame, "left"),
    paint_timeline,
    paint_values,
)


@pytest.mark.parametrize("draw", DRAWINGS)
@pytest.mark.parametrize(("scale", "shift"), [(1.0, (36.0, -20.0)), (2.0, (0.0, 0.0))])
def test_what_is_drawn_moves_with_its_panel_and_grows_with_the_interface(monkeypatch, draw, scale, shift) -> None:
    """But for rounding to whole pixels, and lines that stay thin: less than two pixels."""
    changed = Panel(monkeypatch, scale, shift)
    draw(changed)
    panel = Panel(monkeypatch)
    draw(panel)
    ours, theirs = [shape.change(scale, shift) for shape in panel.shapes.shapes], changed.shapes.shapes
    assert [(shape.kind, shape.color, shape.text) for shape in ours] == [
        (shape.kind, shape.color, shape.text) for shape in theirs
    ]
    slack = 0.0 if scale == 1.0 else 1.6
    for mine, other in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(mine.points, other.points, atol=slack + 1e-6)
        assert mine.lengths == pytest.approx(other.lengths) or mine.kind == "line"


def test_frames_of_the_graph_are_lighter_than_those_outside(monkeypatch) -> None:
    panel = Panel(monkeypatch)
    paint.paint_background(panel.frame)
    whole, before, after = panel.shapes.list_kinds("filled rect")
    assert whole.points == ((40.0, 80.0), (1040.0, 480.0))
    assert before.points == ((40.0, 80.0), (140.0, 480.0)) and after.points == ((940.0, 80.0), (1040.0, 480.0))
    assert before.color == after.color == u32(panel.context.palette.shadow, 0.26)
    assert panel.lines == [(40.5 + 20.0 * at, 80.0, 40.5 + 20.0 * at, 480.0) for at in range(51)]
    assert len({shape.color for shape in panel.shapes.list_kinds("line")[::5]}) == 1  # every tenth frame
    assert len({shape.color for shape in panel.shapes.list_kinds("line")}) == 2


def test_the_ruler_has_frames_above_and_seconds_below(monkeypatch) -> None:
    """Twenty frames a second, and the first frame is the second 0."""
    panel = Panel(monkeypatch)
    paint.paint_ruler(panel.frame)
    texts = panel.texts
    assert {text: at[0] for text, at in texts.items() if text.isdigit()} == {
        str(at): round(44.5 + 10.0 * at) for at in range(0, 101, 10)
    }
    seconds = {float(text.removesuffix(" s")): at[0] for text, at in texts.items() if text.endswith(" s")}
    assert seconds and all(x == round(44.5 + 10.0 * (10 + 20.0 * at)) for at, x in seconds.items())
    upper, lower = ({at[1] for text, at in texts.items() if text.endswith(" s") is kind} for kind in (False, True))
    assert len(upper) == len(lower) == 1 and 20.0 < upper.pop() + 13.0 <= lower.pop() + 2.0 < 60.0 - 8.0
    lengths = {y1 - y0 for _, y0, _, y1 in panel.lines}
    assert lengths == {3.0, 6.0} and {y0 for _, y0, _, _ in panel.lines} == {20.0}
    inside = panel.shapes.list_kinds("filled rect")[1:]
    assert [shape.points for shape in inside] == [((140.0, 20.0), (940.0, 60.0)), ((140.0, 58.0), (940.0, 60.0))]


def test_the_current_frame_is_a_line_below_its_number(monkeypatch) -> None:
    panel = Panel(monkeypatch)
    paint.paint_current_frame(panel.frame, True)
    assert panel.lines == [(540.5, 20.0, 540.5, 480.0)]
    (box,), ((x, y),) = panel.shapes.list_kinds("filled rect"), panel.texts.values()
    (left, top), (right, bottom) = box.points
    wide = panel.shapes.list_kinds("text")[0].lengths[0]
    assert (left + right) / 2 == 540.5 and (top, bottom) == (21.0, pytest.approx(42.4))
    assert left < x < x + wide < right + 1.0 and top < y < y + wide < bottom + 1.0
    left, top, right, bottom = panel.context.places["keys now"]
    assert (left + right) / 2 == 540.5 and (top, bottom) == (20.0, 42.0)


@pytest.mark.parametrize(("now", "is_drawn"), [(-1, True), (-3, False), (101, True), (103, False)])
def test_a_current_frame_outside_is_not_drawn(monkeypatch, now: int, is_drawn: bool) -> None:
    """Its number is 13 pixels wide, and its box 23 or a little more."""
    panel = Panel(monkeypatch)
    panel.context.session.time.frame = now
    paint.paint_current_frame(panel.frame, False)
    assert bool(panel.shapes.shapes) is is_drawn and "keys now" in panel.context.places


def test_the_bar_spans_the_selected_keys_between_its_grips(monkeypatch) -> None:
    panel = Panel(monkeypatch)
    assert find_grips(panel.frame) == (240.0 - 13.0, 640.0 + 13.0, 8.0)
    paint.paint_bar(panel.frame, "left")
    _, body, left, right = panel.shapes.list_kinds("filled rect")
    assert body.points == ((227.0, 62.0), (653.0, 78.0))
    assert left.points == ((227.0, 62.0), (235.0, 78.0)) and right.points == ((645.0, 62.0), (653.0, 78.0))
    assert left.color != right.color == u32(panel.context.palette.accent)
    assert panel.context.places == {
        "keys left end": (227.0, 60.0, 235.0, 80.0), "keys right end": (645.0, 60.0, 653.0, 80.0),
    }  # fmt: skip
    panel.frame.state.spots = {(PORT, 20.0, 0), (PORT, 20.0, 1)}
    assert find_grips(panel.frame) is None  # one frame cannot be scaled
    panel.frame.state.spots = set()
    assert find_grips(panel.frame) is None


@pytest.mark.parametrize("look", ["linear", "smooth", "constant", "bezier", None])
def test_a_key_lies_around_its_place_as_large_as_others(look: Any) -> None:
    shapes: Any = DrawnShapes()
    paint_key(shapes, 50.0, 70.0, 10.0, look, 7)
    ends = [
        (x + way * length, y + up * length)
        for shape in shapes.shapes
        for x, y in shape.points
        for length in (shape.lengths[0] if shape.kind in ("disk", "ngon") else 0.0,)
        for way, up in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    for axis, middle in ((0, 50.0), (1, 70.0)):
        low, high = min(at[axis] for at in ends), max(at[axis] for at in ends)
        assert low + high == pytest.approx(2.0 * middle) and 8.0 <= (high - low) / 2 <= 12.0
    kind = {"smooth": "disk", "constant": "filled rect", "bezier": "triangle"}.get(look, "ngon")
    assert {shape.kind for shape in shapes.shapes} == {kind} and {shape.color for shape in shapes.shapes} == {7}


def test_a_selection_box_is_drawn_from_any_corner(monkeypatch) -> None:
    for box in ((10.0, 20.0, 60.0, 90.0), (60.0, 90.0, 10.0, 20.0), (60.0, 20.0, 10.0, 90.0)):
        panel = Panel(monkeypatch)
        paint.paint_box(panel.frame, box)
        assert {shape.points for shape in panel.shapes.shapes} == {((10.0, 20.0), (60.0, 90.0))}


def test_lines_of_values_lie_at_their_values_and_their_numbers_beside_them(monkeypatch) -> None:
    """A unit is 100 pixels high, and -1 is at the bottom."""
    panel = Panel(monkeypatch)
    paint_values(panel)
    levels = [y for x0, y, x1, end in panel.lines if (x0, x1) == (40.0, 1040.0) and y == end]
    assert levels == [480.5 - 10.0 * at for at in range(41)]
    (zero,) = {shape.color for shape in panel.shapes.list_kinds("line") if shape.points[0][1] == 380.5}
    assert [shape.points[0][1] for shape in panel.shapes.list_kinds("line") if shape.color == zero] == [380.5]
    texts = panel.texts
    assert [*texts] == ["-0.5", "0.0", "0.5", "1.0", "1.5", "2.0", "2.5"]  # -1 and 3 would be cut off
    for text, (x, y) in texts.items():
        level = 380.5 - 100.0 * float(text)
        assert x == 46.0 and abs(y + panel.shapes.list_kinds("text")[0].lengths[0] / 2 - level) <= 1.0
    for shape in panel.shapes.list_kinds("filled rect"):
        (left, top), (right, bottom) = shape.points
        assert left == 42.0 and bottom - top == 16.0 and right > 46.0 + 3 * 5.0
    root, end = panel.shapes.list_kinds("line")[-1].points
    assert (root, end) == ((100.0, 100.0), (130.0, 140.0))
    assert [(shape.points[0], shape.lengths[0]) for shape in panel.shapes.list_kinds("disk")] == [
        ((130.0, 140.0), 3.5), ((130.0, 140.0), 1.9),
    ]  # fmt: skip


def test_the_timeline_shows_what_is_ready_and_missing_and_what_is_played(monkeypatch) -> None:
    """A frame is ten pixels wide, half of them before its place."""
    panel = Panel(monkeypatch)
    paint_timeline(panel)
    palette, rects = panel.context.palette, panel.shapes.list_kinds("filled rect")
    spans = {shape.points for shape in rects if shape.color == u32(palette.good, 0.95)}
    assert spans == {((335.0, 477.0), (365.0, 480.0)), ((635.0, 477.0), (645.0, 480.0))}
    assert {shape.points for shape in rects if shape.color == u32(palette.error, 0.95)} == {
        ((735.0, 477.0), (765.0, 480.0))
    }
    assert rects[0].points == ((40.0, 80.0), (1040.0, 480.0)) and rects[1].points == ((135.0, 80.0), (945.0, 480.0))
    assert [shape.points for shape in rects[2:5]] == [
        ((135.0, 80.0), (285.0, 480.0)), ((795.0, 80.0), (945.0, 480.0)), ((285.0, 80.0), (795.0, 82.0)),
    ]  # fmt: skip
    handles = panel.shapes.list_kinds("triangle")
    assert [shape.points[0] for shape in handles] == [(285.0, 80.0), (795.0, 80.0)]
    assert handles[0].points[1][0] > 285.0 and handles[1].points[1][0] < 795.0 and handles[0].points[2][1] > 80.0
    assert panel.context.places["ruler in"] == (282.0, 80.0, 288.0, 87.0)
    keys = panel.shapes.list_kinds("ngon")
    assert [shape.points[0] for shape in keys] == [(240.0, 472.0)] * 2 + [(540.0, 472.0)] * 2
    assert keys[3].color == u32(palette.accent) != keys[1].color and keys[0].lengths > keys[1].lengths
    (middle,) = {x0 for x0, _, _, y1 in panel.lines if y1 == 480.0}
    assert middle == 540.5


def test_the_number_of_the_current_frame_stays_inside(monkeypatch) -> None:
    for now, side in ((0, 40.0), (100, 1040.0)):
        panel = Panel(monkeypatch)
        panel.context.session.time.frame = now
        paint_timeline(panel)
        left, _, right, _ = panel.context.places["ruler now"]
        assert (left if now == 0 else right) == pytest.approx(side)
        x, _ = panel.shapes.list_kinds("text")[-1].points[0]
        assert x == round(left + 5.0) and right - left > 10.0


@pytest.mark.parametrize(("x", "y", "handle"), [(285, 90, "in"), (291, 90, "in"), (293, 90, ""), (800, 255, "out"),
                                                (795, 265, ""), (540, 90, "")])  # fmt: skip
def test_handles_are_grabbed_in_the_upper_part(monkeypatch, x: float, y: float, handle: str) -> None:
    panel = Panel(monkeypatch)
    assert ruler._handle(panel.context, panel.plane, x, y) == handle  # pyright: ignore


def test_runs_join_frames_that_follow_each_other() -> None:
    assert ruler.list_runs(()) == [] and ruler.list_runs((4,)) == [(4, 4)]
    assert ruler.list_runs((1, 2, 3, 5, 7, 8)) == [(1, 3), (5, 5), (7, 8)]


def test_frames_of_the_ruler_have_lines_and_numbers(monkeypatch) -> None:
    panel = Panel(monkeypatch)
    paint_timeline(panel)
    numbers = {text: x for text, (x, _) in panel.texts.items()}
    for text, x in numbers.items():
        if text != str(NOW):
            assert (
                abs(x + len(text) * panel.shapes.list_kinds("text")[0].lengths[0] / 4 - 40.5 - 10.0 * int(text)) <= 0.6
            )
    assert {*numbers} == {str(at) for at in range(0, 101, 10)}
    below = {(y0, y1) for _, y0, _, y1 in panel.lines if y1 != 480.0}
    assert below == {(468.0, 476.0), (471.0, 476.0)}
    assert math.isclose(len([1 for _, y0, _, _ in panel.lines if y0 == 468.0]), 11)


def measure_light(color: tuple[float, float, float]) -> float:
    """The relative luminance of a color, as WCAG 2 defines it."""
    light = [part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in color]
    return 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2]


@pytest.mark.parametrize("name", PALETTES)
def test_curves_of_channels_have_the_color_of_their_channel(name: str) -> None:
    """Their hues are near those of red, green and blue, as light as WCAG 2.1 (1.4.11) wants lines; alpha is gray."""
    context: Any = SimpleNamespace(palette=(palette := PALETTES[name]))
    channels: Any = SimpleNamespace(channels=4)
    for channel, hue in enumerate((0.0, 1.0 / 3.0, 0.62)):
        color = frames.color_of(context, channels, channel, 0)
        assert all(0.0 <= part <= 1.0 for part in color)
        found, _, saturation = colorsys.rgb_to_hls(*color)
        assert abs((found - hue + 0.5) % 1.0 - 0.5) < 0.03 and saturation > 0.3
        bright, dark = sorted((measure_light(color), measure_light(palette.panel)), reverse=True)
        assert (bright + 0.05) / (dark + 0.05) >= 3.0
    assert max(gray := frames.color_of(context, channels, 3, 0)) - min(gray) < 0.05
    numbers: Any = SimpleNamespace(channels=0)
    shown = [frames.color_of(context, numbers, 0, place) for place in range(6)]
    assert len({*shown[:5]}) == 5 and shown[5] == shown[0]
