"""The document as a file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ...document import load, loads, save
from ...errors import UsageError
from ...graph import Graph, Output
from ...renderer.provenance.file_finder import load_graph_of_picture
from ..edits import folding, layout, paths
from ..state.history import HistoryStep
from .state import State

if TYPE_CHECKING:
    from ..recovery.recovery import RecoveredWork


class Files(State):
    """New, open, save."""

    def new(self) -> None:
        """An empty document: one output, and nothing to show yet."""
        root = layout.pin_places(Graph(outputs={"image": Output()}))
        self._restart(root, None, root)

    def open(self, path: str | Path) -> None:
        """Open a graph file. Raises DocumentError; then everything is as before."""
        root = load(path, self.types)
        self._restart(root, Path(path), root)

    def open_copy(self, path: str | Path) -> None:
        """Open a graph file as a new document, as presets are: saving asks for a name. Raises DocumentError."""
        root = load(path, self.types)
        self._restart(root, None, root)

    def open_made(self, path: str | Path) -> None:
        """Open the graph that made a picture, as a new document that is called like it. Raises HalationError."""
        root = load_graph_of_picture(Path(path), self.types)
        self._restart(root, None, root)
        self._title = Path(path).stem

    def open_text(self, text: str) -> None:
        """Open the text of a graph file as a document without a file."""
        self._restart(loads(text, "text", catalogue=self.types), None, None)

    def restore(self, recovered: RecoveredWork) -> None:
        """Open work that was recovered; it has the file that it was to be saved as, but is not saved."""
        self._restart(recovered.load(), recovered.path, None)

    def save(self) -> None:
        """Save to the file that was opened. Raises UsageError if there is none."""
        if self.path is None:
            raise UsageError("this document has no file yet: choose one with Save As")
        self.save_as(self.path)

    def save_as(self, path: str | Path) -> None:
        """Save to a file; relative paths are rewritten so that they lead to the same files. Raises OutputError."""
        target = Path(path)
        paths.check_target(self.root, target)
        self.seal()
        folder = str(target.parent)
        root = paths.rebased(self.root, folder)
        save(root, target)
        if root is not self.root:
            self._transform(lambda graph: paths.rebased(graph, folder))
        self.path, self._saved = target, self.root
        self._touch()

    def revert(self) -> None:
        """Go back to what was saved; this can be undone."""
        self._read_again("Revert")

    def reload(self) -> None:
        """Read the file again after another program changed it; this can be undone."""
        self._read_again("Reload")

    def _read_again(self, label: str) -> None:
        if self.path is None:
            raise UsageError("this document has no file to read again")
        self.seal()
        root = load(self.path, self.types)
        before = self._now
        self._saved = root
        self._read_anew()
        self._arrive(root)
        if root != before.root:
            self.history.add(HistoryStep(label, before, self._now))

    def reload_groups(self) -> None:
        """Read the files of all groups again; this is no step. Raises DocumentError, and then nothing changes."""
        read: dict[Path, Graph] = {}

        def body(path: Path) -> Graph:
            if path not in read:
                read[path] = load(path, self.types)
            return read[path]

        self._transform(lambda graph: folding.reread_groups(graph, body))

    def migrate(self, change: Callable[[Graph], Graph]) -> None:
        """Apply a change that keeps the meaning of a graph to the document and its whole history; this is no step."""
        self._transform(change)
