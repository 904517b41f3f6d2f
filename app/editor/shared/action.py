"""What an action is, and how actions are found."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from ...authoring.log import Log

Scope = Literal["", "graph", "viewer", "animation"]
"""Where a shortcut works: everywhere, or while the mouse is over that panel."""

Act = Callable[[Any], object]
Ask = Callable[[Any], bool]
"""What an action does with its context, and a question about that context."""


def always(context: object) -> bool:
    """For what can be done at any time."""
    return True


@dataclass(frozen=True)
class Action:
    """Something the user can do from a menu, by a shortcut, from a context menu or the command palette.

    `menu` is the path in the menu bar, such as `File` or `View/Channels`; without one it is only in the palette.
    `shortcut` is written like `Ctrl+Shift+S`; Ctrl is Command on macOS. `contexts` are the context menus that list it.
    """

    id: str
    label: str
    run: Act
    menu: str = ""
    shortcut: str = ""
    scope: Scope = ""
    enabled: Ask = always
    checked: Ask | None = None
    contexts: frozenset[str] = frozenset()
    doc: str = ""
    separated: bool = False
    """True draws a line above it in menus."""
    repeats: bool = False
    """True does it again and again while its keys are held."""


class Actions:
    """The table of actions with the user's own shortcuts, each action with the context that it works on.

    `overrides` gives the user's shortcuts by action id, "" for none at all. Contexts are bound after they are made,
    since panels, which are part of them, run actions themselves.
    """

    def __init__(self, all: tuple[Action, ...], overrides: Callable[[], Mapping[str, str]], log: Log) -> None:
        self.all = all
        self.overrides = overrides
        self._log = log
        self._contexts: dict[str, object] = {}

    def __getitem__(self, id: str) -> Action:
        return next(action for action in self.all if action.id == id)

    def bind(self, actions: Iterable[Action], context: object) -> None:
        """Let actions work on a context."""
        self._contexts.update((action.id, context) for action in actions)

    def shortcut(self, id: str) -> str:
        """The shortcut that is in force."""
        return self.overrides().get(id, self[id].shortcut)

    def in_menu(self, name: str) -> Iterator[Action]:
        """The actions of a context menu."""
        return (action for action in self.all if name in action.contexts)

    def is_enabled(self, action: Action) -> bool:
        """True if it can be done now."""
        return action.enabled(self._contexts[action.id])

    def is_checked(self, action: Action) -> bool:
        """True if it is a switch that is on."""
        return action.checked is not None and action.checked(self._contexts[action.id])

    def run(self, id: str) -> None:
        """Do it, if it can be done now."""
        action = self[id]
        if self.is_enabled(action):
            self._log.attempt(lambda: action.run(self._contexts[id]))

    def conflicts(self, id: str, shortcut: str) -> tuple[Action, ...]:
        """Other actions that this shortcut would set off too."""
        scope = self[id].scope
        return tuple(
            action
            for action in self.all
            if action.id != id
            and shortcut
            and self.shortcut(action.id) == shortcut
            and (not scope or not action.scope or scope == action.scope)
        )
