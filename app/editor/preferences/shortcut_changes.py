"""Assigns and resets shortcuts in the preferences."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .context import PreferencesContext


def assign_shortcut(context: PreferencesContext, id: str, keys: str) -> None:
    """Give an action a shortcut, "" for none."""
    own = {**context.store.current.shortcuts, id: keys}
    if context.actions.default_shortcut(id) == keys:
        del own[id]
    context.store.change(shortcuts=own)


def take_shortcut(context: PreferencesContext, id: str, keys: str) -> None:
    """Assign a shortcut that other actions have; these lose it."""
    for conflict in context.actions.conflicts(id, keys):
        assign_shortcut(context, conflict.id, "")
    assign_shortcut(context, id, keys)


def reset_shortcut(context: PreferencesContext, id: str) -> None:
    """Reset an action to its default shortcut; another action that has it loses it."""
    take_shortcut(context, id, context.actions.default_shortcut(id))
