"""A session: the document that the user works on.

`apply(command)` is the one way to change the document. The rest is in the parts of a session: `history` has the steps
that can be undone, `time` the current frame, `views` the ports in the viewer, `files` how the document is opened and
saved, `code_files` the files with code of its nodes.
"""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Node

from ...resources.sandbox import Sandbox
from .code_files import CodeFiles
from .document_files import DocumentFiles
from .undoable_document import UndoableDocument


class Session(UndoableDocument):
    """A document that is open in the editor, with its files; a new document at first."""

    def __init__(self, types: Mapping[str, type[Node]] | None = None, *, sandbox: Sandbox) -> None:
        super().__init__(types, sandbox=sandbox)
        self.code_files = CodeFiles(self)
        self.files = DocumentFiles(self, self.code_files)
        self.files.new()
