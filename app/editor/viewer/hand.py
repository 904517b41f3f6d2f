"""Mouse input over the picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ..theme.style import ui_scale
from .geometry import Point, Sight
from .holding import HandleTarget, MouseHold, aim
from .lights import add_light, can_add, make_merge_token, place_light, turn_spot
from .orbit import Orbit, move_camera, scene_at
from .painting import cancel_stroke
from .spline_edits import insert_on_curve

if TYPE_CHECKING:
    from .context import ViewerContext

NOTCHES = 4.0
"""Steps of the wheel that double the zoom."""

_PAUSE = 0.7
"""Seconds without the wheel that end an undo step."""

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
    """Handles mouse and wheel over the picture. Call it right after the item that catches the mouse."""

    def __init__(self, context: ViewerContext) -> None:
        self._context = context
        self._hold: MouseHold | None = None
        self.aim = HandleTarget("pan")
        self._last_turn = "", 0.0
        """The last change by the wheel, and its time."""
        self.picked_point: Point | None = None
        """The point where the eyedropper is in this frame, if it is pressed."""

    def follow(self, sight: Sight) -> None:
        """Handle mouse and wheel."""
        viewer, io = self._context.viewer, imgui.get_io()
        hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
        at = (io.mouse_pos.x, io.mouse_pos.y)
        self.picked_point = None
        viewer.hovered = hovered or active
        imgui.set_item_key_owner(imgui.Key.mouse_wheel_y)
        if imgui.is_item_activated() or (hovered and not active):  # modifiers may come with the press
            keys = {"ctrl": io.key_ctrl, "alt": io.key_alt, "shift": io.key_shift}
            self.aim = aim(self._context, sight, at, ui_scale(), **keys)
        if hovered and io.mouse_wheel:
            self._wheel(sight, 2.0 ** (io.mouse_wheel / NOTCHES), at)
        if viewer.nearer != 1.0:
            middle = sight.origin[0] + sight.panel[0] / 2, sight.origin[1] + sight.panel[1] / 2
            self._zoom(sight, viewer.nearer, at if hovered else middle)
            viewer.nearer = 1.0
        if viewer.shift != (0.0, 0.0):
            x, y = (viewer.shift[i] * sight.panel[i] / sight.density for i in (0, 1))
            moved = sight.pan_by(x, y)
            viewer.zoom, viewer.pan, viewer.shift = moved.zoom, moved.pan, (0.0, 0.0)
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
        target = self.aim if left else HandleTarget("track" if self._context.viewer.orbits else "pan")
        target = HandleTarget("pan") if imgui.is_key_down(imgui.Key.space) else target
        twice = left and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
        if twice and target.kind in ("pan", "orbit") and sight.under(at) and can_add(self._context):
            add_light(self._context, sight.fraction(at))
            return
        if twice and target.spline is not None and target.spline.part == "curve":
            insert_on_curve(self._context, target.spline)
            return
        self._hold = MouseHold.begin(self._context, sight, at, target, ui_scale())

    def _drag(self, sight: Sight, at: Point, active: bool) -> None:
        assert self._hold is not None
        delta = imgui.get_io().mouse_delta
        if self._hold.aim.kind == "pick":
            self.picked_point = at
        if self._hold.token and imgui.is_key_pressed(imgui.Key.escape, False):
            self._context.session.abandon(self._hold.token)
            self._context.viewer.guides, self._context.viewer.deferred = (), None
            cancel_stroke(self._context)
            self._hold = None
            return
        io = imgui.get_io()
        self._hold.drag(
            sight, at, (delta.x, delta.y), is_free=io.key_ctrl, is_constrained=io.key_shift, is_broken=io.key_alt
        )
        if not active:
            self._hold.release(sight, at)
            self._hold = None

    def _wheel(self, sight: Sight, factor: float, at: Point) -> None:
        """Zoom; over a light, change its depth; while orbiting, move the camera nearer."""
        if self._hold is not None and self._hold.token:
            return
        lamp, kind = self.aim.lamp, self.aim.kind
        if lamp is not None and kind in ("light", "light depth", "light drop"):
            self._begin_turn(make_merge_token(lamp))
            place_light(self._context, lamp, lamp.at, lamp.depth / factor)
        elif lamp is not None and kind in ("goal", "goal depth") and lamp.aims:
            self._begin_turn(make_merge_token(lamp))
            turn_spot(self._context, lamp, lamp.aims[0], lamp.aims[1] / factor)
        elif kind in ("orbit", "track") and not imgui.is_key_down(imgui.Key.space):
            scene = scene_at(self._context)
            if scene is not None:
                self._begin_turn(self._context.viewer.scene)
                move_camera(self._context, Orbit.of(scene).approach_by(factor), "orbit")
        else:
            self._zoom(sight, factor, at)

    def _begin_turn(self, of: str) -> None:
        """Begin a new undo step, unless the wheel turned a moment ago."""
        last, when = self._last_turn
        if of != last or imgui.get_time() - when > _PAUSE:
            self._context.session.seal()
        self._last_turn = of, imgui.get_time()

    def _zoom(self, sight: Sight, factor: float, at: Point) -> None:
        """Zoom; passing 1 stops there."""
        zoom = sight.zoom
        if (zoom - 1.0) * (zoom * factor - 1.0) < 0.0 and not math.isclose(zoom, 1.0):
            factor = 1.0 / zoom
        new_sight = sight.zoom_by(factor, at)
        self._context.viewer.zoom, self._context.viewer.pan = new_sight.zoom, new_sight.pan

    def _show_cursor(self) -> None:
        target = self._hold.aim if self._hold else self.aim
        if target.kind == "handle" and target.part in _CURSORS:
            imgui.set_mouse_cursor(_CURSORS[target.part])
        elif target.kind in ("handle", "track", "sun") or target.lamp or target.spline:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
        elif target.kind in ("paint", "brush copy"):
            imgui.set_mouse_cursor(imgui.MouseCursor_.none if target.kind == "paint" else imgui.MouseCursor_.hand)
        elif target.kind == "matte" or (target.kind in ("pan", "orbit") and self._hold and self._hold.moved):
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
        elif target.grip in _CURSORS:
            imgui.set_mouse_cursor(_CURSORS[target.grip])
