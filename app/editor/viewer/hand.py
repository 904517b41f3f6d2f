"""Mouse and wheel over the picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ..theme.style import ui_scale
from .geometry import Point, Sight
from .holding import HandleTarget, MouseHold, aim
from .lights import add, can_add, put, token, turn
from .orbit import Orbit, scene_at
from .orbit import put as put_camera

if TYPE_CHECKING:
    from .context import ViewerContext

NOTCHES = 4.0
"""Steps of the wheel that double the size."""

_PAUSE = 0.7
"""Seconds without the wheel that end a step."""

_CURSORS: Mapping[str, imgui.MouseCursor_] = MappingProxyType(
    {
        "n": imgui.MouseCursor_.resize_ns,
        "s": imgui.MouseCursor_.resize_ns,
        "w": imgui.MouseCursor_.resize_ew,
        "e": imgui.MouseCursor_.resize_ew,
        "nw": imgui.MouseCursor_.resize_nwse,
        "se": imgui.MouseCursor_.resize_nwse,
        "ne": imgui.MouseCursor_.resize_nesw,
        "sw": imgui.MouseCursor_.resize_nesw,
        "move": imgui.MouseCursor_.resize_all,
        "line": imgui.MouseCursor_.resize_all,
        "angle": imgui.MouseCursor_.hand,
    }
)


class ViewerInput:
    """What the mouse does with the picture. To be used right after the item that catches the mouse."""

    def __init__(self, context: ViewerContext) -> None:
        self._context = context
        self._hold: MouseHold | None = None
        self.aim = HandleTarget("pan")
        self._turned = "", 0.0
        """What the wheel changed last, and when."""
        self.picked: Point | None = None
        """Where the eyedropper was pressed or dragged to in this frame."""

    def follow(self, sight: Sight) -> None:
        """Do what mouse and wheel ask for."""
        viewer, io = self._context.viewer, imgui.get_io()
        hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
        at = (io.mouse_pos.x, io.mouse_pos.y)
        self.picked = None
        viewer.hovered = hovered or active
        imgui.set_item_key_owner(imgui.Key.mouse_wheel_y)
        if hovered and not active:
            keys = {"ctrl": io.key_ctrl, "alt": io.key_alt, "shift": io.key_shift}
            self.aim = aim(self._context, sight, at, ui_scale(), **keys)
        if hovered and io.mouse_wheel:
            self._wheel(sight, 2.0 ** (io.mouse_wheel / NOTCHES), at)
        if viewer.nearer != 1.0:
            middle = sight.origin[0] + sight.panel[0] / 2, sight.origin[1] + sight.panel[1] / 2
            self._zoom(sight, viewer.nearer, at if hovered else middle)
            viewer.nearer = 1.0
        if imgui.is_item_activated():
            self._press(sight, at)
        if self._hold is not None:
            self._drag(sight, at, active)
        if hovered or active:
            self._show_cursor()

    def _press(self, sight: Sight, at: Point) -> None:
        left = imgui.is_mouse_down(imgui.MouseButton_.left)
        if imgui.is_mouse_down(imgui.MouseButton_.right):
            if self._context.viewer.picking:
                self._context.viewer.picking = ""
            else:
                imgui.open_popup("viewer menu")
            return
        taken = self.aim if left else HandleTarget("track" if self._context.viewer.orbits else "pan")
        taken = HandleTarget("pan") if imgui.is_key_down(imgui.Key.space) else taken
        twice = left and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
        if twice and taken.what in ("pan", "orbit") and sight.under(at) and can_add(self._context):
            add(self._context, sight.fraction(at))
            return
        self._hold = MouseHold.begin(self._context, sight, at, taken, ui_scale())

    def _drag(self, sight: Sight, at: Point, active: bool) -> None:
        assert self._hold is not None
        delta = imgui.get_io().mouse_delta
        if self._hold.aim.what == "pick":
            self.picked = at
        if self._hold.token and imgui.is_key_pressed(imgui.Key.escape, False):
            self._context.session.abandon(self._hold.token)
            self._hold = None
            return
        self._hold.drag(sight, at, (delta.x, delta.y))
        if not active:
            self._hold.release(sight, at)
            self._hold = None

    def _wheel(self, sight: Sight, factor: float, at: Point) -> None:
        """Zoom; over a light, take that nearer or farther; where the mouse moves a camera, go nearer."""
        if self._hold is not None and self._hold.token:
            return
        lamp, what = self.aim.lamp, self.aim.what
        if lamp is not None and what in ("light", "light depth", "light drop"):
            self._begin_turn(token(lamp))
            put(self._context, lamp, lamp.at, lamp.depth / factor)
        elif lamp is not None and what in ("goal", "goal depth") and lamp.aims:
            self._begin_turn(token(lamp))
            turn(self._context, lamp, lamp.aims[0], lamp.aims[1] / factor)
        elif what in ("orbit", "track") and not imgui.is_key_down(imgui.Key.space):
            scene = scene_at(self._context)
            if scene is not None:
                self._begin_turn(self._context.viewer.scene)
                put_camera(self._context, Orbit.of(scene).nearer(factor), "orbit")
        else:
            self._zoom(sight, factor, at)

    def _begin_turn(self, of: str) -> None:
        """What the wheel does without a pause is one step."""
        last, when = self._turned
        if of != last or imgui.get_time() - when > _PAUSE:
            self._context.session.seal()
        self._turned = of, imgui.get_time()

    def _zoom(self, sight: Sight, factor: float, at: Point) -> None:
        """A zoom that passes 1 stops there."""
        now = sight.zoom
        if (now - 1.0) * (now * factor - 1.0) < 0.0 and not math.isclose(now, 1.0):
            factor = 1.0 / now
        zoomed = sight.zoomed(factor, at)
        self._context.viewer.zoom, self._context.viewer.pan = zoomed.zoom, zoomed.pan

    def _show_cursor(self) -> None:
        what = self._hold.aim if self._hold else self.aim
        if what.what in ("handle", "track", "sun") or what.lamp:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
        elif what.what == "matte" or (what.what in ("pan", "orbit") and self._hold and self._hold.moved):
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
        elif what.grip in _CURSORS:
            imgui.set_mouse_cursor(_CURSORS[what.grip])
