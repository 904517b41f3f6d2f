"""What all panels and dialogs draw alike."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ..editor import Editor
from ..log import Level
from ..theme.palette import RGB
from ..theme.style import EM, mix, u32, ui_scale, vec4

FIXED = (
    int(imgui.WindowFlags_.no_docking) | int(imgui.WindowFlags_.no_saved_settings) | int(imgui.WindowFlags_.no_move)
    | int(imgui.WindowFlags_.no_collapse) | int(imgui.WindowFlags_.no_resize)
)

ICONS: dict[Level, str] = {
    "info": icons.ICON_FA_CIRCLE_INFO, "warning": icons.ICON_FA_TRIANGLE_EXCLAMATION,
    "error": icons.ICON_FA_CIRCLE_XMARK,
}


def level_color(editor: Editor, level: Level) -> RGB:
    """The color of a sentence's icon."""
    palette = editor.palette
    return {"info": palette.dim, "warning": palette.warning, "error": palette.error}[level]


def record(editor: Editor, name: str) -> None:
    """Note where the last item was drawn."""
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    editor.places[name] = (low.x, low.y, high.x, high.y)


@contextmanager
def font(editor: Editor, name: Literal["text", "bold", "mono"], size: float = EM) -> Iterator[None]:
    """Text in another font; `size` in pixels at scale 1."""
    imgui.push_font(getattr(editor.fonts, name, None), size)
    yield
    imgui.pop_font()


def dim(editor: Editor, text: str) -> None:
    """Text of less weight."""
    imgui.text_colored(vec4(editor.palette.dim), text)


def wrapped(color: RGB, text: str) -> None:
    """Text in a color, as many lines as it needs."""
    imgui.push_style_color(imgui.Col_.text, vec4(color))
    imgui.text_wrapped(text)
    imgui.pop_style_color()


def nothing_here(editor: Editor, icon: str, title: str, sentence: str) -> None:
    """What an empty panel says, in its middle."""
    room, scale = imgui.get_content_region_avail(), ui_scale()
    width = max(min(room.x, 320 * scale), 1.0)
    size = imgui.calc_text_size(sentence, wrap_width=width)
    height = size.y + 56 * scale
    left, top = imgui.get_cursor_pos_x(), imgui.get_cursor_pos_y() + max((room.y - height) * 0.4, 0.0)
    imgui.set_cursor_pos_y(top)
    for text, base, color in ((icon, 22.0, mix(editor.palette.dim, editor.palette.panel, 0.35)),
                              (title, EM, editor.palette.text)):
        with font(editor, "bold", base):
            imgui.set_cursor_pos_x(left + max((room.x - imgui.calc_text_size(text).x) / 2, 0.0))
            imgui.text_colored(vec4(color), text)
    imgui.set_cursor_pos_x(left + max((room.x - min(size.x, width)) / 2, 0.0))
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + min(size.x, width) + scale)
    imgui.text_colored(vec4(editor.palette.dim), sentence)
    imgui.pop_text_wrap_pos()


def elided(text: str, width: float) -> str:
    """`text`, or its two ends if it is wider than `width` pixels."""
    if imgui.calc_text_size(text).x <= width:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if imgui.calc_text_size(_ends(text, middle)).x <= width else (low, middle - 1)
    return _ends(text, low)


def _ends(text: str, kept: int) -> str:
    tail = kept - kept // 2
    return f"{text[: kept // 2]}...{text[len(text) - tail :] if tail else ''}"


def icon_button(editor: Editor, icon: str, name: str, tip: str, *, enabled: bool = True, label: str = "") -> bool:
    """A quiet button; `name` is its place, `tip` says what it does."""
    imgui.push_style_color(imgui.Col_.button, vec4(editor.palette.panel, 0.0))
    imgui.begin_disabled(not enabled)
    clicked = imgui.button(f"{icon} {label}##{name}" if label else f"{icon}##{name}")
    imgui.end_disabled()
    imgui.pop_style_color()
    imgui.set_item_tooltip(tip)
    record(editor, name)
    return clicked


