"""The breadcrumbs: the path to the open group, one button a step."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...language.translation import translate
from ..theme.style import u32, ui_scale, vec4
from ..toolkit.labels import make_label
from .brush import DrawContext
from .geometry import Rect

if TYPE_CHECKING:
    from .context import CanvasContext


def draw_crumbs(context: CanvasContext, brush: DrawContext, panel: Rect) -> None:
    """Draw the bar at the top, inside groups only."""
    session = context.session
    if not session.place:
        return
    scale, palette = ui_scale(), context.palette
    pad, height = 8.0 * scale, imgui.get_frame_height() + 8.0 * scale
    brush.draw.add_rect_filled(panel[:2], (panel[2], panel[1] + height), u32(palette.panel, 0.94))
    brush.draw.add_line((panel[0], panel[1] + height), (panel[2], panel[1] + height), u32(palette.border))
    context.places["crumbs"] = (*panel[:3], panel[1] + height)
    imgui.set_cursor_screen_pos((panel[0] + pad, panel[1] + 4.0 * scale))
    imgui.push_style_color(imgui.Col_.button, vec4(palette.panel, 0.0))
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (2.0 * scale, 0.0))
    for index, (title, place) in enumerate(session.crumbs):
        if index:
            imgui.same_line()
            imgui.align_text_to_frame_padding()
            imgui.text_disabled(icons.ICON_FA_CHEVRON_RIGHT)
            imgui.same_line()
        is_open = place == session.place
        imgui.push_style_color(imgui.Col_.text, vec4(palette.text if is_open else palette.dim))
        if imgui.button(make_label(title, f"crumb {index}")) and not is_open:
            context.log.attempt(lambda place=place: session.go(place))
        imgui.pop_style_color()
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        context.places[f"crumb {title}"] = low.x, low.y, high.x, high.y
    if session.borrowed:
        imgui.same_line(0.0, 16.0 * scale)
        imgui.align_text_to_frame_padding()
        imgui.text_colored(
            vec4(palette.warning),
            f"{icons.ICON_FA_LOCK}  {translate('from {file}: make it local to edit it here', file=session.borrowed)}",
        )
    imgui.pop_style_var()
    imgui.pop_style_color()
