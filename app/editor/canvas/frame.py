"""What is known of the mouse and the canvas in one frame, and how the mouse moves the view."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from .geometry import CanvasTransform, Point, Rect, drift, zoomed
from .layout import ROW
from .scene import CanvasScene

if TYPE_CHECKING:
    from .context import CanvasContext

CLICK = 4.0
"""Pixels (at UI scale 1) that the mouse may move within a click."""

_BORDER, _SPEED = 28.0, 900.0
_NOTCH = 60.0


@dataclass
class CanvasFrame:
    """What is known of the mouse and the canvas in one frame. `scene` has no gesture in it yet."""

    context: CanvasContext
    scene: CanvasScene
    to: CanvasTransform
    panel: Rect
    scale: float
    """Pixels per unit of the interface."""
    over: bool
    """True if nothing lies between the mouse and the canvas."""
    at: Point = (0.0, 0.0)
    screen: Point = (0.0, 0.0)

    @property
    def reach(self) -> float:
        """How far off pins and links can be hit, in canvas units: always as many pixels."""
        return min(9.0 * self.scale / self.to.scale, ROW)

    def is_far(self, start: Point) -> bool:
        """True once the mouse has left the place of a click, a canvas position."""
        x, y = self.to.to_screen(*start)
        return max(abs(x - self.screen[0]), abs(y - self.screen[1])) > CLICK * self.scale


def turn_wheel(frame: CanvasFrame, io: imgui.IO, on_field: bool) -> None:
    """The wheel zooms about the pointer; with Shift, or sideways, it pans. Ctrl on a field turns its value."""
    view = frame.context.canvas
    across, down = io.mouse_wheel_h, io.mouse_wheel
    if not (across or down) or (io.key_ctrl and on_field):
        return
    if io.key_shift or across:
        if io.key_shift and not across:
            across, down = down, 0.0
        step = _NOTCH * frame.scale / frame.to.scale
        view.center = view.center[0] - across * step, view.center[1] - down * step
    else:
        view.center, view.zoom = zoomed(view.center, view.zoom, frame.at, 1.15**down)


def pan_at_border(frame: CanvasFrame, io: imgui.IO) -> None:
    """Move the view on while something is dragged near the border of the panel."""
    x, y = drift(frame.panel, *frame.screen, _BORDER * frame.scale)
    if x or y:
        view = frame.context.canvas
        step = _SPEED * frame.scale * min(io.delta_time, 0.05) / frame.to.scale
        view.center = view.center[0] + x * step, view.center[1] + y * step
