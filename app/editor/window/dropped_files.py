"""Files dropped on the window."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...authoring.commands import DropFiles
from ...authoring.edits.coding import ENDINGS
from ...authoring.edits.element_id import ElementId
from ...errors import HalationError
from ...media.sequences import find_sequence
from ...renderer.provenance.recipe import has_recipe
from ...resources.sandbox import Sandbox
from ...watch.sequence_files import suggest_patterns
from ..shared.dialogs import Question
from ..workflows.documents import DocumentWorkflow
from .editor import Editor


def take_files(editor: Editor, documents: DocumentWorkflow, paths: Sequence[Path]) -> None:
    """Pictures and code become nodes; a graph is opened, or becomes a group if it falls on the canvas.

    Several frames of a sequence are one node; for a single one the user says whether it stands for all. A picture
    that was rendered here may be opened as the graph that made it.
    """
    graphs = [path for path in paths if path.suffix.casefold() == ".json"]
    if len(paths) == len(graphs) == 1 and editor.scope != "graph":
        documents.open_graph(graphs[0])
        return
    if len(paths) == 1 and _has_graph(paths[0], editor.session.sandbox):
        ask_graph_or_picture(editor, documents, paths[0])
        return
    add_files(editor, paths)


def _has_graph(path: Path, sandbox: Sandbox) -> bool:
    """True for a picture that Halation rendered, which holds the graph that made it."""
    try:
        return path.suffix.casefold() not in (".json", *ENDINGS) and has_recipe(path, sandbox=sandbox)
    except HalationError:
        return False


def ask_graph_or_picture(editor: Editor, documents: DocumentWorkflow, path: Path) -> None:
    """Ask whether to open the graph of a dropped picture, or to read its pixels."""
    editor.dialogs.question = Question(
        "Rendered by Halation",
        f"{path.name} holds the graph that made it.",
        (
            ("Open its graph", lambda: documents.open_graph_of_picture(path)),
            ("Read it as a picture", lambda: editor.log.attempt(lambda: add_files(editor, [path]))),
        ),
    )


def add_files(editor: Editor, paths: Sequence[Path]) -> None:
    """Add files as nodes."""
    codes = tuple(path for path in paths if path.suffix.lower() in ENDINGS)
    files, frames = suggest_patterns([path for path in paths if path not in codes], sandbox=editor.session.sandbox)
    files = (*codes, *files)
    at = editor.canvas.pointer
    editor.dialogs.open.discard("start")

    def drop(files: Sequence[Path]) -> None:
        ids = editor.session.apply(DropFiles(list(files), at, editor.canvas.sizes))
        editor.canvas.reveal([ElementId(id) for id in ids])

    single = [path for path in files if path in frames]
    if not single:
        drop(files)
        return
    first, pattern = single[0], frames[single[0]]
    sequence = find_sequence(str(pattern), sandbox=editor.session.sandbox)
    count = len(sequence.frames) if sequence else 0
    editor.dialogs.question = Question(
        "One of a sequence",
        f"{first.name} is one of {count} frames of {pattern.name}.",
        (
            ("Read the sequence", lambda: editor.log.attempt(lambda: drop([frames.get(path, path) for path in files]))),
            ("Only this frame", lambda: editor.log.attempt(lambda: drop(files))),
        ),
    )
