"""Files dropped on the window."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...media.sequences import find_sequence
from ..actions.documents import open_graph
from ..dialogs import Question
from ..editor import Editor
from ..edits.coding import ENDINGS
from ..services.sequences import patterns


def arrived(editor: Editor, paths: Sequence[Path]) -> None:
    """Pictures and code become nodes; a graph is opened, or becomes a group if it falls on the canvas.

    Several frames of a sequence are one node; for a single one the person says whether it stands for all.
    """
    graphs = [path for path in paths if path.suffix.casefold() == ".json"]
    if len(paths) == len(graphs) == 1 and editor.scope != "graph":
        open_graph(editor, graphs[0])
        return
    codes = tuple(path for path in paths if path.suffix.lower() in ENDINGS)
    files, frames = patterns([path for path in paths if path not in codes])
    files = (*codes, *files)
    at = editor.canvas.pointer
    editor.dialogs.open.discard("start")

    def drop(some: Sequence[Path]) -> None:
        editor.session.drop_files(list(some), at)

    single = [path for path in files if path in frames]
    if not single:
        drop(files)
        return
    first, pattern = single[0], frames[single[0]]
    found = find_sequence(str(pattern))
    count = len(found.frames) if found else 0
    editor.dialogs.question = Question(
        "One of a sequence", f"{first.name} is one of {count} frames of {pattern.name}.",
        (
            ("Read the sequence", lambda: editor.attempt(lambda: drop([frames.get(path, path) for path in files]))),
            ("Only this frame", lambda: editor.attempt(lambda: drop(files))),
        ),
    )
