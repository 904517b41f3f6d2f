"""Files dropped on the window."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..actions.documents import open_graph
from ..editor import Editor


def arrived(editor: Editor, paths: Sequence[Path]) -> None:
    """Pictures become nodes; a graph is opened, or becomes a group if it falls on the canvas."""
    graphs = [path for path in paths if path.suffix.casefold() == ".json"]
    if len(paths) == len(graphs) == 1 and editor.scope != "graph":
        open_graph(editor, graphs[0])
        return
    editor.session.drop_files(list(paths), editor.canvas.pointer)
    editor.dialogs.open.discard("start")
