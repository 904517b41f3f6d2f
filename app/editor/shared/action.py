"""Actions: what menus, shortcuts and the command palette run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Generic, Literal, Never, TypeVar

from msgspec import Struct

from ...authoring.log import Log

Scope = Literal["", "graph", "viewer", "animation"]
"""Where a shortcut works: everywhere (""), or while the mouse is over a panel."""

C = TypeVar("C", contravariant=True)
"""What an action works on: the frozen context of its panel."""


def always(context: object) -> bool:
    """True: for actions that are always enabled."""
    return True


class Action(Struct, Generic[C], frozen=True):
    """Something the user can do from a menu, by a shortcut, from a context menu or the command palette.

    `run` does it with the context of the panel that it belongs to; `enabled` and `checked` are questions about that.
    `menu` is the path in the menu bar, such as `File` or `View/Channels`; without one it is only in the palette.
    `shortcut` is written like `Ctrl+Shift+S`; Ctrl is Command on macOS. `contexts` are the context menus that list it.
    """

    id: str
    label: str
    run: Callable[[C], object]
    menu: str = ""
    shortcut: str = ""
    scope: Scope = ""
    enabled: Callable[[C], bool] = always
    checked: Callable[[C], bool] | None = None
    contexts: frozenset[str] = frozenset()
    doc: str = ""
    separated: bool = False
    """True draws a line above the action in menus."""
    repeats: bool = False
    """True repeats the action while its keys are held."""


ListedAction = Action[Never]
"""An action of any panel: it can be listed, but only `Actions`, which has its context, can run it."""


class BoundAction(Struct, frozen=True):
    """What an action does, with the context that it works on."""

    run: Callable[[], object]
    is_enabled: Callable[[], bool]
    is_checked: Callable[[], bool]


class Actions:
    """All actions in the order of the menus, with the user's own shortcuts.

    `overrides` gives the user's shortcuts by action id, "" for none at all; `keymap` those that another program's users
    are used to. Actions are added with their contexts after
    both are made, since panels run actions themselves.
    """

    def __init__(
        self,
        overrides: Callable[[], Mapping[str, str]],
        log: Log,
        keymap: Callable[[], Mapping[str, str]] = lambda: MappingProxyType({}),
    ) -> None:
        self.all: tuple[ListedAction, ...] = ()
        self.overrides, self.keymap = overrides, keymap
        self._log = log
        self._by_id: dict[str, tuple[ListedAction, BoundAction]] = {}
        self._shortcuts: tuple[tuple[object, ...], Sequence[tuple[ListedAction, str]]] = ((), ())
        """Those of the scope that was asked for last, and what they depend on."""

    def __getitem__(self, id: str) -> ListedAction:
        return self._by_id[id][0]

    def bind(self, actions: tuple[Action[C], ...], context: C) -> None:
        """Add actions that work on a context."""
        self.all += actions
        for action in actions:
            self._by_id[action.id] = action, bind_action(action, context)

    def shortcut(self, id: str) -> str:
        """The current shortcut of an action."""
        own = self.overrides().get(id)
        return self.default_shortcut(id) if own is None else own

    def default_shortcut(self, id: str) -> str:
        """The shortcut of an action in the keymap, before the user changed it."""
        return self.keymap().get(id, self[id].shortcut)

    def list_shortcuts(self, scope: str) -> Sequence[tuple[ListedAction, str]]:
        """The actions of a scope that have a shortcut, and those of all scopes, with their shortcuts."""
        inputs = scope, len(self.all), self.overrides(), self.keymap()
        if self._shortcuts[0] != inputs:
            with_texts = ((action, self.shortcut(action.id)) for action in self.all if action.scope in ("", scope))
            self._shortcuts = inputs, tuple((action, text) for action, text in with_texts if text)
        return self._shortcuts[1]

    def in_menu(self, name: str) -> Iterator[ListedAction]:
        """The actions of a context menu."""
        return (action for action in self.all if name in action.contexts)

    def is_enabled(self, action: ListedAction) -> bool:
        """True if an action is enabled now."""
        return self._by_id[action.id][1].is_enabled()

    def is_checked(self, action: ListedAction) -> bool:
        """True if an action is a switch that is on."""
        return self._by_id[action.id][1].is_checked()

    def run(self, id: str) -> None:
        """Run an action, if it is enabled."""
        bound = self._by_id[id][1]
        if bound.is_enabled():
            self._log.attempt(bound.run)

    def conflicts(self, id: str, shortcut: str) -> tuple[ListedAction, ...]:
        """Other actions with the same shortcut."""
        scope = self[id].scope
        return tuple(
            action
            for action in self.all
            if action.id != id
            and shortcut
            and self.shortcut(action.id) == shortcut
            and (not scope or not action.scope or scope == action.scope)
        )


def bind_action(action: Action[C], context: C) -> BoundAction:
    """Bind an action to its context."""
    checked = action.checked
    return BoundAction(
        lambda: action.run(context),
        lambda: action.enabled(context),
        lambda: checked is not None and checked(context),
    )
