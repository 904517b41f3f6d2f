"""Files that hold code of nodes: what the disk has, and drafts that differ from it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from ...custom_nodes import Code
from ...document.disk import read_text
from ...errors import DocumentError
from ...graph import Graph
from ...resources.atomic_write import write_text_atomically
from ..commands.coding import LinkCodeFile, read_linked_code
from ..edits import coding, paths
from ..state.memo import Memo
from .undoable_document import UndoableDocument


class CodeFiles:
    """The code of nodes of an open document, in files and in the document.

    Code that comes from a file may differ from the file until it is saved: then it is a draft. All nodes of a document
    that have their code in one file have the same text.
    """

    def __init__(self, session: UndoableDocument) -> None:
        self._session, self._sandbox = session, session.sandbox
        self._on_disk: dict[Path, str] = {}
        """What the files hold, as far as they were read."""
        self._version = object()
        """Another object whenever `_on_disk` changed."""
        self._memo = Memo()

    def find_code(self, id: str) -> Code | None:
        """The code of a node of the current graph; None for nodes that are made of none."""
        graph = self._session.graph
        return coding.read_node_code(graph.nodes.get(id), graph.folder, sandbox=self._sandbox)

    @property
    def drafts(self) -> Mapping[Path, str]:
        """Code that differs from the file that it belongs to, by file."""
        root = self._session.root
        return self._memo.get("drafts", (root, self._version), lambda: self._find_drafts(root))

    @property
    def recoverable_root(self) -> Graph:
        """The document with the drafts in it, for the recovery file: nothing else would bring them back."""
        root, drafts = self._session.root, self.drafts
        if not drafts:
            return root
        return self._memo.get(
            "recoverable", (root, drafts), lambda: coding.embed_drafts(root, drafts, sandbox=self._sandbox)
        )

    def export(self, id: str, path: str | Path) -> None:
        """Write the code of a node to a file, from which it comes from then on. Raises OutputError."""
        session, command = self._session, LinkCodeFile(id, path)
        command.apply(session)  # nothing is written where the command makes no sense
        code = self.find_code(id)
        assert code is not None
        write_text_atomically(Path(path), code.text, sandbox=self._sandbox)
        folder = session.graph.folder
        self._note(paths.resolve_path(paths.make_relative(path, folder), folder), code.text)
        session.apply(command)

    def save(self, id: str) -> Path:
        """Write the code of a node to its file; returns that. Raises OutputError."""
        path = paths.resolve_path(read_linked_code(self._session, id).file, self._session.graph.folder)
        self._write(path, coding.file_texts(self._session.root)[path])
        return path

    def save_drafts(self) -> tuple[Path, ...]:
        """Write all code that differs from its file; returns the files. Raises OutputError."""
        drafts = self.drafts
        for path, text in drafts.items():
            self._write(path, text)
        return tuple(drafts)

    def reread(self, path: Path) -> None:
        """Take over what another program wrote to a file of code, drafts of it included; this is no step."""
        self._on_disk.pop(path, None)
        self._session.migrate(lambda graph: coding.reread_file_code(graph, path, sandbox=self._sandbox))
        self.read_missing()

    def read_missing(self) -> None:
        """Read the files of code that were not read yet."""
        for path in coding.file_texts(self._session.root):
            if path not in self._on_disk:
                try:
                    self._note(path, read_text(path, sandbox=self._sandbox))
                except DocumentError:
                    self._note(path, "")

    def differs_from_disk(self, path: Path) -> bool:
        """True if there is a draft of a file, and the file holds something else now, or cannot be read."""
        draft = self.drafts.get(path)
        if draft is None:
            return False
        try:
            return read_text(path, sandbox=self._sandbox) != draft
        except DocumentError:
            return True

    def keep_draft(self, path: Path) -> None:
        """Keep the code as it is here though another program changed its file: it is a draft now."""
        self._on_disk.pop(path, None)
        self.read_missing()

    def reset(self) -> None:
        """Read all files again the next time."""
        self._on_disk, self._version = {}, object()

    def _note(self, path: Path, text: str) -> None:
        """Remember what a file holds."""
        self._on_disk[path], self._version = text, object()

    def _find_drafts(self, root: Graph) -> Mapping[Path, str]:
        texts = coding.file_texts(root).items()
        return MappingProxyType({path: text for path, text in texts if self._on_disk.get(path, text) != text})

    def _write(self, path: Path, text: str) -> None:
        write_text_atomically(path, text, sandbox=self._sandbox)
        self._note(path, text)
        session = self._session
        if session.saved is not None:
            session.saved = coding.set_file_code(session.saved, path, text, sandbox=self._sandbox)
            session.revision += 1
