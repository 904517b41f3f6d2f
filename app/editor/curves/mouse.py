"""From the mouse to gestures, and from gestures to keys."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from imgui_bundle import imgui

from ...graph import Keys
from . import commands
from .editing import KeyEdit, aligned, extent
from .frame import CurvesFrame, holds
from .gestures import Bend, Gesture, KeyBox, KeyMove, PlotPan, Scale, Seek
from .hits import REACH, Mark, Tip, boxed, nearest
from .paint import grips
from .rows import Lane, Spot, limits
from .shapes import level

if TYPE_CHECKING:
    pass

LEFT, RIGHT, MIDDLE = imgui.MouseButton_.left, imgui.MouseButton_.right, imgui.MouseButton_.middle
CLICK = 3.0
"""Pixels (at UI scale 1) that the mouse may move within a click."""

_NOTCH = 48.0
_LINE = 4.0
Part = Literal["", "key", "tip", "left", "right", "bar", "now", "ruler", "curve", "open"]


class CurvesMouse:
    """Which gesture is going on, and what is under the pointer."""

    def __init__(self) -> None:
        self.gesture: Gesture | None = None
        self.part: Part = ""
        self.mark: Mark | None = None
        self.tip: Tip | None = None
        self.lane: Lane | None = None
        self.menu = False
        """True in the frame in which a menu is asked for."""
        self._count = 0
        self._pressed: tuple[float, float] = (0.0, 0.0)

    def update(self, frame: CurvesFrame) -> None:
        """Go on with the gesture, or begin one."""
        io = imgui.get_io()
        self.menu = False
        self.part, self.mark, self.tip, self.lane = "", None, None, None
        if self.gesture is None and frame.over:
            self._find(frame)
        if frame.over or self.gesture:
            self._wheel(frame, io)
        if self.gesture:
            self._go_on(frame, io)
        elif frame.over:
            self._begin(frame, io)
        self._cursor()

    # --- what is there -----------------------------------------------------------------------------------------------

    def _find(self, frame: CurvesFrame) -> None:
        x, y = frame.at
        reach = REACH * frame.scale
        if holds(frame.ruler, frame.at):
            self.part = "ruler"
        elif holds(frame.bar, frame.at):
            found = grips(frame)
            if found and found[0] - 2.0 <= x <= found[1] + 2.0:
                self.part = "left" if x <= found[0] + found[2] else "right" if x >= found[1] - found[2] else "bar"
        elif tip := nearest(frame.tips, x, y, reach):
            self.part, self.tip = "tip", tip
        elif mark := frame.near(x, y, reach):
            self.part, self.mark = "key", mark
        elif abs(x - frame.plane.x(frame.context.session.frame)) <= _LINE * frame.scale:
            self.part = "now"
        else:
            self.lane = frame.lane_at(x, y, reach)
            self.part = "curve" if self.lane else "open"

    def _cursor(self) -> None:
        gesture = self.gesture
        if isinstance(gesture, PlotPan):
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
        elif isinstance(gesture, Scale) or self.part in ("left", "right", "now") or isinstance(gesture, Seek):
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        elif self.part in ("key", "tip", "bar"):
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)

    # --- beginning ---------------------------------------------------------------------------------------------------

    def _begin(self, frame: CurvesFrame, io: imgui.IO) -> None:
        state = frame.state
        self._pressed = frame.at
        if imgui.is_mouse_clicked(MIDDLE):
            self.gesture = PlotPan(frame.at, state.view, state.scroll)
        elif imgui.is_mouse_clicked(RIGHT):
            if self.mark and state.spots.isdisjoint(self.mark.spots):
                state.choose(self.mark.spots)
            self.menu = self.part not in ("ruler", "now")
        elif imgui.is_mouse_double_clicked(LEFT) and self.part in ("curve", "open"):
            self._insert(frame)
        elif imgui.is_mouse_clicked(LEFT):
            self._press(frame, io)

    def _press(self, frame: CurvesFrame, io: imgui.IO) -> None:
        state = frame.state
        match self.part:
            case "ruler" | "now":
                self.gesture = Seek()
                if self.part == "ruler":
                    self._go_on(frame, io)
            case "tip" if self.tip:
                self._take_tip(frame, self.tip)
            case "left" | "right":
                span = extent(state.spots)
                if span:
                    self._scale(frame, span[0] if self.part == "left" else span[1])
            case "bar":
                span = extent(state.spots)
                if span:
                    self._move(frame, span[0], None)
            case "key" if self.mark:
                self._take_key(frame, io, self.mark)
            case "curve" if self.lane:
                keys = frame.graph.animation.get(self.lane[0])
                if isinstance(keys, Keys):
                    lane = frozenset((self.lane[0], at, self.lane[1]) for at in keys.frames)
                    state.choose(lane, "toggle" if io.key_ctrl else "add" if io.key_shift else "replace")
            case _:
                how = "add" if io.key_shift else "toggle" if io.key_ctrl else "replace"
                self.gesture = KeyBox(frame.where(), how)

    def _take_key(self, frame: CurvesFrame, io: imgui.IO, mark: Mark) -> None:
        state = frame.state
        clicked: frozenset[Spot] | None = None
        if mark.spots <= state.spots and not io.key_shift:
            clicked = state.spots - mark.spots if io.key_ctrl else mark.spots
        else:
            state.choose(mark.spots, "add" if io.key_shift or io.key_ctrl else "replace")
        grabbed = next(iter(mark.spots))[1]
        if io.key_alt:
            self._scale(frame, grabbed)
        else:
            self._move(frame, grabbed, clicked)

    def _move(self, frame: CurvesFrame, grabbed: float, clicked: frozenset[Spot] | None) -> None:
        self.gesture = KeyMove(
            frame.graph.animation, frame.state.spots, grabbed, frame.where(), self._token(), clicked=clicked
        )

    def _scale(self, frame: CurvesFrame, grabbed: float) -> None:
        span = extent(frame.state.spots)
        if span and span[1] > span[0]:
            about = span[0] if abs(grabbed - span[0]) >= abs(grabbed - span[1]) else span[1]
            self.gesture = Scale(
                frame.graph.animation, frame.state.spots, about, grabbed, frame.where()[0], self._token()
            )

    def _take_tip(self, frame: CurvesFrame, tip: Tip) -> None:
        keys = frame.graph.animation.get(tip.port)
        if not isinstance(keys, Keys):
            return
        key = keys.keys[keys.frames.index(tip.frame)]
        at, end = frame.where(), frame.where((tip.x, tip.y))
        both = (tip.port, tip.frame) not in frame.state.free and aligned(keys, tip.frame)
        self.gesture = Bend(
            keys,
            tip.port,
            tip.frame,
            tip.channel,
            tip.side,
            level(key, tip.channel),
            (at[0] - end[0], at[1] - end[1]),
            both,
            self._token(),
        )

    def _insert(self, frame: CurvesFrame) -> None:
        at = frame.where()[0]
        at = float(round(at)) if frame.state.snap else at
        row = frame.row_at(frame.at[1]) if frame.sheet else None
        port = self.lane[0] if self.lane else row.port if row else None
        if port:
            frame.context.log.attempt(lambda: commands.insert(frame.context, port, at))

    def _token(self) -> str:
        self._count += 1
        return f"keys {id(self)} {self._count}"

    # --- going on ----------------------------------------------------------------------------------------------------

    def _go_on(self, frame: CurvesFrame, io: imgui.IO) -> None:
        context, state, gesture = frame.context, frame.state, self.gesture
        if imgui.is_key_pressed(imgui.Key.escape):
            self._cancel(frame)
            return
        if not imgui.is_mouse_down(MIDDLE if isinstance(gesture, PlotPan) else LEFT):
            self._end(frame, io)
            return
        at = frame.where()
        match gesture:
            case PlotPan():
                x, y = frame.at[0] - gesture.start[0], frame.at[1] - gesture.start[1]
                up = 0.0 if frame.sheet else y / frame.plane.up
                state.view = gesture.view.pan(-x / frame.plane.across, up)
                if frame.sheet:
                    state.scroll = gesture.scroll - y
            case Seek():
                context.interface.dragging = True
                context.session.seek(at[0])
            case KeyMove():
                if not gesture.going and not self._far(frame):
                    return
                self.gesture = gesture = replace(gesture, going=True)
                snap = state.snap != (io.key_shift and frame.sheet)
                curves = not frame.sheet and not holds(frame.bar, self._pressed)
                change = gesture.change(
                    at,
                    snap,
                    lambda port: limits(frame.graph, port),
                    across=not (curves and io.key_ctrl),
                    up=curves and not io.key_shift,
                )
                self._put(frame, change, f"Move {commands.spoken(gesture.spots)}", gesture.merge)
            case Scale():
                if self._far(frame):
                    change = gesture.change(at[0], state.snap != io.key_shift)
                    self._put(frame, change, f"Scale {commands.spoken(gesture.spots)}", gesture.merge)
            case Bend():
                if io.key_alt:
                    state.free.add((gesture.port, gesture.frame))
                made = gesture.change(at, gesture.both and not io.key_alt, flat=io.key_shift)
                self._put(frame, KeyEdit({gesture.port: made}, state.spots), "Bend a curve", gesture.merge)
            case _:
                pass

    def _put(self, frame: CurvesFrame, change: KeyEdit, label: str, merge: str) -> None:
        context, state = frame.context, frame.state
        context.interface.dragging = True

        def act() -> None:
            commands.put(context, change.made, label, merge)
            state.spots = change.spots

        context.log.attempt(act)

    def _end(self, frame: CurvesFrame, io: imgui.IO) -> None:
        gesture, self.gesture = self.gesture, None
        state = frame.state
        match gesture:
            case KeyBox():
                rect = (*frame.back(gesture.start), *frame.at)
                if self._far(frame):
                    found = boxed(frame.marks(), rect)
                    state.choose(found, gesture.how)  # type: ignore[arg-type]
                elif gesture.how == "replace":
                    state.spots = frozenset()
            case KeyMove():
                if not gesture.going and gesture.clicked is not None:
                    state.choose(gesture.clicked)
                frame.context.session.seal()
            case Scale() | Bend():
                frame.context.session.seal()
            case _:
                pass

    def _cancel(self, frame: CurvesFrame) -> None:
        gesture, self.gesture = self.gesture, None
        if isinstance(gesture, KeyMove | Scale | Bend):
            frame.context.session.abandon(gesture.merge)
        if isinstance(gesture, KeyMove | Scale):
            frame.state.spots = gesture.spots

    def _far(self, frame: CurvesFrame) -> bool:
        return max(abs(a - b) for a, b in zip(self._pressed, frame.at, strict=True)) > CLICK * frame.scale

    # --- the wheel ---------------------------------------------------------------------------------------------------

    def _wheel(self, frame: CurvesFrame, io: imgui.IO) -> None:
        """Zoom at the pointer: both axes in curves, Ctrl time alone, Shift values alone; in the sheet Shift scrolls."""
        state, turned, across = frame.state, io.mouse_wheel, io.mouse_wheel_h
        if io.key_shift and not turned:
            turned, across = across, 0.0  # some systems turn Shift and wheel sideways
        if across:
            state.view = state.view.pan(-across * _NOTCH * frame.scale / frame.plane.across, 0.0)
        if not turned:
            return
        factor = 1.15**turned
        frame_at, value = frame.plane.frame(frame.at[0]), frame.plane.value(frame.at[1])
        if frame.sheet:
            if io.key_shift:
                state.scroll -= turned * _NOTCH * frame.scale
            else:
                state.view = state.view.zoom(frame_at, value, factor, 1.0)
        else:
            state.view = state.view.zoom(
                frame_at, value, 1.0 if io.key_shift else factor, 1.0 if io.key_ctrl else factor
            )


def hot_of(mouse: CurvesMouse) -> Mark | Tip | None:
    """What is lit under the pointer."""
    return mouse.tip or mouse.mark


__all__ = ["CurvesMouse", "hot_of"]
