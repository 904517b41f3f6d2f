"""Swatches: colors as a display shows them, and those that the user keeps."""

from __future__ import annotations

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...color.primaries import REC709_LUMINANCE
from ...language.translation import translate
from ..theme.palette import RGB
from ..theme.style import u32
from ..toolkit.buttons import quiet_button
from ..toolkit.places import Rect, item_rect, record
from ..toolkit.words import tip
from .colors import RGBA, hexadecimal, swatch
from .fields import Edit, Fields

COLUMNS = 12


def draw_swatches(fields: Fields, id: str, color: RGBA, width: float, alpha: bool = True) -> Edit | None:
    """Draw the colors that the user keeps, and a button that keeps this one; returns the edit of a click on one.

    Without `alpha`, the alpha of the color does not change.
    """
    if fields.store is None:
        return None
    side, gap = imgui.get_frame_height(), (width - COLUMNS * imgui.get_frame_height()) / (COLUMNS - 1)
    swatch_edit, removed_color = None, None
    if quiet_button(fields, icons.ICON_FA_PLUS, f"button keep {id}", translate("Keep this color: all pickers show it")):
        fields.store.add_swatch(color)
    for index, kept_color in enumerate(fields.store.current.swatches):
        if (index + 1) % COLUMNS:
            imgui.same_line(0.0, gap)
        if imgui.invisible_button(f"##{id} swatch {index}", (side, side)):
            swatch_edit = Edit(kept_color if alpha else (*kept_color[:3], color[3]))
        record(fields, f"swatch {id} {index}")
        draw_swatch(fields, item_rect(), kept_color, imgui.is_item_hovered() or imgui.is_item_focused())
        tip(translate("{color}: click to use it. Right click or Delete removes it.", color=hexadecimal(kept_color)))
        is_deleted = imgui.is_item_focused() and imgui.is_key_pressed(imgui.Key.delete)
        if is_deleted or (imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.right)):
            removed_color = kept_color
    if removed_color is not None:
        fields.store.remove_swatch(removed_color)
    return swatch_edit


def draw_swatch(fields: Fields, rect: Rect, color: RGBA, hovered: bool = False) -> None:
    """Draw a color as a display shows it: opaque at the left, over a checkerboard at the right."""
    lines, palette = imgui.get_window_draw_list(), fields.palette
    rounding = imgui.get_style().frame_rounding
    opaque, alpha = u32(swatch(color)), min(max(color[3], 0.0), 1.0)
    lines.add_rect_filled(rect[:2], rect[2:], opaque, rounding)
    if alpha < 1.0:
        middle = (rect[0] + rect[2]) * 0.5
        cell = (rect[3] - rect[1]) / 3.0
        lines.push_clip_rect((middle, rect[1]), rect[2:], True)
        lines.add_rect_filled(rect[:2], rect[2:], u32(palette.raised), rounding)
        for row in range(3):
            for column in range(int((rect[2] - middle) / cell) + 1):
                if (row + column) % 2:
                    x, y = middle + column * cell, rect[1] + row * cell
                    lines.add_rect_filled((x, y), (x + cell, y + cell), u32(palette.dim))
        lines.add_rect_filled(rect[:2], rect[2:], u32(swatch(color), alpha), rounding)
        lines.pop_clip_rect()
    if max(color[:3]) > 1.0:
        _draw_bright_corner(fields, rect, color)
    lines.add_rect(rect[:2], rect[2:], u32(palette.accent if hovered else palette.border), rounding)


def luma(color: RGB) -> float:
    """How bright a display color is, as a rough guide to what is legible on it."""
    return sum(weight * part for weight, part in zip(REC709_LUMINANCE, color, strict=True))


def _draw_bright_corner(fields: Fields, rect: Rect, color: RGBA) -> None:
    """Draw a marked corner: the color is brighter than the display can show."""
    size = (rect[3] - rect[1]) * 0.35
    imgui.get_window_draw_list().add_triangle_filled(
        (rect[0], rect[1]), (rect[0] + size, rect[1]), (rect[0], rect[1] + size), u32(fields.palette.accent)
    )