def main_button(editor: Editor, label: str, name: str, *, width: float = 0.0, enabled: bool = True) -> bool:
    """The button that most people want."""
    palette = editor.palette
    for color, lit in ((imgui.Col_.button, 0.0), (imgui.Col_.button_hovered, 0.12), (imgui.Col_.button_active, 0.25)):
        imgui.push_style_color(color, vec4(mix(palette.accent, palette.text, lit)))
    imgui.push_style_color(imgui.Col_.text, vec4(palette.on_accent))
    imgui.begin_disabled(not enabled)
    clicked = imgui.button(f"{label}##{name}", ImVec2(width, 0))
    imgui.end_disabled()
    imgui.pop_style_color(4)
    record(editor, name)
    return clicked


def right_aligned(*labels: str) -> None:
    """Move to where buttons of these labels end at the right border: on the same line, if they fit there."""
    style = imgui.get_style()
    width = sum(imgui.calc_text_size(label).x + 2 * style.frame_padding.x for label in labels)
    width += style.item_spacing.x * (len(labels) - 1)
    imgui.same_line()
    if imgui.get_content_region_avail().x < width:
        imgui.new_line()
    room = max(imgui.get_content_region_avail().x - width, 0.0)
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + room)


def backdrop(editor: Editor, name: str, opacity: float = 0.45) -> bool:
    """Cover everything below a dialog, so that nothing else can be clicked; True if it was clicked itself."""
    view = imgui.get_main_viewport()
    imgui.set_next_window_pos(view.pos)
    imgui.set_next_window_size(view.size)
    imgui.push_style_color(imgui.Col_.window_bg, vec4(editor.palette.shadow, opacity))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    still = int(imgui.WindowFlags_.no_decoration) | int(imgui.WindowFlags_.no_nav)
    imgui.begin(f"##behind {name}", None, FIXED | still | int(imgui.WindowFlags_.no_bring_to_front_on_focus))
    _to_front()
    clicked = imgui.is_window_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.left)
    imgui.end()
    imgui.pop_style_var(2)
    imgui.pop_style_color()
    return clicked


@contextmanager
def dialog(
    editor: Editor, title: str, size: tuple[float, float], *, top: float = 0.5, bare: bool = False, flags: int = 0,
) -> Iterator[None]:
    """A window over everything; `size` in pixels at scale 1, a height of 0 is what it needs.

    It is centered, `top` says how far down, and never larger than the main window.
    """
    view, scale = imgui.get_main_viewport(), ui_scale()
    width = min(size[0] * scale, view.size.x - 16 * scale)
    height = min(size[1] * scale, view.size.y - 16 * scale)
    imgui.set_next_window_pos(
        ImVec2(view.pos.x + view.size.x / 2, view.pos.y + view.size.y * top), imgui.Cond_.always.value, ImVec2(0.5, top)
    )
    if height:
        imgui.set_next_window_size(ImVec2(width, height))
    else:
        limit = ImVec2(width, view.size.y - 16 * scale)
        imgui.set_next_window_size_constraints(ImVec2(width, 0), limit)
        flags |= int(imgui.WindowFlags_.always_auto_resize)
    if bare:
        flags |= int(imgui.WindowFlags_.no_title_bar)
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(16 * scale, 14 * scale))
    imgui.begin(f"{title}###{title}", None, FIXED | flags)
    imgui.pop_style_var()
    if imgui.is_window_appearing():
        imgui.set_window_focus()
    _to_front()
    yield
    corner, extent = imgui.get_window_pos(), imgui.get_window_size()
    editor.places[f"dialog {title}"] = (corner.x, corner.y, corner.x + extent.x, corner.y + extent.y)
    imgui.end()


def escaped() -> bool:
    """True if Escape was pressed in this dialog, with nothing else open in it."""
    inside = imgui.is_window_focused(imgui.FocusedFlags_.root_and_child_windows.value)
    return inside and imgui.is_key_pressed(imgui.Key.escape, False)


def _to_front() -> None:
    if not imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup)):
        imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())


def outline(editor: Editor, color: RGB, thickness: float = 2.0) -> None:
    """Draw a border around the last item."""
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    radius = imgui.get_style().frame_rounding
    imgui.get_window_draw_list().add_rect(low, high, u32(color), radius, thickness * ui_scale())
