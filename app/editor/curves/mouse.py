"""Mouse input of the Animation panel: starts gestures and applies them to keys."""

from __future__ import annotations

from typing import Literal

from imgui_bundle import imgui
from msgspec.structs import replace

from ...graph import Keys
from ...language.translation import translate
from . import commands
from .editing import KeyEdit, find_frame_range, has_aligned_handles
from .frame import CurvesFrame, contains
from .gestures import Gesture, HandleDrag, KeyBox, KeyMove, KeyScale, PlotPan, Seek
from .hits import REACH, Mark, Tip, find_nearest, find_spots_in_box
from .paint import find_grips
from .rows import Lane, Spot, find_limits
from .shapes import read_key_channel

LEFT, RIGHT, MIDDLE = imgui.MouseButton_.left, imgui.MouseButton_.right, imgui.MouseButton_.middle
CLICK = 3.0
"""Pixels (at UI scale 1) that the mouse may move within a click."""

_WHEEL_STEP = 48.0
"""Pixels that one notch of the wheel moves the view. Chosen by feel."""

_FRAME_REACH = 4.0
"""Pixels on both sides at which the line of the frame is hit. Chosen by feel."""

Part = Literal["", "key", "tip", "left", "right", "bar", "now", "ruler", "curve", "open"]


class CurvesMouse:
    """The current gesture, and what is under the pointer."""

    def __init__(self) -> None:
        self.gesture: Gesture | None = None
        self.part: Part = ""
        self.mark: Mark | None = None
        self.tip: Tip | None = None
        self.lane: Lane | None = None
        self.menu = False
        """True in the frame in which the user asks for a menu."""
        self._count = 0
        self._pressed: tuple[float, float] = (0.0, 0.0)

    def update(self, frame: CurvesFrame) -> None:
        """Continue the gesture, or begin one."""
        io = imgui.get_io()
        self.menu = False
        self.part, self.mark, self.tip, self.lane = "", None, None, None
        if self.gesture is None and frame.hovered:
            self._find_part(frame)
        if frame.hovered or self.gesture:
            self._apply_wheel(frame, io)
        if self.gesture:
            self._continue(frame, io)
        elif frame.hovered:
            self._begin(frame, io)
        self._set_cursor()

    # --- what is there -----------------------------------------------------------------------------------------------

    def _find_part(self, frame: CurvesFrame) -> None:
        x, y = frame.pointer
        reach = REACH * frame.scale
        if contains(frame.ruler, frame.pointer):
            self.part = "ruler"
        elif contains(frame.bar, frame.pointer):
            bar_grips = find_grips(frame)
            if bar_grips and bar_grips[0] - 2.0 <= x <= bar_grips[1] + 2.0:
                self.part = (
                    "left"
                    if x <= bar_grips[0] + bar_grips[2]
                    else "right"
                    if x >= bar_grips[1] - bar_grips[2]
                    else "bar"
                )
        elif tip := find_nearest(frame.tips, x, y, reach):
            self.part, self.tip = "tip", tip
        elif mark := frame.find_mark(x, y, reach):
            self.part, self.mark = "key", mark
        elif abs(x - frame.plane.x(frame.context.session.time.frame)) <= _FRAME_REACH * frame.scale:
            self.part = "now"
        else:
            self.lane = frame.find_lane(x, y, reach)
            self.part = "curve" if self.lane else "open"

    def _set_cursor(self) -> None:
        gesture = self.gesture
        if isinstance(gesture, PlotPan):
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
        elif isinstance(gesture, KeyScale) or self.part in ("left", "right", "now") or isinstance(gesture, Seek):
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        elif self.part in ("key", "tip", "bar"):
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)

    # --- beginning ---------------------------------------------------------------------------------------------------

    def _begin(self, frame: CurvesFrame, io: imgui.IO) -> None:
        state = frame.state
        self._pressed = frame.pointer
        if imgui.is_mouse_clicked(MIDDLE):
            self.gesture = PlotPan(frame.pointer, state.view, state.scroll)
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
                    self._continue(frame, io)
            case "tip" if self.tip:
                self._grab_tip(frame, self.tip)
            case "left" | "right":
                span = find_frame_range(state.spots)
                if span:
                    self._begin_scale(frame, span[0] if self.part == "left" else span[1])
            case "bar":
                span = find_frame_range(state.spots)
                if span:
                    self._begin_move(frame, span[0], None)
            case "key" if self.mark:
                self._grab_key(frame, io, self.mark)
            case "curve" if self.lane:
                keys = frame.graph.animation.get(self.lane[0])
                if isinstance(keys, Keys):
                    lane = frozenset((self.lane[0], at, self.lane[1]) for at in keys.frames)
                    state.choose(lane, "toggle" if io.key_ctrl else "add" if io.key_shift else "replace")
            case _:
                how = "add" if io.key_shift else "toggle" if io.key_ctrl else "replace"
                self.gesture = KeyBox(frame.from_screen(), how)

    def _grab_key(self, frame: CurvesFrame, io: imgui.IO, mark: Mark) -> None:
        state = frame.state
        clicked: frozenset[Spot] | None = None
        if mark.spots <= state.spots and not io.key_shift:
            clicked = state.spots - mark.spots if io.key_ctrl else mark.spots
        else:
            state.choose(mark.spots, "add" if io.key_shift or io.key_ctrl else "replace")
        grabbed = next(iter(mark.spots))[1]
        if io.key_alt:
            self._begin_scale(frame, grabbed)
        else:
            self._begin_move(frame, grabbed, clicked)

    def _begin_move(self, frame: CurvesFrame, grabbed: float, clicked: frozenset[Spot] | None) -> None:
        self.gesture = KeyMove(
            frame.graph.animation, frame.state.spots, grabbed, frame.from_screen(), self._make_token(), clicked=clicked
        )

    def _begin_scale(self, frame: CurvesFrame, grabbed: float) -> None:
        span = find_frame_range(frame.state.spots)
        if span and span[1] > span[0]:
            about = span[0] if abs(grabbed - span[0]) >= abs(grabbed - span[1]) else span[1]
            self.gesture = KeyScale(
                frame.graph.animation, frame.state.spots, about, grabbed, frame.from_screen()[0], self._make_token()
            )

    def _grab_tip(self, frame: CurvesFrame, tip: Tip) -> None:
        keys = frame.graph.animation.get(tip.port)
        if not isinstance(keys, Keys):
            return
        key = keys.keys[keys.frames.index(tip.frame)]
        at, end = frame.from_screen(), frame.from_screen((tip.x, tip.y))
        both = (tip.port, tip.frame) not in frame.state.free and has_aligned_handles(keys, tip.frame)
        self.gesture = HandleDrag(
            keys,
            tip.port,
            tip.frame,
            tip.channel,
            tip.side,
            read_key_channel(key, tip.channel),
            (at[0] - end[0], at[1] - end[1]),
            both,
            self._make_token(),
        )

    def _insert(self, frame: CurvesFrame) -> None:
        at = frame.from_screen()[0]
        at = float(round(at)) if frame.state.snap else at
        row = frame.row_at(frame.pointer[1]) if frame.is_sheet else None
        port = self.lane[0] if self.lane else row.port if row else None
        if port:
            frame.context.log.attempt(lambda: commands.insert(frame.context, port, at))

    def _make_token(self) -> str:
        self._count += 1
        return f"keys {id(self)} {self._count}"

    # --- going on ----------------------------------------------------------------------------------------------------

    def _continue(self, frame: CurvesFrame, io: imgui.IO) -> None:
        """Go on with the gesture: each frame applies the change from where it began, and all of its changes are one
        step of the history (`merge`).
        """
        context, state, gesture = frame.context, frame.state, self.gesture
        if imgui.is_key_pressed(imgui.Key.escape):
            self._cancel(frame)
            return
        if not imgui.is_mouse_down(MIDDLE if isinstance(gesture, PlotPan) else LEFT):
            self._end(frame, io)
            return
        at = frame.from_screen()
        match gesture:
            case PlotPan():
                x, y = frame.pointer[0] - gesture.start[0], frame.pointer[1] - gesture.start[1]
                up = 0.0 if frame.is_sheet else y / frame.plane.up
                state.view = gesture.view.pan(-x / frame.plane.across, up)
                if frame.is_sheet:
                    state.scroll = gesture.scroll - y
            case Seek():
                context.interface.dragging = True
                context.session.time.seek(at[0])
            case KeyMove():
                if gesture.started or self._is_dragged(frame):
                    self._move_keys(frame, io, gesture)
            case KeyScale():
                if self._is_dragged(frame):
                    change = gesture.change(at[0], state.snap != io.key_shift)
                    self._set_keys(
                        frame,
                        change,
                        translate("Scale {keys}", keys=commands.describe_keys(gesture.spots)),
                        gesture.merge,
                    )
            case HandleDrag():
                if io.key_alt:
                    state.free.add((gesture.port, gesture.frame))
                new_keys = gesture.change(at, gesture.turns_both and not io.key_alt, flat=io.key_shift)
                self._set_keys(
                    frame, KeyEdit({gesture.port: new_keys}, state.spots), translate("Bend a curve"), gesture.merge
                )
            case _:
                pass

    def _move_keys(self, frame: CurvesFrame, io: imgui.IO, gesture: KeyMove) -> None:
        """Move keys to the pointer: along one axis of the curves with Ctrl or Shift, off the grid with Shift in the
        sheet.
        """
        self.gesture = gesture = replace(gesture, started=True)
        curves = not frame.is_sheet and not contains(frame.bar, self._pressed)
        change = gesture.change(
            frame.from_screen(),
            frame.state.snap != (io.key_shift and frame.is_sheet),
            lambda port: find_limits(frame.graph, port),
            across=not (curves and io.key_ctrl),
            up=curves and not io.key_shift,
        )
        self._set_keys(
            frame, change, translate("Move {keys}", keys=commands.describe_keys(gesture.spots)), gesture.merge
        )

    def _set_keys(self, frame: CurvesFrame, change: KeyEdit, label: str, merge: str) -> None:
        context, state = frame.context, frame.state
        context.interface.dragging = True

        def act() -> None:
            commands.set_keys(context, change.new_keys, label, merge)
            state.spots = change.spots

        context.log.attempt(act)

    def _end(self, frame: CurvesFrame, io: imgui.IO) -> None:
        gesture, self.gesture = self.gesture, None
        state = frame.state
        match gesture:
            case KeyBox():
                rect = (*frame.to_screen(gesture.start), *frame.pointer)
                if self._is_dragged(frame):
                    boxed_spots = find_spots_in_box(frame.list_marks(), rect)
                    state.choose(boxed_spots, gesture.how)  # type: ignore[arg-type]
                elif gesture.how == "replace":
                    state.spots = frozenset()
            case KeyMove():
                if not gesture.started and gesture.clicked is not None:
                    state.choose(gesture.clicked)
                frame.context.session.seal()
            case KeyScale() | HandleDrag():
                frame.context.session.seal()
            case _:
                pass

    def _cancel(self, frame: CurvesFrame) -> None:
        gesture, self.gesture = self.gesture, None
        if isinstance(gesture, KeyMove | KeyScale | HandleDrag):
            frame.context.session.abandon(gesture.merge)
        if isinstance(gesture, KeyMove | KeyScale):
            frame.state.spots = gesture.spots

    def _is_dragged(self, frame: CurvesFrame) -> bool:
        return max(abs(a - b) for a, b in zip(self._pressed, frame.pointer, strict=True)) > CLICK * frame.scale

    # --- the wheel ---------------------------------------------------------------------------------------------------

    def _apply_wheel(self, frame: CurvesFrame, io: imgui.IO) -> None:
        """Zoom at the pointer: both axes in curves, Ctrl time alone, Shift values alone; in the sheet Shift scrolls."""
        state, turned, across = frame.state, io.mouse_wheel, io.mouse_wheel_h
        if io.key_shift and not turned:
            turned, across = across, 0.0  # some systems turn Shift and wheel sideways
        if across:
            state.view = state.view.pan(-across * _WHEEL_STEP * frame.scale / frame.plane.across, 0.0)
        if not turned:
            return
        factor = 1.15**turned
        frame_at, value = frame.plane.frame(frame.pointer[0]), frame.plane.value(frame.pointer[1])
        if frame.is_sheet:
            if io.key_shift:
                state.scroll -= turned * _WHEEL_STEP * frame.scale
            else:
                state.view = state.view.zoom(frame_at, value, factor, 1.0)
        else:
            state.view = state.view.zoom(
                frame_at, value, 1.0 if io.key_shift else factor, 1.0 if io.key_ctrl else factor
            )


def find_hot(mouse: CurvesMouse) -> Mark | Tip | None:
    """The key or handle under the pointer, to be highlighted."""
    return mouse.tip or mouse.mark


__all__ = ["CurvesMouse", "find_hot"]
