"""Toasts: new messages in the corner of the window."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui

from ...authoring.log import TOAST_SECONDS, LogEntry
from ..theme.style import ui_scale, vec4
from ..toolkit.dialogs import FIXED
from ..toolkit.words import ICONS, draw_wrapped, level_color

if TYPE_CHECKING:
    from .context import LogContext

_WIDTH, _GAP, _BELOW, _MOST, _FADE = 360.0, 8.0, 34.0, 5, 0.6
_LEAST = 32.0
"""The height of a toast of one line, which is known before the first one is drawn."""
_TOAST = (
    FIXED
    | int(imgui.WindowFlags_.no_decoration)
    | int(imgui.WindowFlags_.always_auto_resize)
    | int(imgui.WindowFlags_.no_nav)
    | int(imgui.WindowFlags_.no_focus_on_appearing)
)


class Toasts:
    """The newest messages, stacked upwards from the bottom right; each fades after a while, or after a click.

    They go to the left where a menu, a search or a dialog would lie below them. If that fills the window, only errors
    are shown: no button is covered, and the log has the rest.
    """

    def __init__(self, context: LogContext) -> None:
        self._context = context
        self._dismissed = frozenset[float]()
        self._height = 0.0
        """That of all of them in the last frame."""

    def draw(self) -> None:
        """Draw the toasts over everything."""
        entries = [entry for entry in self._context.log.toasts() if entry.at not in self._dismissed][-_MOST:]
        self._dismissed &= {entry.at for entry in self._context.log.toasts()}
        view, scale = imgui.get_main_viewport(), ui_scale()
        right, bottom = view.pos.x + view.size.x - 12 * scale, view.pos.y + view.size.y - _BELOW * scale
        room = _WIDTH * scale, max(self._height, _LEAST * scale)
        if entries and self._covers(right - room[0], bottom - room[1], right):
            left = view.pos.x + 12 * scale
            if self._covers(left, bottom - room[1], left + room[0]):
                entries = [entry for entry in entries if entry.level == "error"]
            else:
                right = left + room[0]
        top = bottom
        for index, entry in enumerate(reversed(entries)):
            top -= self._draw_toast(entry, index, ImVec2(right, top)) + _GAP * scale
        self._height = bottom - top

    def _draw_toast(self, entry: LogEntry, index: int, corner: ImVec2) -> float:
        """Draw a toast with its lower right corner at a point; returns its height."""
        scale = ui_scale()
        left = TOAST_SECONDS - self._context.log.age(entry)
        fades = not self._context.interface.store.current.reduced_motion
        opacity = min(max(left / _FADE, 0.05), 1.0) if fades else 1.0
        imgui.set_next_window_pos(corner, imgui.Cond_.always.value, ImVec2(1, 1))
        imgui.set_next_window_size_constraints(ImVec2(_WIDTH * scale, 0), ImVec2(_WIDTH * scale, 400 * scale))
        imgui.push_style_var(imgui.StyleVar_.alpha, opacity)
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 6.0 * scale)
        imgui.push_style_color(imgui.Col_.window_bg, vec4(self._context.palette.raised))
        imgui.begin(f"##toast {entry.at}", None, _TOAST)
        imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
        imgui.text_colored(vec4(level_color(self._context.palette, entry.level)), ICONS[entry.level])
        imgui.same_line()
        imgui.push_text_wrap_pos((_WIDTH - 12) * scale)
        draw_wrapped(self._context.palette.text, entry.sentence)
        imgui.pop_text_wrap_pos()
        if imgui.is_window_hovered():
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand.value)
            if imgui.is_mouse_clicked(imgui.MouseButton_.left):
                self._dismissed |= {entry.at}
        low, extent = imgui.get_window_pos(), imgui.get_window_size()
        self._context.places[f"toast {index}"] = (low.x, low.y, low.x + extent.x, low.y + extent.y)
        imgui.end()
        imgui.pop_style_color()
        imgui.pop_style_var(2)
        return extent.y

    def _covers(self, left: float, top: float, right: float) -> bool:
        """True if an open dialog, menu or search reaches into a strip above the bottom of the window."""
        popups = [popup.window for popup in imgui.get_current_context().open_popup_stack]
        boxes = [
            (low.x, low.x + size.x, low.y + size.y)
            for low, size in ((window.pos, window.size) for window in popups if window is not None)
        ]
        places = self._context.places.items()
        boxes += [(box[0], box[2], box[3]) for name, box in places if name.startswith("dialog ")]
        return any(low < right and high > left and bottom > top for low, high, bottom in boxes)
