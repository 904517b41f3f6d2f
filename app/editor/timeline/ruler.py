"""The ruler of the timeline: frames, keys, cached and missing frames, and its mouse input."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from imgui_bundle import imgui
from msgspec import Struct, field

from ...language.translation import translate
from ..theme.style import mix, u32, ui_scale
from ..toolkit.places import Rect
from ..toolkit.plane import Plane, View, ticks
from ..toolkit.words import SMALL, font, tip
from .gaps import MissingFrames

if TYPE_CHECKING:
    from .context import TimelineContext

Hold = Literal["", "now", "in", "out", "pan"]

NEAR = 7.0
"""Pixels from a handle within which the mouse grabs it."""

KEY = 4.2
_BUTTONS = (
    int(imgui.ButtonFlags_.mouse_button_left)
    | int(imgui.ButtonFlags_.mouse_button_right)
    | int(imgui.ButtonFlags_.mouse_button_middle)
)
LEFT, RIGHT, MIDDLE = imgui.MouseButton_.left, imgui.MouseButton_.right, imgui.MouseButton_.middle


class Ruler(Struct):
    """Draws the ruler; the mouse scrubs, sets the playback range, pans and zooms."""

    context: TimelineContext
    missing: MissingFrames = field(default_factory=MissingFrames)
    _hold: Hold = ""
    _played: bool = False

    def draw(self, rect: Rect) -> bool:
        """Draw into a rectangle; True if the user opens the menu."""
        session, timeline = self.context.session, self.context.timeline
        imgui.set_cursor_screen_pos(rect[:2])
        imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)
        imgui.invisible_button("##ruler", (rect[2] - rect[0], rect[3] - rect[1]), _BUTTONS)
        imgui.pop_item_flag()
        hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
        self.context.places["ruler"] = rect
        plane = _plane(self.context, rect)
        self._mouse(plane, hovered, active)
        plane = _plane(self.context, rect)
        timeline.hovered = hovered or active
        self._paint(plane)
        for frame in (session.time.frame, *session.time.frames):
            x = plane.x(frame)
            self.context.places[f"ruler {frame}"] = (x - 2.0, rect[1], x + 2.0, rect[3])
        if hovered and not active and self._hold == "":
            _tell(self.context, plane)
        return hovered and imgui.is_mouse_released(RIGHT)

    # --- the mouse ---------------------------------------------------------------------------------------------------

    def _mouse(self, plane: Plane, hovered: bool, active: bool) -> None:
        session, timeline, io = self.context.session, self.context.timeline, imgui.get_io()
        mouse = imgui.get_mouse_pos()
        near = _handle(self.context, plane, mouse.x, mouse.y) if hovered else ""
        if near in ("in", "out") or self._hold in ("in", "out"):
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        if imgui.is_item_activated():
            self._hold = "pan" if imgui.is_mouse_down(MIDDLE) else near or "now" if imgui.is_mouse_down(LEFT) else ""
            if self._hold == "now":
                timeline.stop()
        if hovered and io.mouse_wheel:
            timeline.zoom(session, plane.frame(mouse.x), 1.25**io.mouse_wheel)
        if hovered and imgui.is_mouse_double_clicked(MIDDLE):
            timeline.view = None
        if not active:
            self._hold = ""
        timeline.scrubbing = self._hold == "now"
        frame = math.floor(plane.frame(mouse.x) + 0.5)
        if self._hold == "now":
            self._edge(plane, mouse.x)
            session.time.seek(frame)
        elif self._hold == "pan":
            timeline.pan(session, -io.mouse_delta.x / plane.across)
        elif self._hold in ("in", "out"):
            low, high = timeline.span(session)
            low, high = (min(frame, high), high) if self._hold == "in" else (low, max(frame, low))
            timeline.set_part(session, low, high)

    def _edge(self, plane: Plane, x: float) -> None:
        """Scroll while the mouse is dragged beyond the border of a zoomed ruler."""
        left, _, right, _ = plane.rect
        if self.context.timeline.view is not None and not left <= x <= right:
            over = min(x - left, 0.0) + max(x - right, 0.0)
            self.context.timeline.pan(self.context.session, over / plane.across * 0.1)

    # --- what is drawn -----------------------------------------------------------------------------------------------

    def _paint(self, plane: Plane) -> None:
        draw, palette, scale = imgui.get_window_draw_list(), self.context.palette, ui_scale()
        left, top, right, bottom = plane.rect
        session, rounding = self.context.session, imgui.get_style().frame_rounding
        low, high = self.context.timeline.span(session)
        draw.add_rect_filled((left, top), (right, bottom), u32(mix(palette.window, palette.field, 0.35)), rounding)
        draw.push_clip_rect((left, top), (right, bottom), True)
        first, last = session.time.frames
        whole = plane.x(first - 0.5), plane.x(last + 0.5)
        draw.add_rect_filled((whole[0], top), (whole[1], bottom), u32(palette.field), rounding)
        if (low, high) != (first, last):
            inside = plane.x(low - 0.5), plane.x(high + 0.5)
            shade = u32(palette.window, 0.72)
            draw.add_rect_filled((whole[0], top), (inside[0], bottom), shade)
            draw.add_rect_filled((inside[1], top), (whole[1], bottom), shade)
            draw.add_rect_filled((inside[0], top), (inside[1], top + 2.0 * scale), u32(palette.accent, 0.9))
        self._frames(plane)
        self._ready(plane)
        _keys(self.context, plane)
        _handles(self.context, plane, low, high)
        _now(self.context, plane, self._hold == "now")
        draw.pop_clip_rect()

    def _frames(self, plane: Plane) -> None:
        """Draw lines and frame numbers."""
        draw, palette, scale = imgui.get_window_draw_list(), self.context.palette, ui_scale()
        _, top, _, bottom = plane.rect
        line, faint = u32(palette.dim, 0.5), u32(palette.dim, 0.22)
        with font(self.context, "text", SMALL * 0.92):
            for tick in ticks(plane.view.first, plane.view.last, plane.across, 58.0 * scale, whole=True):
                x = round(plane.x(tick.at)) + 0.5
                draw.add_line(
                    (x, bottom - (12.0 if tick.label else 9.0) * scale),
                    (x, bottom - 4.0 * scale),
                    line if tick.label else faint,
                )
                if tick.label:
                    wide = imgui.calc_text_size(tick.label).x
                    draw.add_text((round(x - wide * 0.5), top + 3.0 * scale), u32(palette.dim), tick.label)

    def _ready(self, plane: Plane) -> None:
        """Draw cached frames in green, and frames without a file in red."""
        draw, palette, scale = imgui.get_window_draw_list(), self.context.palette, ui_scale()
        bottom = plane.rect[3]
        for frames, color in (
            (list_runs(self.context.preview.frames), palette.good),
            (self.missing.update(self.context.session, imgui.get_time()), palette.error),
        ):
            for first, last in frames:
                a, b = plane.x(first - 0.5), max(plane.x(last + 0.5), plane.x(first - 0.5) + 1.5)
                draw.add_rect_filled((a, bottom - 3.0 * scale), (b, bottom), u32(color, 0.95))


def _plane(context: TimelineContext, rect: Rect) -> Plane:
    low, high = context.timeline.visible_range(context.session)
    return Plane(View(low, high), rect)


def list_runs(frames: tuple[int, ...]) -> list[tuple[int, int]]:
    """Runs of consecutive frames, as their first and last frame."""
    runs: list[tuple[int, int]] = []
    for frame in frames:
        if runs and runs[-1][1] == frame - 1:
            runs[-1] = runs[-1][0], frame
        else:
            runs.append((frame, frame))
    return runs


def _keys(context: TimelineContext, plane: Plane) -> None:
    """Draw the keys of the selected nodes, else of all, as diamonds."""
    draw, palette, session, size = imgui.get_window_draw_list(), context.palette, context.session, KEY * ui_scale()
    y = plane.rect[3] - 8.0 * ui_scale()
    edge = u32(palette.window, 0.9)
    for frame in session.time.list_key_frames():
        x = plane.x(frame)
        if plane.rect[0] - size <= x <= plane.rect[2] + size:
            color = palette.accent if frame == session.time.frame else mix(palette.warning, palette.text, 0.15)
            draw.add_ngon_filled((x, y), size * 1.45, edge, 4)
            draw.add_ngon_filled((x, y), size, u32(color), 4)


def _handle(context: TimelineContext, plane: Plane, x: float, y: float) -> Hold:
    """The handle under the mouse; handles are in the upper half of the ruler."""
    if y > plane.rect[1] + (plane.rect[3] - plane.rect[1]) * 0.45:
        return ""
    low, high = context.timeline.span(context.session)
    ends: tuple[tuple[Hold, float], ...] = (("in", plane.x(low - 0.5)), ("out", plane.x(high + 0.5)))
    name, at = min(ends, key=lambda end: abs(x - end[1]))
    return name if abs(x - at) <= NEAR * ui_scale() else ""


def _handles(context: TimelineContext, plane: Plane, low: int, high: int) -> None:
    """Draw the in and out points of playback."""
    draw, palette, scale = imgui.get_window_draw_list(), context.palette, ui_scale()
    top, size = plane.rect[1], 7.0 * scale
    lit = context.timeline.part is not None
    color = u32(palette.accent if lit else palette.dim, 1.0 if lit else 0.7)
    for name, x, direction in (("in", plane.x(low - 0.5), 1.0), ("out", plane.x(high + 0.5), -1.0)):
        draw.add_triangle_filled((x, top), (x + direction * size, top), (x, top + size * 1.3), color)
        context.places[f"ruler {name}"] = (x - 3.0 * scale, top, x + 3.0 * scale, top + size)


def _now(context: TimelineContext, plane: Plane, held: bool) -> None:
    """Draw the current frame."""
    draw, palette, scale = imgui.get_window_draw_list(), context.palette, ui_scale()
    left, top, right, bottom = plane.rect
    frame = context.session.time.frame
    wide = plane.across
    x = plane.x(frame)
    if 6.0 * scale < wide < 90.0 * scale:
        draw.add_rect_filled((x - wide * 0.5, top), (x + wide * 0.5, bottom), u32(palette.accent, 0.16))
    draw.add_line((round(x) + 0.5, top), (round(x) + 0.5, bottom), u32(palette.accent), (2.0 if held else 1.5) * scale)
    with font(context, "bold", SMALL * 0.92):
        text = str(frame)
        half = imgui.calc_text_size(text).x * 0.5 + 5.0 * scale
        middle = min(max(x, left + half), right - half)
        high = imgui.get_font_size() + 3.0 * scale
        box = (middle - half, top + 1.0), (middle + half, top + 1.0 + high)
        draw.add_rect_filled(*box, u32(palette.accent), 3.0 * scale)
        draw.add_text((round(box[0][0] + 5.0 * scale), round(top + 1.0 + scale)), u32(palette.on_accent), text)
    context.places["ruler now"] = (middle - half, top, middle + half, top + high)


def _tell(context: TimelineContext, plane: Plane) -> None:
    """Draw the tooltip of the frame under the mouse."""
    frame = math.floor(plane.frame(imgui.get_mouse_pos().x) + 0.5)
    session = context.session
    seconds = (frame - session.time.frames[0]) / session.root.settings.rate
    facts = [translate("frame {frame}, {seconds:.2f} s", frame=frame, seconds=seconds)]
    if frame in session.time.list_key_frames():
        facts.append(translate("a key"))
    if frame in context.preview.frames:
        facts.append(translate("ready"))
    tip(" · ".join(facts))
