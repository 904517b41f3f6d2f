"""The open document as a file: begin, open, save, and read again."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from halation.nodes import REFERENCE_HEIGHT

from ...document import load, loads, save
from ...errors import UsageError
from ...graph import Graph, Output, Port, Settings, signature
from ...language.translation import translate
from ...renderer.provenance.file_finder import load_graph_of_picture
from ..commands.adding import DropFiles
from ..commands.grouping import LinkGroup
from ..commands.layout import MoveElements
from ..commands.linking import Connect
from ..commands.viewing import ReplaceDocument
from ..edits import folding, layout, paths
from ..edits.element_id import ElementId
from ..edits.sizes import WIDTH
from .code_files import CodeFiles
from .undoable_document import UndoableDocument

if TYPE_CHECKING:
    from ..recovery import RecoveredWork


_OUTPUT = Port("outputs", "image")


def _make_blank_graph() -> Graph:
    """What a new document holds: one output that nothing feeds, and lengths that look the same at every size."""
    settings = Settings(reference_height=REFERENCE_HEIGHT)
    return layout.pin_places(Graph(outputs={_OUTPUT.socket: Output()}, settings=settings))


class DocumentFiles:
    """Opens and saves the document of a session, and the groups in it that come from files."""

    def __init__(self, session: UndoableDocument, code_files: CodeFiles) -> None:
        self._session, self._code_files = session, code_files

    def new(self) -> None:
        """Begin an empty document: one output, and nothing to show yet."""
        root = _make_blank_graph()
        self._restart(root, saved=root)

    def open(self, path: str | Path) -> None:
        """Open a graph file. Raises DocumentError; then everything is as before."""
        root = self._load(path)
        self._restart(root, Path(path), saved=root)

    def open_copy(self, path: str | Path) -> None:
        """Open a graph file as a new document, as presets are: saving asks for a name. Raises DocumentError."""
        root = self._load(path)
        self._restart(root, saved=root)

    def open_pictures(self, files: Sequence[str | Path]) -> None:
        """Begin a new document with nodes that read pictures; the first one feeds the output and is selected.

        Raises HalationError; then everything is as before.
        """
        session = self._session
        blank = UndoableDocument(session.types, sandbox=session.sandbox)
        blank.restart(_make_blank_graph())
        ids = blank.apply(DropFiles(files))
        output = next(iter(signature(blank.graph.node(ids[0])).outputs))
        blank.apply(Connect(Port(ids[0], output), _OUTPUT))
        blank.apply(MoveElements([ElementId.of_port(_OUTPUT)], 2 * WIDTH, 0.0))
        self._restart(blank.root, saved=blank.root, title=Path(files[0]).stem)
        session.select(ElementId.of("node", ids[0]))

    def open_graph_of_picture(self, path: str | Path) -> None:
        """Open the graph that rendered a picture, as a new document with the picture's name. Raises HalationError."""
        session = self._session
        root = load_graph_of_picture(Path(path), session.types, sandbox=session.sandbox)
        self._restart(root, saved=root, title=Path(path).stem)

    def open_text(self, text: str) -> None:
        """Open the text of a graph file as a document without a file. Raises DocumentError."""
        session = self._session
        self._restart(loads(text, "text", catalogue=session.types, sandbox=session.sandbox))

    def open_recovered(self, work: RecoveredWork) -> None:
        """Open work that was recovered, which is not saved yet; it keeps the file that it belongs to."""
        self._restart(work.load(self._session.sandbox), work.path)

    def save(self) -> None:
        """Save to the file that was opened. Raises UsageError if there is none."""
        if self._session.path is None:
            raise UsageError(translate("this document has no file yet: choose one with Save As"))
        self.save_as(self._session.path)

    def save_as(self, path: str | Path) -> None:
        """Save to a file; relative paths are rewritten so that they lead to the same files. Raises OutputError."""
        session, target = self._session, Path(path)
        paths.check_target(session.root, target)
        session.seal()
        folder = str(target.parent)
        root = paths.rebase_paths(session.root, folder)
        save(root, target, sandbox=session.sandbox)
        if root is not session.root:
            session.migrate(lambda graph: paths.rebase_paths(graph, folder))
        session.path, session.saved = target, session.root
        session.revision += 1

    def revert(self) -> None:
        """Go back to what was saved; this can be undone."""
        self._read_again(translate("Revert"))

    def reload(self) -> None:
        """Read the file again after another program changed it; this can be undone."""
        self._read_again(translate("Reload"))

    def reload_groups(self) -> None:
        """Read the files of all groups again; this is no step. Raises DocumentError, and then nothing changes."""
        bodies: dict[Path, Graph] = {}

        def read_body(path: Path) -> Graph:
            if path not in bodies:
                bodies[path] = self._load(path)
            return bodies[path]

        self._session.migrate(lambda graph: folding.reread_groups(graph, read_body))

    def save_group(self, id: str, path: str | Path, link: bool = False) -> None:
        """Save what is in a group as a graph file; with `link`, the group comes from that file from now on."""
        session, target = self._session, Path(path)
        body = paths.rebase_paths(folding.find_group(session.graph, id).body(), str(target.parent))
        paths.check_target(body, target)
        if session.path and session.path.resolve() == target.resolve():
            raise UsageError(
                translate("{target}: this is the file of the document itself: choose another name", target=target)
            )
        save(body, target, sandbox=session.sandbox)
        if link:
            session.apply(LinkGroup(id, target, body))

    def _restart(self, root: Graph, path: Path | None = None, saved: Graph | None = None, title: str = "") -> None:
        self._code_files.reset()
        self._session.restart(root, path, saved, title)

    def _load(self, path: str | Path) -> Graph:
        return load(path, self._session.types, sandbox=self._session.sandbox)

    def _read_again(self, label: str) -> None:
        session = self._session
        if session.path is None:
            raise UsageError(translate("this document has no file to read again"))
        root = self._load(session.path)
        session.seal()
        session.saved = root
        self._code_files.reset()
        session.apply(ReplaceDocument(label, root))
