"""Fields for settings that are no values of a graph."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from imgui_bundle import imgui

from ..theme.palette import Palette
from ..theme.style import mix, u32, ui_scale, vec4
from .labels import make_label
from .places import Rect, WidgetSurface, record
from .words import tip


def keep_typing() -> None:
    """Give the next field the keyboard whenever nothing else has it: Enter leaves a field, and a search goes on."""
    if not imgui.is_any_item_active():
        imgui.set_keyboard_focus_here()


def background(
    palette: Palette, rect: Rect, *, hovered: bool = False, active: bool = False, fault: bool = False
) -> None:
    """Draw the box of a field."""
    color = mix(palette.field, palette.hover, 0.6 if active else 0.35 if hovered else 0.0)
    lines, rounding = imgui.get_window_draw_list(), imgui.get_style().frame_rounding
    lines.add_rect_filled(rect[:2], rect[2:], u32(color), rounding)
    if fault:
        lines.add_rect(rect[:2], rect[2:], u32(palette.error), rounding)


def draw_arrow(palette: Palette, rect: Rect) -> None:
    """Draw the arrow at the right of a field that opens a list."""
    size = (rect[3] - rect[1]) * 0.14
    x, y = rect[2] - imgui.get_style().frame_padding.x - size * 1.5, (rect[1] + rect[3]) * 0.5
    imgui.get_window_draw_list().add_triangle_filled(
        (x - size * 1.4, y - size * 0.7), (x + size * 1.4, y - size * 0.7), (x, y + size), u32(palette.dim)
    )


def measure_labels(texts: Iterable[str], least: float) -> float:
    """The width of a column that holds these names, in units; at least `least`."""
    widths = (imgui.calc_text_size(text).x + 2 * imgui.get_style().item_spacing.x for text in texts)
    return max(max(widths, default=0.0) / ui_scale(), least)


def label(text: str, width: float) -> None:
    """Draw a name at the left of a field, which begins `width` units further right, or behind a longer name."""
    left = imgui.get_cursor_pos_x()
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(text)
    imgui.same_line()
    imgui.set_cursor_pos_x(max(left + width * ui_scale(), imgui.get_cursor_pos_x()))


def combo(
    surface: WidgetSurface,
    name: str,
    current: str,
    choices: Sequence[str],
    width: float = -1.0,
    *,
    show: Callable[[str], str] = str,
) -> str:
    """Draw a list of texts, each as `show` writes it; returns what was chosen in this frame, or ""."""
    imgui.set_next_item_width(width)
    chosen = ""
    flags = int(imgui.ComboFlags_.no_arrow_button) | int(imgui.ComboFlags_.height_large)
    opened = imgui.begin_combo(f"##{name}", show(current), flags)
    if opened:
        for choice in choices:
            if imgui.selectable(make_label(show(choice), choice), choice == current)[0]:
                chosen = choice
            record(surface, f"{name} {choice}")
        imgui.end_combo()
    record(surface, name)
    draw_arrow(surface.palette, surface.places[name])
    return chosen


def number(
    surface: WidgetSurface,
    name: str,
    value: float,
    form: str,
    width: float,
    doc: str,
    *,
    neutral: float | None = None,
    speed: float = 0.01,
    low: float = 0.0,
    high: float = 0.0,
) -> float:
    """Draw a number that is dragged or typed; in the error color unless it is neutral, which a right click makes it."""
    changed = neutral is not None and value != neutral
    if changed:
        imgui.push_style_color(imgui.Col_.text, vec4(surface.palette.error))
    imgui.set_next_item_width(width)
    edited, dragged = imgui.drag_float(f"##{name}", value, speed, low, high, form)
    value = dragged if edited else value  # what is not edited would lose digits
    record(surface, f"field {name}")
    if changed:
        imgui.pop_style_color()
    tip(doc)
    if neutral is not None and imgui.is_item_clicked(imgui.MouseButton_.right):
        value = neutral
    return value
