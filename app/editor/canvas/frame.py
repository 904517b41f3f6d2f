"""The mouse and the canvas in one frame, and how the mouse pans and zooms the view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec import Struct

from .geometry import CanvasTransform, Point, Rect, find_pan_direction, zoom_about
from .layout import ROW
from .scene import CanvasScene

if TYPE_CHECKING:
    from .context import CanvasContext

CLICK = 4.0
"""Pixels (at UI scale 1) that the mouse may move within a click."""

_BORDER, _SPEED = 28.0, 900.0
_WHEEL_STEP = 60.0
"""Pixels that one notch of the wheel moves the view. Chosen by feel."""


class CanvasFrame(Struct):
    """The mouse and the canvas in one frame. `scene` does not contain the current gesture yet."""

    context: CanvasContext
    scene: CanvasScene
    to: CanvasTransform
    panel: Rect
    scale: float
    """The UI scale."""
    hovered: bool
    """True if nothing lies between the mouse and the canvas."""
    pointer: Point = (0.0, 0.0)
    screen: Point = (0.0, 0.0)

    @property
    def reach(self) -> float:
        """The distance at which pins and links are hit, in canvas units: constant in pixels."""
        return min(9.0 * self.scale / self.to.scale, ROW)

    def is_far(self, start: Point) -> bool:
        """True if the mouse is farther from `start`, a canvas position, than a click allows."""
        x, y = self.to.to_screen(*start)
        return max(abs(x - self.screen[0]), abs(y - self.screen[1])) > CLICK * self.scale


def apply_wheel(frame: CanvasFrame, io: imgui.IO, on_field: bool) -> None:
    """Zoom about the pointer; pan with Shift or a sideways wheel. Ctrl on a field changes its value instead."""
    view = frame.context.canvas
    across, down = io.mouse_wheel_h, io.mouse_wheel
    if not (across or down) or (io.key_ctrl and on_field):
        return
    if io.key_shift or across:
        if io.key_shift and not across:
            across, down = down, 0.0
        step = _WHEEL_STEP * frame.scale / frame.to.scale
        view.center = view.center[0] - across * step, view.center[1] - down * step
    else:
        view.center, view.zoom = zoom_about(view.center, view.zoom, frame.pointer, 1.15**down)


def pan_at_border(frame: CanvasFrame, io: imgui.IO) -> None:
    """Pan the view while the user drags near the border of the panel."""
    x, y = find_pan_direction(frame.panel, *frame.screen, _BORDER * frame.scale)
    if x or y:
        view = frame.context.canvas
        step = _SPEED * frame.scale * min(io.delta_time, 0.05) / frame.to.scale
        view.center = view.center[0] + x * step, view.center[1] + y * step
