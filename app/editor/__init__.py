"""The desktop editor: wire nodes, see the picture, lose nothing.

Data flows one way. A person's act, through an action or a panel, calls a method of the `Session`, which makes a new
graph; the `Preview` turns what is wanted of that graph into pictures, pass by pass; panels draw both.

    session/ edits/      what a person can do to a document, and the pure functions behind it
    preview/             pictures within a frame budget
    editor.py            everything that one window has; log.py dialogs.py action.py are parts of it
    actions/             one table for menus, shortcuts, context menus and the command palette
    services/            preferences, recovery, watched files, renders to disk
    theme/ window/       how it looks; the window that hosts the panels
    canvas/ inspector/ viewer/ panels/

Only the last two lines import a window library: everything above is tested without a window.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path


def edit(path: Path | None = None, bindings: Mapping[str, str] | None = None) -> None:
    """Open the editor on a graph file, or on the start screen; returns when its window is closed.

    `bindings` are files for graph inputs by name. Raises DocumentError for a file that cannot be read, DeviceError
    where no window can be opened.
    """
    from .window import open_window

    open_window(path, dict(bindings or {}))
