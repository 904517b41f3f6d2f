"""The banner of an open flipbook: its strips, and the button back to the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.flipbook import SIDES
from ...language.translation import translate
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.buttons import quiet_button, width_of_buttons
from ..toolkit.words import cut_middle, draw_dim, font, tip

if TYPE_CHECKING:
    from .context import ViewerContext


def draw_banner(context: ViewerContext) -> None:
    """Draw the banner, if a flipbook is open."""
    book = context.stage.flipbook
    if book is None:
        return
    palette, scale = context.palette, ui_scale()
    inner, start = imgui.internal.get_current_window().inner_rect, imgui.get_cursor_screen_pos()
    high = imgui.get_frame_height()
    bottom, color = start.y + high + 3 * scale, u32(mix(palette.panel, palette.accent, 0.16))
    imgui.get_window_draw_list().add_rect_filled((inner.min.x, inner.min.y), (inner.max.x, bottom), color)
    imgui.set_cursor_screen_pos((start.x + 4 * scale, start.y))
    imgui.align_text_to_frame_padding()
    imgui.text_colored(vec4(palette.accent), f"{icons.ICON_FA_FILM} ")
    imgui.same_line(0.0, 2 * scale)
    with font(context, "bold"):
        imgui.text_unformatted(translate("Flipbook"))
    compare = f"{icons.ICON_FA_TABLE_COLUMNS}  {translate('Compare with...')}"
    back = f"{icons.ICON_FA_XMARK}  {translate('Back to the graph')}"
    buttons = (back,) if len(book.strips) > 1 else (compare, back)
    room = (inner.max.x - imgui.get_cursor_screen_pos().x - width_of_buttons(*buttons) - 130 * scale) / len(book.strips)
    colors = {"A": palette.accent, "B": palette.good}
    same = len({strip.name for strip in book.strips}) < len(book.strips)
    for side, strip in zip(SIDES, book.strips, strict=False):
        name = f"{strip.path.parent.name}/{strip.name}" if same else strip.name
        imgui.same_line(0.0, 14 * scale)
        if len(book.strips) > 1:
            imgui.text_colored(vec4(colors[side]), side)
            imgui.same_line(0.0, 5 * scale)
        imgui.text_unformatted(cut_middle(name, room - 30 * scale))
        tip(str(strip.path))
        if strip.export is not None and strip.export.state in ("running", "waiting"):
            imgui.same_line(0.0, 6 * scale)
            draw_dim(context, translate("{done} of {total}", done=strip.export.done, total=strip.export.total))
    imgui.same_line(0.0, 0.0)
    imgui.set_cursor_screen_pos((inner.max.x - width_of_buttons(*buttons) - 4 * scale, start.y))
    if len(book.strips) == 1:
        if quiet_button(context, compare, "compare flipbook", translate("Play other pictures beside these")):
            context.actions.run("flipbook.compare")
        imgui.same_line()
    doc = translate("The viewer and the timeline show the document again")
    if quiet_button(context, back, "close flipbook", doc):
        context.actions.run("flipbook.close")
    imgui.set_cursor_screen_pos((start.x, bottom + 3 * scale))
