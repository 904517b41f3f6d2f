"""A panel as large as the window, the window as large as the screen, and the panel under the pointer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from imgui_bundle import glfw_utils, hello_imgui, imgui

import glfw  # isort: skip

from ..shared.window_commands import PanelTitle
from ..toolkit.places import Rect


class FullScreen:
    """Switches between the window and the screen that it lies on, where menus and the status bar are hidden."""

    def __init__(self, params: hello_imgui.RunnerParams) -> None:
        self._params = params
        self._window: tuple[int, int, int, int] | None = None
        """Place and size of the window while it fills the screen."""

    def toggle(self) -> bool:
        """Switch; True if the window fills the screen from now on."""
        host: Any = glfw_utils.glfw_window_hello_imgui()  # pyright: ignore[reportUnknownMemberType]
        bars = self._params.imgui_window_params
        if self._window is not None:
            glfw.set_window_monitor(host, None, *self._window, 0)  # pyright: ignore
            self._window = None
        else:
            self._window = (*glfw.get_window_pos(host), *glfw.get_window_size(host))  # pyright: ignore
            monitor, (width, height) = _find_monitor(self._window)
            glfw.set_window_monitor(host, monitor, 0, 0, width, height, 0)  # pyright: ignore
        bars.show_menu_bar = bars.show_status_bar = self._window is None
        return self._window is not None


def begin_filling(title: PanelTitle, area: Rect, flags: int) -> bool:
    """Begin a window over all docks that holds a panel; True if it is seen.

    The panel keeps its dock, which would go if it left it: docks that hold nothing are removed.
    """
    imgui.set_next_window_pos(area[:2])
    imgui.set_next_window_size((area[2] - area[0], area[3] - area[1]))
    still = int(imgui.WindowFlags_.no_decoration) & ~int(imgui.WindowFlags_.no_scrollbar)
    still |= int(imgui.WindowFlags_.no_docking) | int(imgui.WindowFlags_.no_move)
    still |= int(imgui.WindowFlags_.no_saved_settings) | int(imgui.WindowFlags_.no_bring_to_front_on_focus)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    is_seen, _ = imgui.begin(f"{title}###{title} fills", None, flags | still)
    imgui.pop_style_var()
    return is_seen


def _find_monitor(window: tuple[int, int, int, int]) -> tuple[Any, tuple[int, int]]:
    """The monitor that holds the middle of a window, else the main one, and its size."""
    x, y = window[0] + window[2] // 2, window[1] + window[3] // 2
    for monitor in glfw.get_monitors():  # pyright: ignore
        left, top = glfw.get_monitor_pos(monitor)  # pyright: ignore
        size = glfw.get_video_mode(monitor).size  # pyright: ignore
        if left <= x < left + size.width and top <= y < top + size.height:
            return monitor, (size.width, size.height)
    monitor = glfw.get_primary_monitor()  # pyright: ignore
    size = glfw.get_video_mode(monitor).size  # pyright: ignore
    return monitor, (size.width, size.height)


def find_pointed_panel(places: Mapping[str, Rect]) -> PanelTitle | None:
    """The panel under the pointer, by the places of the last frame."""
    mouse = imgui.get_io().mouse_pos
    for title in PanelTitle:
        left, top, right, bottom = places.get(title, (0.0, 0.0, 0.0, 0.0))
        if left <= mouse.x < right and top <= mouse.y < bottom:
            return title
    return None
