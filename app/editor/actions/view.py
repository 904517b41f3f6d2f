"""Actions on the window: display settings and help."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from ...graph import Unknown
from ...language.translation import mark
from ..shared.action import Action
from ..shared.window_commands import LayoutName, PanelTitle
from ..theme.style import ui_scale

if TYPE_CHECKING:
    from .context import ViewSettingsContext


def _toggle(name: str) -> Callable[[ViewSettingsContext], object]:
    def toggle(context: ViewSettingsContext) -> None:
        context.store.change(**{name: not getattr(context.store.current, name)})

    return toggle


def _is_shown(name: str) -> Callable[[ViewSettingsContext], bool]:
    return lambda context: bool(getattr(context.store.current, name))


def _has_active_node(context: ViewSettingsContext) -> bool:
    item = context.session.graph.nodes.get(context.session.active)
    return item is not None and not isinstance(item, Unknown)


def _open_page(context: ViewSettingsContext) -> None:
    """Open the page of the selected node, unless the pointer is over a panel that is not about nodes."""
    dialogs, panel = context.dialogs, context.interface.pointed_panel
    if _has_active_node(context) and panel in (None, PanelTitle.GRAPH, PanelTitle.INSPECTOR, PanelTitle.VIEWER):
        dialogs.open.add("node")
    else:
        dialogs.page = panel or PanelTitle.GRAPH
        dialogs.open.add("panel")


def _make_theme(theme: str, label: str) -> Action[ViewSettingsContext]:
    return Action(
        f"view.theme.{theme}",
        label,
        lambda context: context.store.change(theme=theme),
        "View/Theme",
        checked=lambda context: context.store.current.theme == theme,
        separated=theme == "dark",
    )


def _scale(step: float) -> Callable[[ViewSettingsContext], object]:
    def scale(context: ViewSettingsContext) -> None:
        context.store.change(ui_scale=min(max(round(ui_scale() + step, 2), 0.75), 3.0))

    return scale


def _show_panel(context: ViewSettingsContext, title: PanelTitle) -> None:
    context.commands.show_panel(title)


def _apply_layout(context: ViewSettingsContext, name: LayoutName) -> None:
    context.commands.apply_layout(name)


_THEMES: tuple[tuple[str, str], ...] = (
    ("dark", mark("Dark Theme")),
    ("light", mark("Light Theme")),
    ("contrast", mark("High Contrast Theme")),
)
_LAYOUTS: tuple[tuple[LayoutName, str, str, str], ...] = (
    ("composite", "Composite", "Ctrl+F1", "to build a graph, which is below the viewer; these are their first places"),
    ("beside", "Composite, Graph Beside", "Ctrl+F2", "to build a graph beside the viewer, on a wide display"),
    ("code", "Code", "Ctrl+F3", "to write GLSL"),
    ("animate", "Animate", "Ctrl+F4", "to set keys"),
    ("review", "Review", "Ctrl+F5", "to look at pictures and renders"),
)

_PANELS: tuple[tuple[PanelTitle, str], ...] = (
    (PanelTitle.VIEWER, mark("Show Viewer")),
    (PanelTitle.GRAPH, mark("Show Graph")),
    (PanelTitle.ANIMATION, mark("Show Animation")),
    (PanelTitle.CODE, mark("Show Code")),
    (PanelTitle.PROBLEMS, mark("Show Problems")),
    (PanelTitle.RENDERS, mark("Show Renders")),
    (PanelTitle.LOG, mark("Show Log")),
    (PanelTitle.INSPECTOR, mark("Show Inspector")),
    (PanelTitle.SCOPES, mark("Show Scopes")),
    (PanelTitle.HISTORY, mark("Show History")),
    (PanelTitle.PASSES, mark("Show Passes")),
)
"""What the command palette calls the panels; the menu has a list of them with marks."""

VIEW: tuple[Action[ViewSettingsContext], ...] = (
    Action(
        "view.thumbnails", "Thumbnails", _toggle("thumbnails"), "View", "T", "graph", checked=_is_shown("thumbnails")
    ),
    Action(
        "view.timings", "Time and Memory", _toggle("timings"), "View", "Shift+T", "graph", checked=_is_shown("timings")
    ),
    Action("view.minimap", "Overview", _toggle("minimap"), "View", checked=_is_shown("minimap")),
    *(_make_theme(theme, label) for theme, label in _THEMES),
    Action("view.larger", "Larger Interface", _scale(0.25), "View", "Ctrl+Equal"),
    Action("view.smaller", "Smaller Interface", _scale(-0.25), "View", "Ctrl+Minus"),
    Action(
        "view.maximize",
        "Maximize Panel",
        lambda context: context.commands.maximize_pointed(),
        "View",
        "Ctrl+Space",
        doc="Let the panel under the pointer fill the window, or show the other panels again.",
        separated=True,
    ),
    Action(
        "view.full_screen",
        "Full Screen Viewer",
        lambda context: context.commands.toggle_full_screen(),
        "View",
        "Ctrl+F11",
        doc="Let the viewer fill the screen, without menus, or go back to the window.",
    ),
    Action(
        "view.maximize_viewer",
        "Maximize Viewer",
        lambda context: context.commands.maximize(PanelTitle.VIEWER),
        "View",
        "F11",
        doc="Let the viewer fill the window, or show the other panels again.",
    ),
    Action(
        "view.maximize_graph",
        "Maximize Graph",
        lambda context: context.commands.maximize(PanelTitle.GRAPH),
        "View",
        "Shift+F11",
        doc="Let the graph fill the window, or show the other panels again.",
    ),
    Action(
        "view.reset_layout",
        "Reset Panels",
        lambda context: context.commands.apply_layout("composite"),
        "View",
        separated=True,
    ),
    *(
        Action(
            f"view.layout.{name}",
            label,
            partial(_apply_layout, name=name),
            "View/Layout",
            keys,
            doc=f"Move all panels to where they serve best {purpose}.",
        )
        for name, label, keys, purpose in _LAYOUTS
    ),
    *(
        Action(
            f"view.panel.{title.lower()}",
            label,
            partial(_show_panel, title=title),
            doc="Show this panel, in front of those in the same place.",
        )
        for title, label in _PANELS
    ),
    Action("view.screenshot", "Save a Screenshot...", lambda context: context.commands.save_screenshot(), "View"),
    Action("help.palette", "Command Palette...", lambda context: context.dialogs.open.add("palette"), "Help", "Ctrl+P"),
    Action(
        "help.manual",
        "Manual Page",
        _open_page,
        "Help",
        "F1",
        doc="What the selected node does, with all of its sockets and values, or what the panel under the pointer is "
        "for, with all of its actions.",
    ),
    Action("help.shortcuts", "Shortcuts", lambda context: context.dialogs.toggle("shortcuts"), "Help", "Shift+F1"),
    Action("help.about", "About Halation", lambda context: context.dialogs.open.add("about"), "Help"),
)
