"""The menu bar, made from the table of actions."""

from __future__ import annotations

from imgui_bundle import imgui
from msgspec import Struct, field

from ..actions import MENUS
from ..shared.action import Action, ListedAction
from ..shared.window_commands import PanelTitle
from ..toolkit.buttons import ActionSurface, entry
from ..toolkit.labels import translate_label


class _Menu(Struct):
    """Actions and submenus in the order in which they appear."""

    entries: dict[str, ListedAction | _Menu] = field(default_factory=dict)


class MenuBar:
    """The menus, arranged once for each table of actions."""

    def __init__(self) -> None:
        self._actions: tuple[ListedAction, ...] | None = None
        self._menus: dict[str, _Menu] = {}

    def draw(self, context: ActionSurface, panels: dict[PanelTitle, bool]) -> None:
        """Draw all menus; `panels` says by title which are visible, and is changed by the View menu."""
        if self._actions is not context.actions.all:
            self._actions = context.actions.all
            self._menus = arrange_menus(self._actions)
        for name, menu in self._menus.items():
            if imgui.begin_menu(translate_label(name, "menu")):
                draw_menu(context, menu)
                if name == "View":
                    imgui.separator()
                    for title, visible in panels.items():
                        clicked, _ = imgui.menu_item(translate_label(title), "", visible)
                        if clicked:
                            panels[title] = not visible
                imgui.end_menu()


def arrange_menus(actions: tuple[ListedAction, ...]) -> dict[str, _Menu]:
    """The menus of the menu bar by title, with what each holds in order."""
    menus = {name: _Menu() for name in MENUS}
    for action in actions:
        top, *inner = action.menu.split("/") if action.menu else [""]
        if not top:
            continue
        menu = menus.setdefault(top, _Menu())
        for name in inner:
            deeper = menu.entries.setdefault(name, _Menu())
            assert isinstance(deeper, _Menu)
            menu = deeper
        menu.entries[action.label] = action
    return menus


def draw_menu(context: ActionSurface, menu: _Menu) -> None:
    """Draw the entries of an open menu, and the menus inside of it."""
    for name, item in menu.entries.items():
        if isinstance(item, _Menu):
            first = next(iter(item.entries.values()), None)
            if isinstance(first, Action) and first.separated:
                imgui.separator()
            if imgui.begin_menu(translate_label(name, "menu")):
                draw_menu(context, item)
                imgui.end_menu()
            continue
        if item.separated and name != next(iter(menu.entries)):
            imgui.separator()
        entry(context, item)
