"""Files dropped on the window."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from ...authoring.commands import DropFiles
from ...authoring.edits.coding import ENDINGS
from ...authoring.edits.element_id import ElementId
from ...language.translation import translate
from ...media.sequences import find_sequence
from ...watch.sequence_files import suggest_patterns
from ..shared.dialogs import Question
from ..workflows.documents import DocumentWorkflow, has_graph
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
    is_code = paths[0].suffix.casefold() in (".json", *ENDINGS) if len(paths) == 1 else True
    if not is_code and has_graph(paths[0], editor.session.sandbox):
        read = partial(editor.log.attempt, lambda: add_files(editor, paths))
        documents.ask_graph_or_picture(paths[0], read)
        return
    add_files(editor, paths)


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
        translate("One of a sequence"),
        translate("{name} is one of {count} frames of {pattern}.", name=first.name, count=count, pattern=pattern.name),
        (
            (
                translate("Read the sequence"),
                lambda: editor.log.attempt(lambda: drop([frames.get(path, path) for path in files])),
            ),
            (translate("Only this frame"), lambda: editor.log.attempt(lambda: drop(files))),
        ),
    )
