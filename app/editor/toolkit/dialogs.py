"""Modal dialogs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from imgui_bundle import ImVec2, imgui

from ..theme.style import ui_scale, vec4
from .keys import is_enter_pressed
from .places import WidgetSurface

FIXED = (
    int(imgui.WindowFlags_.no_docking)
    | int(imgui.WindowFlags_.no_saved_settings)
    | int(imgui.WindowFlags_.no_move)
    | int(imgui.WindowFlags_.no_collapse)
    | int(imgui.WindowFlags_.no_resize)
)

_HAD_POPUP = 0x504F5055
"""Under which a dialog notes that something was open in it: "POPU" in ASCII."""


def backdrop(surface: WidgetSurface, name: str, opacity: float = 0.45) -> bool:
    """Cover everything below a dialog, so that nothing else can be clicked; True if the cover was clicked."""
    view = imgui.get_main_viewport()
    imgui.set_next_window_pos(view.pos)
    imgui.set_next_window_size(view.size)
    imgui.push_style_color(imgui.Col_.window_bg, vec4(surface.palette.shadow, opacity))
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    still = int(imgui.WindowFlags_.no_decoration) | int(imgui.WindowFlags_.no_nav)
    imgui.begin(f"##behind {name}", None, FIXED | still | int(imgui.WindowFlags_.no_bring_to_front_on_focus))
    _to_front()
    clicked = imgui.is_window_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.left)
    imgui.end()
    imgui.pop_style_var()
    imgui.pop_style_color()
    return clicked


@contextmanager
def dialog(
    surface: WidgetSurface,
    title: str,
    size: tuple[float, float],
    *,
    top: float = 0.5,
) -> Iterator[None]:
    """A modal dialog; `size` in pixels at scale 1, a height of 0 fits its content.

    It is centered, `top` says how far down, and never larger than the main window.
    """
    view, scale, flags = imgui.get_main_viewport(), ui_scale(), int(imgui.WindowFlags_.no_title_bar)
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
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(16 * scale, 14 * scale))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 8.0 * scale)
    imgui.begin(f"{title}###{title}", None, FIXED | flags)
    imgui.pop_style_var(2)
    if imgui.is_window_appearing() or _is_focus_below():
        imgui.set_window_focus()
    _to_front()
    yield
    corner, extent = imgui.get_window_pos(), imgui.get_window_size()
    surface.places[f"dialog {title}"] = (corner.x, corner.y, corner.x + extent.x, corner.y + extent.y)
    note_lists()
    imgui.end()


def note_lists() -> None:
    """Note at the end of a dialog whether a list is open in it, for `escape_pressed`."""
    imgui.get_state_storage().set_bool(_HAD_POPUP, imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup)))


def enter_pressed() -> bool:
    """True if Enter was pressed for the dialog as a whole: a button in the focus ring takes Enter for itself."""
    ringed = imgui.get_io().nav_visible and imgui.is_any_item_focused()
    return not ringed and takes_enter()


def takes_enter() -> bool:
    """True if Enter was pressed since the dialog is there: the Enter that opened it is of its first frame."""
    return not imgui.is_window_appearing() and is_enter_pressed(repeats=False)


def escape_pressed() -> bool:
    """True if Escape was pressed in this dialog, with nothing else open in it.

    The library closes an open list before a frame begins: what was open in the frame before took the key.
    """
    inside = imgui.is_window_focused(imgui.FocusedFlags_.root_and_child_windows.value)
    had_popup = imgui.get_state_storage().get_bool(_HAD_POPUP)
    return inside and not had_popup and imgui.is_key_pressed(imgui.Key.escape, False)


def _is_focus_below() -> bool:
    """True if what has the focus lies below this dialog: panels and bars that appear at the start take it."""
    focused = imgui.get_current_context().nav_window
    if imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup)):
        return False
    if focused is None:
        return True
    here, there = imgui.internal.get_current_window(), focused.root_window
    return here.id_ != there.id_ and imgui.internal.is_window_above(here, there)


def _to_front() -> None:
    if not imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup)):
        imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
