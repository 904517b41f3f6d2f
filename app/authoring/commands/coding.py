"""Commands for nodes that are made of code."""

from __future__ import annotations

from pathlib import Path

from msgspec import structs

from ...custom_nodes import Code
from ...errors import GraphError
from ...language.translation import translate
from ..edits import coding, folding, paths
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class SetCode(EditCommand[None], frozen=True):
    """Give a node another text; links and values stay where their names do. Text that says no node is kept too.

    Texts with the same `merge` in a row make one step, as if only the last one had been written: what one of them made
    of links and values does not matter for the next.
    """

    id: str
    text: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        before = document.history.snapshot_before(self.merge)
        root = document.root if before is None or before.place != document.place else before.root
        graph = folding.body_at(root, document.place)
        code = coding.read_node_code(graph.nodes.get(self.id), graph.folder, sandbox=document.sandbox)
        if code is None:
            raise GraphError(translate("node '{id}' is not made of code", id=self.id))
        label = translate("Edit code of {id}", id=self.id)
        if not code.file:
            edited = coding.set_code(graph, self.id, structs.replace(code, text=self.text))
            return Edited(label, None, edited, merge=self.merge)
        document.check_editable()
        file = paths.resolve_path(code.file, graph.folder)
        return Edited(
            label, None, root=coding.set_file_code(root, file, self.text, sandbox=document.sandbox), merge=self.merge
        )


class EmbedCode(EditCommand[None], frozen=True):
    """Let the code of a node be part of the document; the file stays as it is."""

    id: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        code = read_linked_code(document, self.id)
        graph = coding.set_code(document.graph, self.id, structs.replace(code, file=""))
        return Edited(translate("Move code of {id} into the graph", id=self.id), None, graph)


class LinkCodeFile(EditCommand[None], frozen=True):
    """Let the code of a node come from a file, which holds the same text."""

    id: str
    path: str | Path

    def apply(self, document: OpenDocument) -> Edited[None]:
        code = coding.read_node_code(document.graph.nodes.get(self.id), document.graph.folder, sandbox=document.sandbox)
        if code is None:
            raise GraphError(translate("node '{id}' is not made of code", id=self.id))
        document.check_editable()
        name = paths.make_relative(self.path, document.graph.folder)
        graph = coding.set_code(document.graph, self.id, structs.replace(code, file=name))
        return Edited(translate("Move code of {id} to {name}", id=self.id, name=Path(self.path).name), None, graph)


def read_linked_code(document: OpenDocument, id: str) -> Code:
    """The code of a node of the current graph whose code is in a file. Raises GraphError for other nodes."""
    code = coding.read_node_code(document.graph.nodes.get(id), document.graph.folder, sandbox=document.sandbox)
    if code is None or not code.file:
        raise GraphError(translate("the code of node '{id}' is in no file: move it to one first", id=id))
    return code
