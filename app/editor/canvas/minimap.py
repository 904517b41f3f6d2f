"""The minimap: the whole graph in a corner, while a part of it is out of view. A click or drag in it pans the view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec import Struct

from ..theme.style import u32, ui_scale
from .brush import DrawContext
from .geometry import Point, Rect, find_bounds
from .scene import CanvasScene

if TYPE_CHECKING:
    from .context import CanvasContext

_SIZE, _GAP, _PAD = (168.0, 112.0), 12.0, 6.0
_ROUNDED = 4.0
"""The height in pixels from which a box has round corners: on smaller ones nobody sees that they have a pixel each."""


class Minimap(Struct):
    """The minimap; `dragging` while the user drags in it."""

    context: CanvasContext
    dragging: bool = False
    is_needed: bool = False
    """True while an element is out of view: else the minimap would only hide what is below it."""

    def find_rect(self, panel: Rect) -> Rect | None:
        """The rectangle of the minimap, or None in a small panel and while everything is in view."""
        scale = ui_scale()
        width, height, gap = _SIZE[0] * scale, _SIZE[1] * scale, _GAP * scale
        if not self.is_needed or not _has_room((panel[2] - panel[0], panel[3] - panel[1]), scale):
            return None
        return panel[2] - gap - width, panel[3] - gap - height, panel[2] - gap, panel[3] - gap

    def find_corner(self, size: Point) -> Point:
        """Width and height of the corner that the minimap takes of a panel of `size`, in pixels at UI scale 1."""
        if not self.context.store.current.minimap or not _has_room(size, 1.0):
            return 0.0, 0.0
        return _SIZE[0] + 2 * _GAP, _SIZE[1] + 2 * _GAP

    def draw(self, brush: DrawContext, panel: Rect, scene: CanvasScene) -> None:
        """Draw the minimap, and pan the view to a click in it.

        Its bounds include the visible part, so that the rectangle of the view never leaves the map.
        """
        left, top, right, bottom = brush.visible
        around = scene.bounds or brush.visible
        self.is_needed = self.dragging or (
            around[0] < left or around[1] < top or around[2] > right or around[3] > bottom
        )
        rect = self.find_rect(panel)
        bounds = find_bounds([around, brush.visible])
        if rect is None or bounds is None:
            return
        pad = _PAD * ui_scale()
        across, down = rect[2] - rect[0] - 2 * pad, rect[3] - rect[1] - 2 * pad
        scale = min(across / (bounds[2] - bounds[0]), down / (bounds[3] - bounds[1]))
        left = (rect[0] + rect[2]) / 2 - (bounds[0] + bounds[2]) / 2 * scale
        top = (rect[1] + rect[3]) / 2 - (bounds[1] + bounds[3]) / 2 * scale
        draw, palette, selection = brush.draw, self.context.palette, self.context.session.selection
        rounding = 6.0 * ui_scale()
        draw.add_rect_filled(rect[:2], rect[2:], u32(palette.panel, 0.88), rounding)
        faint, marks = u32(palette.dim, 0.2), brush.ink.marks
        for key, box in scene.boxes.items():
            if box.sort == "dot":
                continue
            x, y, width, height = left + box.x * scale, top + box.y * scale, box.w * scale, box.h * scale
            header = marks.get(box.layout.category, marks[""]) if box.layout else faint
            color = brush.ink.accent if key in selection else header
            rounded = 1.0 if height >= _ROUNDED else 0.0
            draw.add_rect_filled((x, y), (x + max(width, 2.0), y + max(height, 1.5)), color, rounded)
        visible = brush.visible
        low = (left + visible[0] * scale, top + visible[1] * scale)
        high = (left + visible[2] * scale, top + visible[3] * scale)
        draw.push_clip_rect(rect[:2], rect[2:], True)
        draw.add_rect_filled(low, high, u32(palette.text, 0.06), 2.0)
        draw.add_rect(low, high, u32(palette.text, 0.55), 2.0)
        draw.pop_clip_rect()
        draw.add_rect(rect[:2], rect[2:], u32(palette.border), rounding)
        self.context.places["minimap"] = rect

        self._pan(rect, (left, top), scale)

    def _pan(self, rect: Rect, origin: Point, scale: float) -> None:
        """Center the view on the place under the mouse while it is held down on the map."""
        imgui.set_cursor_screen_pos(rect[:2])
        imgui.set_next_item_allow_overlap()
        imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)
        imgui.invisible_button("##minimap", (rect[2] - rect[0], rect[3] - rect[1]))
        imgui.pop_item_flag()
        self.dragging = imgui.is_item_active()
        if self.dragging:
            mouse = imgui.get_mouse_pos()
            self.context.canvas.center = (mouse.x - origin[0]) / scale, (mouse.y - origin[1]) / scale


def _has_room(size: Point, scale: float) -> bool:
    """False for a panel that the minimap would take too much of."""
    return size[0] >= _SIZE[0] * scale * 2.2 and size[1] >= _SIZE[1] * scale * 2.2
