"""Changes of shortcuts."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .context import PreferencesContext


def assign_shortcut(context: PreferencesContext, id: str, keys: str) -> None:
    """Give an action a shortcut, "" for none."""
    own = {**context.store.current.shortcuts, id: keys}
    if context.actions[id].shortcut == keys:
        del own[id]
    context.store.change(shortcuts=own)


def take_shortcut(context: PreferencesContext, id: str, keys: str) -> None:
    """Give an action a shortcut that others have: they have none then."""
    for conflict in context.actions.conflicts(id, keys):
        assign_shortcut(context, conflict.id, "")
    assign_shortcut(context, id, keys)


def reset_shortcut(context: PreferencesContext, id: str) -> None:
    """Give an action the shortcut that it came with; who has it meanwhile loses it."""
    take_shortcut(context, id, context.actions[id].shortcut)
