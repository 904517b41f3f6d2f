"""Docks keep their share of the window when it changes its size.

The library keeps the pixels of all docks but the central one, which gets what is left: in a window of 640x400 nothing
would be left for the viewer.
"""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import ImVec2, imgui

_DOCKS = ("Right", "RightLower", "Side", "Lower", "MainDockSpace")


class DockShares:
    """Scales the docks with the window; `find_id` gives the id of a dock by its name."""

    def __init__(self, find_id: Callable[[str], int | None]) -> None:
        self._find_id = find_id
        self._size: tuple[float, float] | None = None

    def follow_window(self) -> None:
        """Scale the docks if the window has another size than in the last frame."""
        view = imgui.get_main_viewport().size
        before, self._size = self._size, (view.x, view.y)
        if before is None or before == self._size or min(*before, *self._size) < 1.0:
            return
        across, down = view.x / before[0], view.y / before[1]
        for id, size in self._list_sizes().items():
            imgui.internal.dock_builder_set_node_size(id, ImVec2(size[0] * across, size[1] * down))

    def _list_sizes(self) -> dict[int, tuple[float, float]]:
        """The size of every dock by its id, with those that are split into others."""
        sizes: dict[int, tuple[float, float]] = {}
        for name in _DOCKS:
            id = self._find_id(name)
            node = imgui.internal.dock_builder_get_node(id) if id else None
            while node is not None and node.id_ not in sizes:
                sizes[node.id_] = node.size.x, node.size.y
                node = node.parent_node
        return sizes
