"""The open document as commands and panels read it.

`DocumentState` knows what the document is (`root`), where in it the user is (`place`, and the `graph` there), what is
selected, and what follows from that: positions and problems. `time` adds the current frame and what values are at it,
`views` which ports the viewer shows. Only `Session`, which extends `OpenDocument`, changes the document.
"""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Node

from ...resources.sandbox import Sandbox
from .document_state import DocumentState
from .document_time import DocumentTime
from .viewed_ports import ViewedPorts


class OpenDocument(DocumentState):
    """A document with its time, and with what the viewer shows of it."""

    def __init__(self, types: Mapping[str, type[Node]] | None = None, *, sandbox: Sandbox) -> None:
        super().__init__(types, sandbox=sandbox)
        self.time = DocumentTime(self)
        self.views = ViewedPorts(self)
