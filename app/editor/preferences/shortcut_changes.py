"""Changes of shortcuts."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..window.editor import Editor


def assigned(editor: Editor, id: str, keys: str) -> None:
    """Give an action a shortcut, "" for none."""
    own = {**editor.store.now.shortcuts, id: keys}
    if editor.actions[id].shortcut == keys:
        del own[id]
    editor.store.change(shortcuts=own)


def taken_over(editor: Editor, id: str, keys: str) -> None:
    """Give an action a shortcut that others have: they have none then."""
    for other in editor.actions.conflicts(id, keys):
        assigned(editor, other.id, "")
    assigned(editor, id, keys)


def reset(editor: Editor, id: str) -> None:
    """Give an action the shortcut that it came with; who has it meanwhile loses it."""
    taken_over(editor, id, editor.actions[id].shortcut)
