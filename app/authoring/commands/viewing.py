"""The command that assigns a port to a number key, and those that put another graph in the place of this one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ...errors import GraphError
from ...graph import Graph, Port
from ...language.translation import translate
from ..edits.element_id import ElementId
from ..edits.elements import with_sections
from ..edits.ports import VIEWER_NUMBERS, is_viewable, output_ports
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class AssignViewer(EditCommand[None], frozen=True):
    """Let a key from 1 to 9 show a port: the one given, else the active element's, else the one shown on side A."""

    number: int
    port: Port | None = None

    def apply(self, document: OpenDocument) -> Edited[None]:
        if self.number not in VIEWER_NUMBERS:
            raise GraphError(translate("there is no viewer {number}: choose 1 to 9", number=self.number))
        graph = document.graph
        port = self.port or _find_active_port(document) or document.views.find_port()
        if port is None or not is_viewable(graph, port):
            raise GraphError(translate("there is nothing to show: select a node first"))
        section = graph.ui.get("viewers")
        viewers = {**(section if isinstance(section, Mapping) else {}), str(self.number): str(port)}
        return Edited(
            translate("Assign viewer {number}", number=self.number),
            None,
            with_sections(graph, {"viewers": viewers}),
            view=port,
        )


class ReplaceGraph(EditCommand[None], frozen=True):
    """Put a graph that a panel computed in the place of the one that the user sees, as one step."""

    label: str
    graph: Graph
    select: Iterable[ElementId] | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(self.label, None, self.graph, self.select, self.merge)


class ReplaceDocument(EditCommand[None], frozen=True):
    """Put another document in the place of this one, as one step: what was read again from its file."""

    label: str
    root: Graph

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(self.label, None, root=self.root)


def _find_active_port(document: OpenDocument) -> Port | None:
    if end := document.active.port:
        return end
    graph = document.graph
    ports = output_ports(graph, document.active) if document.active in graph.nodes else []
    return ports[0] if ports else None
