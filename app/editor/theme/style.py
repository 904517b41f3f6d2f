"""Sets Dear ImGui's style from a palette."""

from __future__ import annotations

from functools import lru_cache

from imgui_bundle import ImVec2, ImVec4, imgui

from .palette import CONTRAST, RGB, Palette

EM = 16.0
"""Font size in pixels at UI scale 1; canvas units are pixels at that scale."""

UNSCROLLED = int(imgui.WindowFlags_.no_scrollbar) | int(imgui.WindowFlags_.no_scroll_with_mouse)
"""Flags of a window or a part of one that shows what has room: it has no scrollbar, and the wheel moves nothing."""


@lru_cache(maxsize=4096)
def u32(color: RGB, alpha: float = 1.0) -> int:
    """A color as draw lists take it."""
    red, green, blue = (int(min(max(part, 0.0), 1.0) * 255 + 0.5) for part in color)
    return int(alpha * 255 + 0.5) << 24 | blue << 16 | green << 8 | red


def vec4(color: RGB, alpha: float = 1.0) -> ImVec4:
    """A color as widgets take it."""
    return ImVec4(*color, alpha)


def mix(first: RGB, second: RGB, amount: float) -> RGB:
    """A color between two colors."""
    red, green, blue = (a + (b - a) * amount for a, b in zip(first, second, strict=True))
    return red, green, blue


def ui_scale() -> float:
    """Pixels per canvas unit and per unit of all fixed sizes."""
    return imgui.get_font_size() / EM


def apply(palette: Palette, scale: float) -> None:
    """Give all widgets the colors of `palette` and sizes for `scale`."""
    style = imgui.Style()
    style.window_padding = ImVec2(8, 8)
    style.frame_padding = ImVec2(7, 4)
    style.item_spacing = ImVec2(8, 6)
    style.item_inner_spacing = ImVec2(6, 4)
    style.cell_padding = ImVec2(6, 3)
    style.indent_spacing = 14
    style.scrollbar_size = 12
    style.grab_min_size = 10
    style.window_rounding = 0
    style.child_rounding = 4
    style.frame_rounding = 4
    style.popup_rounding = 6
    style.grab_rounding = 3
    style.tab_rounding = 4
    style.scrollbar_rounding = 6
    style.window_border_size = 1
    style.frame_border_size = 0
    style.popup_border_size = 1
    style.tab_border_size = 0
    style.docking_separator_size = 2
    style.window_menu_button_position = imgui.Dir.none
    style.window_title_align = ImVec2(0.5, 0.5)
    style.disabled_alpha = 0.45
    if palette.name == CONTRAST.name:
        style.frame_border_size = style.tab_border_size = 1
        style.disabled_alpha = 0.6
    style.scale_all_sizes(scale)
    style.font_size_base = EM
    style.font_scale_main = scale
    for name, color, alpha in (*_list_window_colors(palette), *_list_widget_colors(palette)):
        style.set_color_(getattr(imgui.Col_, name), vec4(color, alpha))
    _assign(style)


def measure_style() -> tuple[float, ...]:
    """Sizes of the current style that show whether its scale has changed."""
    live = imgui.get_style()
    return live.frame_padding.x, live.window_padding.x, live.font_scale_main, live.font_scale_dpi


def _assign(style: imgui.Style) -> None:
    """Copy a style into the current one, which cannot be replaced."""
    live = imgui.get_style()
    for name in dir(style):
        if name.startswith("_") or callable(getattr(style, name)) or name in ("colors", "main_scale"):
            continue
        setattr(live, name, getattr(style, name))
    for index in range(int(imgui.Col_.count)):
        live.set_color_(index, style.color_(index))


def _list_window_colors(p: Palette) -> list[tuple[str, RGB, float]]:
    """The colors and opacities of windows, tabs, tables and what lies between them."""
    return [
        ("text", p.text, 1),
        ("window_bg", p.panel, 1),
        ("child_bg", p.panel, 0),
        ("popup_bg", mix(p.panel, p.raised, 0.25), 1),
        ("border", p.border, 1),
        ("border_shadow", p.border, 0),
        ("title_bg", p.window, 1),
        ("title_bg_active", p.window, 1),
        ("title_bg_collapsed", p.window, 1),
        ("menu_bar_bg", p.window, 1),
        ("scrollbar_bg", p.panel, 0),
        ("scrollbar_grab", p.raised, 1),
        ("scrollbar_grab_hovered", p.hover, 1),
        ("scrollbar_grab_active", p.accent, 1),
        ("separator", p.raised, 1),
        ("separator_hovered", p.accent, 0.7),
        ("separator_active", p.accent, 1),
        ("resize_grip", p.raised, 0.4),
        ("resize_grip_hovered", p.accent, 0.7),
        ("resize_grip_active", p.accent, 1),
        ("tab", p.window, 1),
        ("tab_hovered", p.hover, 1),
        ("tab_selected", p.panel, 1),
        ("tab_selected_overline", p.accent, 1),
        ("tab_dimmed", p.window, 1),
        ("tab_dimmed_selected", p.panel, 1),
        ("tab_dimmed_selected_overline", p.accent, 0),
        ("docking_preview", p.accent, 0.5),
        ("docking_empty_bg", p.window, 1),
        ("table_header_bg", p.raised, 1),
        ("table_border_strong", p.border, 1),
        ("table_border_light", p.border, 0.6),
        ("table_row_bg", p.panel, 0),
        ("table_row_bg_alt", p.text, 0.03),
        ("tree_lines", p.raised, 1),
        ("nav_cursor", p.accent, 1 if p.name == CONTRAST.name else 0.8),
        ("nav_windowing_highlight", p.text, 0.7),
        ("nav_windowing_dim_bg", p.shadow, 0.4),
        ("modal_window_dim_bg", p.shadow, 0.5),
        ("unsaved_marker", p.accent, 1),
    ]


def _list_widget_colors(p: Palette) -> list[tuple[str, RGB, float]]:
    """The colors and opacities of fields, buttons, selections and plots."""
    return [
        ("text_disabled", p.dim, 1),
        ("frame_bg", p.field, 1),
        ("frame_bg_hovered", mix(p.field, p.hover, 0.6), 1),
        ("frame_bg_active", p.hover, 1),
        ("check_mark", p.accent, 1),
        ("slider_grab", p.fill, 1),
        ("slider_grab_active", mix(p.fill, p.accent, 0.5), 1),
        ("button", p.raised, 1),
        ("button_hovered", p.hover, 1),
        ("button_active", mix(p.hover, p.accent, 0.5), 1),
        ("header", p.raised, 1),
        ("header_hovered", p.hover, 1),
        ("header_active", mix(p.hover, p.accent, 0.4), 1),
        ("input_text_cursor", p.text, 1),
        ("plot_lines", p.text, 1),
        ("plot_lines_hovered", p.accent, 1),
        ("plot_histogram", p.accent, 1),
        ("plot_histogram_hovered", p.accent, 1),
        ("text_link", p.accent, 1),
        ("text_selected_bg", p.accent, 0.35),
        ("drag_drop_target", p.accent, 1),
        ("drag_drop_target_bg", p.accent, 0.1),
        ("checkbox_selected_bg", p.field, 1),
    ]
