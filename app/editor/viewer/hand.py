"""Mouse and wheel over the picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ..theme.style import ui_scale
from .geometry import Point, Sight
from .holding import Aim, Hold, aim

if TYPE_CHECKING:
    from ..editor import Editor

NOTCHES = 4.0
"""Steps of the wheel that double the size."""

_CURSORS: Mapping[str, imgui.MouseCursor_] = MappingProxyType({
    "n": imgui.MouseCursor_.resize_ns, "s": imgui.MouseCursor_.resize_ns, "w": imgui.MouseCursor_.resize_ew,
    "e": imgui.MouseCursor_.resize_ew, "nw": imgui.MouseCursor_.resize_nwse, "se": imgui.MouseCursor_.resize_nwse,
    "ne": imgui.MouseCursor_.resize_nesw, "sw": imgui.MouseCursor_.resize_nesw, "move": imgui.MouseCursor_.resize_all,
    "line": imgui.MouseCursor_.resize_all, "angle": imgui.MouseCursor_.hand,
})


class Hand:
    """What the mouse does with the picture. To be used right after the item that catches the mouse."""

    def __init__(self) -> None:
        self._hold: Hold | None = None
        self.aim = Aim("pan")
        self.picked: Point | None = None
        """Where the eyedropper was pressed or dragged to in this frame."""

    def follow(self, editor: Editor, sight: Sight) -> None:
        """Do what mouse and wheel ask for."""
        viewer, io = editor.viewer, imgui.get_io()
        hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
        at = (io.mouse_pos.x, io.mouse_pos.y)
        self.picked = None
        viewer.hovered = hovered or active
        imgui.set_item_key_owner(imgui.Key.mouse_wheel_y)
        if hovered and io.mouse_wheel:
            self._zoom(editor, sight, 2.0 ** (io.mouse_wheel / NOTCHES), at)
        if viewer.nearer != 1.0:
            middle = sight.origin[0] + sight.panel[0] / 2, sight.origin[1] + sight.panel[1] / 2
            self._zoom(editor, sight, viewer.nearer, at if hovered else middle)
            viewer.nearer = 1.0
        if hovered and not active:
            self.aim = aim(editor, sight, at, ui_scale(), ctrl=io.key_ctrl)
        if imgui.is_item_activated():
            self._press(editor, sight, at)
        if self._hold is not None:
            self._drag(editor, sight, at, active)
        if hovered or active:
            self._show_cursor()

    def _press(self, editor: Editor, sight: Sight, at: Point) -> None:
        left = imgui.is_mouse_down(imgui.MouseButton_.left)
        if imgui.is_mouse_down(imgui.MouseButton_.right):
            if editor.viewer.picking:
                editor.viewer.picking = ""
            else:
                imgui.open_popup("viewer menu")
            return
        plain = left and not imgui.is_key_down(imgui.Key.space)
        self._hold = Hold.begin(editor, sight, at, self.aim if plain else Aim("pan"))

    def _drag(self, editor: Editor, sight: Sight, at: Point, active: bool) -> None:
        assert self._hold is not None
        delta = imgui.get_io().mouse_delta
        if self._hold.aim.what == "pick":
            self.picked = at
        self._hold.drag(editor, sight, at, (delta.x, delta.y))
        if not active:
            self._hold.release(editor, sight, at)
            self._hold = None

    @staticmethod
    def _zoom(editor: Editor, sight: Sight, factor: float, at: Point) -> None:
        """A zoom that passes 1 stops there."""
        now = sight.zoom
        if (now - 1.0) * (now * factor - 1.0) < 0.0 and not math.isclose(now, 1.0):
            factor = 1.0 / now
        zoomed = sight.zoomed(factor, at)
        editor.viewer.zoom, editor.viewer.pan = zoomed.zoom, zoomed.pan

    def _show_cursor(self) -> None:
        what = self._hold.aim if self._hold else self.aim
        if what.what in ("handle", "light"):
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
        elif what.what == "pan" and self._hold and self._hold.moved:
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
        elif what.grip in _CURSORS:
            imgui.set_mouse_cursor(_CURSORS[what.grip])
