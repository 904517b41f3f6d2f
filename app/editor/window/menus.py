"""The menu bar, made from the table of actions."""

from __future__ import annotations

from dataclasses import dataclass, field

from imgui_bundle import imgui

from ..actions import MENUS
from ..shared.action import Action
from ..toolkit.buttons import ActionSurface, entry


@dataclass
class _Menu:
    """Actions and submenus in the order in which they appear."""

    entries: dict[str, Action | _Menu] = field(default_factory=dict)


def draw_menus(context: ActionSurface, panels: dict[str, bool]) -> None:
    """Draw all menus; `panels` says by title which are visible, and is changed by the View menu."""
    for name, menu in _menus(context.actions.all).items():
        if imgui.begin_menu(name):
            _draw(context, menu)
            if name == "View":
                imgui.separator()
                for title, visible in panels.items():
                    clicked, _ = imgui.menu_item(title, "", visible)
                    if clicked:
                        panels[title] = not visible
            imgui.end_menu()


def _menus(actions: tuple[Action, ...]) -> dict[str, _Menu]:
    found = {name: _Menu() for name in MENUS}
    for action in actions:
        top, *inner = action.menu.split("/") if action.menu else [""]
        if not top:
            continue
        menu = found.setdefault(top, _Menu())
        for name in inner:
            deeper = menu.entries.setdefault(name, _Menu())
            assert isinstance(deeper, _Menu)
            menu = deeper
        menu.entries[action.label] = action
    return found


def _draw(context: ActionSurface, menu: _Menu) -> None:
    for name, one in menu.entries.items():
        if isinstance(one, _Menu):
            first = next(iter(one.entries.values()), None)
            if isinstance(first, Action) and first.separated:
                imgui.separator()
            if imgui.begin_menu(name):
                _draw(context, one)
                imgui.end_menu()
            continue
        if one.separated and name != next(iter(menu.entries)):
            imgui.separator()
        entry(context, one)
