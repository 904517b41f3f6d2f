"""The legend of sockets and mouse controls, behind a question mark in the corner."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import Kind
from imgui_bundle import imgui
from msgspec import Struct

from ...language.translation import mark, translate
from ..theme.style import u32, ui_scale, vec4
from .brush import DrawContext
from .geometry import CanvasTransform, Rect
from .paint_node import paint_pin

if TYPE_CHECKING:
    from .context import CanvasContext

_POPUP = "sockets"
_SIDE, _GAP = 24.0, 12.0

_MOUSE = (
    (mark("Wheel"), mark("zoom")),
    (mark("Middle drag, Space + drag"), mark("pan")),
    (mark("Drag from a socket"), mark("link")),
    (mark("Drop a link on empty canvas"), mark("add a node that fits")),
    (mark("Drop a node on a link"), mark("insert it")),
    (mark("Ctrl + right drag"), mark("cut links")),
    (mark("Shift + right drag"), mark("put dots on links")),
    (mark("Double click"), mark("view a node, enter a group")),
    (mark("Ctrl while dragging"), mark("snap to the grid")),
)


class Legend(Struct):
    """The question mark and its popup."""

    context: CanvasContext

    def find_rect(self, panel: Rect) -> Rect:
        """The rectangle of the question mark."""
        scale = ui_scale()
        left, bottom = panel[0] + _GAP * scale, panel[3] - _GAP * scale
        return left, bottom - _SIDE * scale, left + _SIDE * scale, bottom

    def draw(self, brush: DrawContext, panel: Rect) -> None:
        """Draw the question mark, and the popup if it is open."""
        rect, palette, scale = self.find_rect(panel), self.context.palette, ui_scale()
        imgui.set_cursor_screen_pos(rect[:2])
        imgui.set_next_item_allow_overlap()
        imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)
        pressed = imgui.invisible_button("##legend", (rect[2] - rect[0], rect[3] - rect[1]))
        imgui.pop_item_flag()
        hovered = imgui.is_item_hovered()
        center = (rect[0] + rect[2]) / 2, (rect[1] + rect[3]) / 2
        brush.draw.add_circle_filled(center, _SIDE / 2 * scale, u32(palette.hover if hovered else palette.panel, 0.9))
        size = imgui.calc_text_size("?")
        brush.draw.add_text((center[0] - size.x / 2, center[1] - size.y / 2), u32(palette.dim), "?")
        self.context.places["legend"] = rect
        if pressed:
            imgui.open_popup(_POPUP)
        imgui.set_next_window_pos((rect[0], rect[1] - 6 * scale), imgui.Cond_.appearing, (0.0, 1.0))
        if imgui.begin_popup(_POPUP):
            self._draw_contents(brush)
            imgui.end_popup()

    def _draw_contents(self, brush: DrawContext) -> None:
        scale, line = ui_scale(), imgui.get_text_line_height()
        draw = imgui.get_window_draw_list()
        first = (18 + 24) * scale + max(imgui.calc_text_size(translate(kind, "kind")).x for kind in Kind)
        second = 24 * scale + max(imgui.calc_text_size(translate(key)).x for key, _ in _MOUSE)
        for kind, meaning in ((kind, kind.facts.doc) for kind in Kind):
            corner = imgui.get_cursor_screen_pos()
            at = corner.x + 8 * scale, corner.y + line / 2
            popup = DrawContext(
                draw, CanvasTransform(0, 0, scale), 1.0, brush.ink, brush.fonts, brush.texts, brush.visible
            )
            paint_pin(popup, at[0] / scale, at[1] / scale, kind, brush.ink.kinds[kind])
            imgui.dummy((18 * scale, line))
            imgui.same_line()
            imgui.text(translate(kind, "kind"))
            imgui.same_line(first)
            imgui.text_colored(vec4(self.context.palette.dim), translate(meaning))
        imgui.separator()
        for key, act in _MOUSE:
            imgui.text(translate(key))
            imgui.same_line(second)
            imgui.text_colored(vec4(self.context.palette.dim), translate(act))
