"""Commands for groups: make one, dissolve one, take over or link the file of one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ...errors import GraphError
from ...graph import OUTPUTS, Graph, Group, Port
from ...language.translation import translate
from ..edits import folding, grouping, naming, paths, ungrouping
from ..edits.element_id import ElementId
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class MakeGroup(EditCommand[str], frozen=True):
    """Turn the selection into a group; gives its id. Raises GraphError if it would feed itself."""

    name: str = ""

    def apply(self, document: OpenDocument) -> Edited[str]:
        graph, id = grouping.make_group(document.graph, document.selection, self.name)
        links = folding.find_group(graph, id).graph.links.items()
        leaving = {start: Port(id, end.socket) for end, start in links if end.node == OUTPUTS}
        return Edited(
            translate("Group {elements}", elements=naming.describe_elements(document.selection)),
            id,
            graph,
            (ElementId(id),),
            follows=leaving,
        )


class Ungroup(EditCommand[None], frozen=True):
    """Put what is in a group in its place."""

    id: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph, keys = ungrouping.ungroup(document.graph, self.id)
        return Edited(translate("Ungroup {id}", id=self.id), None, graph, keys)


class MakeGroupLocal(EditCommand[None], frozen=True):
    """Make the body of a group that comes from a file part of this document."""

    id: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        group = folding.find_group(document.graph, self.id)
        if not group.path:
            raise GraphError(translate("group '{id}' is part of this document already", id=self.id))
        local = Group(paths.rebase_paths(group.body(), document.graph.folder))
        return Edited(translate("Make {id} local", id=self.id), None, _with_group(document.graph, self.id, local))


class LinkGroup(EditCommand[None], frozen=True):
    """Let a group come from a file, which holds `body`."""

    id: str
    path: Path
    body: Graph

    def apply(self, document: OpenDocument) -> Edited[None]:
        linked = Group(self.body, paths.make_relative(self.path, document.root.folder))
        return Edited(
            translate("Link {id} to {name}", id=self.id, name=self.path.name),
            None,
            _with_group(document.graph, self.id, linked),
        )


def _with_group(graph: Graph, id: str, group: Group) -> Graph:
    return replace(graph, nodes={**graph.nodes, id: group})
