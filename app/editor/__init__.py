"""The desktop editor: a window with panels over a document.

What editing is without a window lies in `halation.authoring`: the session with its document and history, the preview,
files that are watched, renders. This package draws it and takes the mouse and the keyboard.

**Rooms**, from the ground up. A room imports only rooms above it in this list; `tests/law/test_editor_rooms.py` checks
it at every import that runs.

    theme/        colors, fonts, sizes
    shared/       what panels share without knowing each other: the table of actions, open dialogs, the stage,
                  commands to the window, protocols; draws nothing
    toolkit/      widgets of all panels; `PanelContext`, the base of what panels receive
    fields/       widgets that edit one value of a graph
    workflows/    several steps with questions between them: documents, files of code, flipbooks; draws nothing
    canvas/ inspector/ viewer/ timeline/ curves/ code/ renders/ browser/ ...
                  one folder per panel; panels do not import each other
    actions/      all actions in one table, which menus, shortcuts and the command palette read
    window/       the window: puts everything together and calls the panels

**Who knows whom.** `window/editor.py` holds everything that one window has, in `Editor`. Nothing outside of `window/`
sees it. A panel receives a frozen context (`canvas/context.py` and so on) with the collaborators that it uses, and no
others. `window/contexts.py` composes the contexts once. A context holds objects that live as long as the window, so it
is never replaced. Where a panel needs a detail of another panel, its context names a small protocol
(`shared/protocols.py`), such as "bring this element into view".

The viewer, the timeline and the scopes show what is on the `DocumentStage`: the document, or a flipbook in its place.
Their contexts have a `session` that asks the stage each time.

**A frame of the window.** Between two frames `window/frame_updater.py` reads changed files, keeps unsaved work, asks
the viewer which pictures it wants, and lets the preview compute for some milliseconds. Then each visible panel draws,
the dialogs draw over them, and shortcuts run. A panel changes the document through the session only; it does so
within `log.attempt`, which turns an error into a message. A panel that fails is closed in `window/guard.py` and
reported; the others go on. What must wait for the next frame (show a panel, reset the layout, close) goes to
`WindowCommands`.

**How to add a panel.** Make a folder with the class of the panel, whose constructor takes its context and whose
`draw()` takes nothing, and with `context.py`. State that other rooms change gets a class in `state.py` and a field in
`Editor`. Compose the context in `window/contexts.py`, list the panel in `window/panels.py` and its title in
`shared/window_commands.py`, and name the folder in the law. Actions of the panel go into `actions.py` of the folder and
into the table in `actions/__init__.py`; the same context serves them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..resources.sandbox import Sandbox


def edit(path: Path | None, bindings: Mapping[str, str] | None, sandbox: Sandbox, lesson: str = "") -> None:
    """Open the editor on a graph file, a picture, or on the start screen; returns when its window is closed.

    `bindings` are files for graph inputs by name. `lesson` is the id of a lesson of the course to begin. Raises
    DocumentError for a file that cannot be read, DeviceError where no window can be opened.
    """
    from .window import start_editor

    start_editor(path, dict(bindings or {}), sandbox, lesson)
