"""Layouts: where panels are, by what the user does. A layout is applied on demand; then panels are the user's own."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from imgui_bundle import hello_imgui, imgui
from msgspec import Struct

from ..shared.window_commands import LayoutName, PanelTitle
from ..toolkit.labels import make_label
from .panels import DOCKED

MAIN = "MainDockSpace"

_NODE = int(imgui.internal.DockNodeFlagsPrivate_.no_close_button.value)
"""Tabs can be closed, not whole docks."""


class DockLayout(Struct, frozen=True):
    """How the window is split into docks, and which panels are in which dock."""

    splits: tuple[tuple[str, str, imgui.Dir, float], ...]
    """The dock that is split, the new dock, its side, and its share of the width or the height."""
    docks: Mapping[PanelTitle, str]
    """The dock of panels that are not in their usual one."""
    hidden: frozenset[PanelTitle] = frozenset()
    front: tuple[PanelTitle, ...] = ()
    """Panels in front of their docks."""

    def find_dock(self, title: PanelTitle, usual: str) -> str:
        """The dock of a panel; the main one if its own does not exist in this layout."""
        names = {MAIN, *(name for _, name, _, _ in self.splits)}
        dock = self.docks.get(title, usual)
        return dock if dock in names else MAIN


_RIGHT = (MAIN, "Right", imgui.Dir.right, 0.25), ("Right", "RightLower", imgui.Dir.down, 0.36)

LAYOUTS: Mapping[LayoutName, DockLayout] = MappingProxyType(
    {
        "composite": DockLayout(
            (*_RIGHT, (MAIN, "Lower", imgui.Dir.down, 0.44)),
            MappingProxyType({}),
            front=(PanelTitle.VIEWER, PanelTitle.GRAPH, PanelTitle.INSPECTOR, PanelTitle.SCOPES),
        ),
        "beside": DockLayout(
            (*_RIGHT, (MAIN, "Lower", imgui.Dir.right, 0.5)),
            MappingProxyType({}),
            front=(PanelTitle.VIEWER, PanelTitle.GRAPH, PanelTitle.INSPECTOR, PanelTitle.SCOPES),
        ),
        "code": DockLayout(
            (
                (MAIN, "Right", imgui.Dir.right, 0.46),
                ("Right", "RightLower", imgui.Dir.down, 0.32),
                (MAIN, "Lower", imgui.Dir.down, 0.42),
            ),
            MappingProxyType(
                {
                    PanelTitle.CODE: "Right",
                    PanelTitle.PROBLEMS: "RightLower",
                    PanelTitle.INSPECTOR: "RightLower",
                    PanelTitle.LOG: "RightLower",
                }
            ),
            frozenset({PanelTitle.SCOPES, PanelTitle.HISTORY}),
            (PanelTitle.VIEWER, PanelTitle.GRAPH, PanelTitle.CODE, PanelTitle.INSPECTOR),
        ),
        "animate": DockLayout(
            (
                (MAIN, "Lower", imgui.Dir.down, 0.42),
                (MAIN, "Right", imgui.Dir.right, 0.26),
                (MAIN, "Side", imgui.Dir.right, 0.42),
            ),
            MappingProxyType({PanelTitle.GRAPH: "Side", PanelTitle.HISTORY: "Right", PanelTitle.PASSES: "Right"}),
            frozenset({PanelTitle.SCOPES}),
            (PanelTitle.VIEWER, PanelTitle.GRAPH, PanelTitle.ANIMATION, PanelTitle.INSPECTOR),
        ),
        "review": DockLayout(
            ((MAIN, "Right", imgui.Dir.right, 0.24), ("Right", "RightLower", imgui.Dir.down, 0.5)),
            MappingProxyType({PanelTitle.SCOPES: "Right", PanelTitle.RENDERS: "RightLower"}),
            frozenset(PanelTitle)
            - {PanelTitle.VIEWER, PanelTitle.SCOPES, PanelTitle.RENDERS, PanelTitle.HISTORY, PanelTitle.INSPECTOR},
            (PanelTitle.VIEWER, PanelTitle.SCOPES, PanelTitle.RENDERS),
        ),
    }
)


def find_panel(params: hello_imgui.RunnerParams, title: PanelTitle) -> hello_imgui.DockableWindow:
    """What the host of the window knows of a panel; its label there is the identity, which no language changes."""
    return params.docking_params.dockable_window_of_name(make_label("", title))


def make_splits(layout: DockLayout) -> list[hello_imgui.DockingSplit]:
    """The splits of a layout, as the host of the window takes them."""
    return [hello_imgui.DockingSplit(*split, _NODE) for split in layout.splits]


def apply_layout(params: hello_imgui.RunnerParams, layout: DockLayout) -> None:
    """Move all panels to their docks in a layout, before the next frame."""
    docking = params.docking_params
    docking.docking_splits = make_splits(layout)
    for docked in DOCKED:
        panel = find_panel(params, docked.title)
        panel.dock_space_name = layout.find_dock(docked.title, docked.dock)
        panel.is_visible = docked.title not in layout.hidden
    docking.layout_reset = True
