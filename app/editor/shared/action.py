"""What an action is, and how actions are found."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

Scope = Literal["", "graph", "viewer", "animation"]
"""Where a shortcut works: everywhere, or while the mouse is over that panel."""

Act = Callable[[Any], object]
Ask = Callable[[Any], bool]
"""What is done to, and asked of, the editor."""


def always(editor: object) -> bool:
    """For what can be done at any time."""
    return True


@dataclass(frozen=True)
class Action:
    """Something a person can do from a menu, by a shortcut, from a context menu or the command palette.

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


@dataclass(frozen=True)
class Actions:
    """The table with a person's own shortcuts; `overrides` gives those by action id, "" for none at all."""

    all: tuple[Action, ...]
    overrides: Callable[[], Mapping[str, str]]

    def __getitem__(self, id: str) -> Action:
        return next(action for action in self.all if action.id == id)

    def shortcut(self, id: str) -> str:
        """The shortcut that is in force."""
        return self.overrides().get(id, self[id].shortcut)

    def context(self, name: str) -> Iterator[Action]:
        """The actions of a context menu."""
        return (action for action in self.all if name in action.contexts)

    def run(self, id: str, editor: Any) -> None:
        """Do it, if it can be done now. What is seen and played may be a flipbook, not the document."""
        action = self[id]
        editor = getattr(editor, "stage", editor) if id.startswith(("viewer.", "time.")) else editor
        if action.enabled(editor):
            editor.attempt(lambda: action.run(editor))

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
