"""Actions on the document as a whole."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ..shared.action import Action
from ..shared.dialogs import Browse, Question
from .code_files import save_drafts

if TYPE_CHECKING:
    from ...authoring.services.recovery import Recovered
    from ..window.editor import Editor


def _unless_unsaved(editor: Editor, then: Callable[[], object], verb: str) -> None:
    """Ask before unsaved work is left behind."""
    if not editor.session.dirty:
        then()
        return

    def saved() -> None:
        _save(editor, then)

    editor.dialogs.question = Question(
        "Unsaved changes",
        f"'{editor.session.name}' has changes that are not saved.",
        ((f"Save and {verb}", saved), (f"{verb.capitalize()} without saving", then), ("Cancel", _nothing)),
    )


def _nothing() -> None:
    """An answer that changes nothing."""


def _new(editor: Editor) -> None:
    _unless_unsaved(editor, lambda: start_new(editor), "start anew")


def start_new(editor: Editor) -> None:
    """An empty graph."""
    editor.session.new()
    editor.canvas.fit()
    editor.dialogs.open.discard("start")


def _open(editor: Editor) -> None:
    browse = Browse("Open a graph", "graph", lambda path: open_graph(editor, path))
    editor.dialogs.browse = browse


def open_graph(editor: Editor, path: Path) -> None:
    """Open a file, after asking about unsaved work."""

    def opened() -> None:
        editor.session.open(path)
        editor.store.opened(path)
        editor.canvas.fit()
        editor.dialogs.open.discard("start")

    _unless_unsaved(editor, lambda: editor.attempt(opened), "open")


def open_preset(editor: Editor, path: Path) -> None:
    """Open a preset as a new document, after asking about unsaved work."""

    def opened() -> None:
        editor.session.open_copy(path)
        editor.canvas.fit()
        editor.dialogs.open.discard("start")

    _unless_unsaved(editor, lambda: editor.attempt(opened), "open the preset")


def open_made(editor: Editor, path: Path) -> None:
    """Open the graph that made a picture as a new document, after asking about unsaved work."""

    def opened() -> None:
        editor.session.open_made(path)
        editor.canvas.fit()
        editor.dialogs.open.discard("start")
        editor.say(f"the graph of {path.name}, as a new document")

    _unless_unsaved(editor, lambda: editor.attempt(opened), "open the graph")


def recover(editor: Editor, recovered: Recovered) -> None:
    """Open work that was not saved, after asking about other unsaved work."""

    def opened() -> None:
        editor.session.restore(recovered)
        editor.recovery.adopt(recovered)
        editor.canvas.fit()
        editor.dialogs.open.discard("start")

    _unless_unsaved(editor, lambda: editor.attempt(opened), "recover")


def _save(editor: Editor, then: Callable[[], object] = _nothing) -> None:
    path = editor.session.path
    if path is None:
        _save_as(editor, then)
        return

    def act() -> None:
        save_drafts(editor)
        editor.session.save()
        editor.watcher.expect(path)
        editor.say(f"saved {path.name}")
        then()

    if not editor.watcher.differs(path):
        act()
        return
    editor.dialogs.question = Question(
        "Changed on disk",
        f"{path.name} was changed by another program since it was read here.",
        (("Replace it", lambda: editor.attempt(act)), ("Cancel", _nothing)),
    )


def _save_as(editor: Editor, then: Callable[[], object] = _nothing) -> None:
    def saved(path: Path) -> None:
        named = path if path.suffix else path.with_suffix(".json")

        def act() -> None:
            save_drafts(editor)
            editor.session.save_as(named)
            editor.watcher.expect(named)
            editor.store.opened(named)
            editor.say(f"saved {named.name}")
            then()

        editor.attempt(act)

    editor.dialogs.browse = Browse("Save the graph as", "graph", saved, saving=True, name=f"{editor.session.name}.json")


def _revert(editor: Editor) -> None:
    editor.dialogs.question = Question(
        "Revert",
        "Go back to what was saved last? This can be undone.",
        (("Revert", lambda: editor.attempt(editor.session.revert)), ("Cancel", _nothing)),
    )


def _quit(editor: Editor) -> None:
    def close() -> None:
        editor.closing = True

    _unless_rendering(editor, lambda: _unless_unsaved(editor, close, "quit"))


def _unless_rendering(editor: Editor, then: Callable[[], object]) -> None:
    """Ask before renders to files are stopped."""
    count = len(editor.exports.unfinished)
    if not count:
        then()
        return
    what = "A render is" if count == 1 else f"{count} renders are"
    editor.dialogs.question = Question(
        "Renders are not finished",
        f"{what} not finished. Frames that are done stay, and Resume can go on from there.",
        (("Stop rendering and quit", then), ("Cancel", _nothing)),
    )


def ask_to_close(editor: Editor) -> bool:
    """True if the window may close now; else a question is open."""
    if not editor.closing:
        _quit(editor)
    return editor.closing


DOCUMENTS: tuple[Action, ...] = (
    Action("file.new", "New", _new, "File", "Ctrl+N"),
    Action("file.open", "Open...", _open, "File", "Ctrl+O"),
    Action("file.start", "Presets and Recent Files...", lambda e: e.dialogs.open.add("start"), "File"),
    Action("file.save", "Save", _save, "File", "Ctrl+S", separated=True),
    Action("file.save_as", "Save As...", _save_as, "File", "Ctrl+Shift+S"),
    Action("file.revert", "Revert", _revert, "File", enabled=lambda e: e.session.path is not None and e.session.dirty),
    Action(
        "file.render", "Render to Files...", lambda e: e.requests.add("show Renders"), "File", "F12", separated=True
    ),
    Action("file.quit", "Quit", _quit, "File", "Ctrl+Q", separated=True),
)
