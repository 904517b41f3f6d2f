"""Actions on the code of nodes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...custom_nodes import Code
from ..shared.action import Action
from ..shared.dialogs import Browse, Question

if TYPE_CHECKING:
    from ..window.editor import Editor

PANEL = "Code"
"""The title of the panel that code is written in."""


def _code(editor: Editor) -> Code | None:
    return editor.session.code(editor.session.active)


def _in_file(editor: Editor) -> bool:
    code = _code(editor)
    return code is not None and bool(code.file)


def show_code(editor: Editor) -> None:
    """Open the panel for the active node, ready to be typed into."""
    editor.requests.add(f"show {PANEL}")
    editor.code.focus = True


def save_code(editor: Editor, id: str) -> None:
    """Write the code of a node to its file. Raises OutputError."""
    path = editor.session.save_code(id)
    editor.watcher.expect(path)
    editor.say(f"saved {path.name}")


def save_drafts(editor: Editor) -> None:
    """Write all code that differs from its file, as when the graph that it belongs to is saved. Raises OutputError."""
    editor.code.flush()
    for path in editor.session.save_drafts():
        editor.watcher.expect(path)
        editor.say(f"saved {path.name}")


def export_code(editor: Editor, id: str) -> None:
    """Ask for a file, and let the code of a node come from it."""
    code = editor.session.code(id)
    ending = ".fs" if code and code.language == "isf" else ".glsl"

    def saved(path: Path) -> None:
        named = path if path.suffix else path.with_suffix(ending)

        def act() -> None:
            editor.session.export_code(id, named)
            editor.watcher.expect(named)

        editor.attempt(act)

    editor.dialogs.browse = Browse("Move the code to a file", "code", saved, saving=True, name=f"{id}{ending}")


def code_changed(editor: Editor, path: Path) -> None:
    """Another program wrote a file of code."""
    session = editor.session

    def load() -> None:
        session.reread_code(path)
        editor.say(f"{path.name} changed on disk and was loaded again")

    editor.code.flush()
    if not session.differs_from_disk(path):
        load()
        return

    def keep() -> None:
        session.keep_draft(path)
        editor.say("kept; saving will replace the other version")

    editor.dialogs.question = Question(
        "Changed on disk",
        f"{path.name} was changed by another program, and here are changes that are not saved.",
        (("Load theirs", lambda: editor.attempt(load)), ("Keep mine", keep)),
    )


CODE: tuple[Action, ...] = (
    Action(
        "code.edit",
        "Edit Code",
        show_code,
        "Graph/Code",
        "Enter",
        "graph",
        lambda e: _code(e) is not None,
        contexts=frozenset({"code"}),
        doc="Show what the node is made of, and write it.",
        separated=True,
    ),
    Action(
        "code.save",
        "Save Code to Its File",
        lambda e: save_code(e, e.session.active),
        "Graph/Code",
        enabled=_in_file,
        contexts=frozenset({"code"}),
    ),
    Action(
        "code.export",
        "Move Code to a File...",
        lambda e: export_code(e, e.session.active),
        "Graph/Code",
        enabled=lambda e: _code(e) is not None,
        contexts=frozenset({"code"}),
        doc="Write the code to a file of its own, for use in other graphs; from now on it comes from there.",
    ),
    Action(
        "code.inline",
        "Move Code into the Graph",
        lambda e: e.session.inline_code(e.session.active),
        "Graph/Code",
        enabled=_in_file,
        contexts=frozenset({"code"}),
        doc="Keep the code in this graph; the file stays as it is.",
    ),
)
