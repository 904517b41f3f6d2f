"""Commands for links and for the nodes that are there: connect, cut, delete, replace, rename, mute, collapse."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from ...errors import GraphError
from ...graph import Port
from ...language.translation import translate
from ..edits import appending, deleting, elements, naming, wiring
from ..edits.element_id import ElementId
from ..edits.selection import order_selection
from ..state.open_document import OpenDocument
from .absent_layers import list_absent_outputs
from .adding import make_node
from .command import EditCommand, Edited, count_links, require_nodes, require_selection


class Connect(EditCommand[None], frozen=True):
    """Link `source` to `target`, which replaces its link."""

    source: Port
    target: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph.connect(self.source, self.target)
        return Edited(translate("Link {source} to {target}", source=self.source, target=self.target), None, graph)


class ConnectNodes(EditCommand[None], frozen=True):
    """Link `source` to `target`, and all free sockets of the two nodes that have the same name and fit.

    Outputs of a render that its file has no layer for are left out.
    """

    source: Port
    target: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph.connect(self.source, self.target)
        absent = list_absent_outputs(document, (self.source.node,))
        graph = appending.connect_alike(graph, self.source.node, self.target.node, absent)
        return Edited(translate("Link {source} to {target}", source=self.source, target=self.target), None, graph)


class ConnectSelection(EditCommand[None], frozen=True):
    """Link all that is selected to the element selected last: sockets of the same name, else the first that fits."""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph, target = document.graph, document.active
        feeders = [key for key in order_selection(document.selection, target) if key != target]
        if target not in document.selection or not feeders:
            raise GraphError(translate("select what is to be linked, and its target last"))
        linked = appending.feed_element(graph, target, feeders, list_absent_outputs(document, feeders))
        if linked is graph or linked.links == graph.links:
            raise GraphError(translate("nothing that is selected fits a free socket of '{target}'", target=target.name))
        label = translate("Link {elements}", elements=naming.describe_elements(document.selection))
        return Edited(label, None, linked)


class Disconnect(EditCommand[None], frozen=True):
    """Remove the link to `target`."""

    target: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(translate("Unlink {target}", target=self.target), None, document.graph.disconnect(self.target))


class DisconnectAll(EditCommand[None], frozen=True):
    """Remove every link of a node or end."""

    element: ElementId

    def apply(self, document: OpenDocument) -> Edited[None]:
        targets = [
            end
            for end, start in document.graph.links.items()
            if self.element in (ElementId.of_port(end), ElementId.of_port(start))
        ]
        return Edited(
            translate("Unlink {element}", element=self.element), None, wiring.cut_links(document.graph, targets)
        )


class CutLinks(EditCommand[None], frozen=True):
    """Remove the links to `targets`."""

    targets: Collection[Port]

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(
            translate("Cut {links}", links=count_links(self.targets)),
            None,
            wiring.cut_links(document.graph, self.targets),
        )


class MoveLink(EditCommand[None], frozen=True):
    """Move a link from one socket to another."""

    old_target: Port
    new_target: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = wiring.move_link(document.graph, self.old_target, self.new_target)
        return Edited(translate("Move link to {new_target}", new_target=self.new_target), None, graph)


class SwapInputs(EditCommand[None], frozen=True):
    """Swap the links of the first two inputs of a node."""

    id: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(translate("Swap inputs of {id}", id=self.id), None, wiring.swap_inputs(document.graph, self.id))


class DeleteSelection(EditCommand[None], frozen=True):
    """Delete the selection; with `heal`, the nodes before and after it are linked where that fits."""

    heal: bool = True

    def apply(self, document: OpenDocument) -> Edited[None]:
        doomed = require_selection(document, translate("nothing is selected: select what to delete"))
        graph = deleting.delete_elements(document.graph, doomed, self.heal)
        return Edited(translate("Delete {elements}", elements=naming.describe_elements(doomed)), None, graph, ())


class ExtractSelection(EditCommand[None], frozen=True):
    """Take the selected nodes out of their chains; the links there are healed."""

    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = wiring.extract_nodes(
            document.graph, require_nodes(document, translate("no node is selected: select what to extract"))
        )
        return Edited(
            translate("Extract {elements}", elements=naming.describe_elements(document.selection)),
            None,
            graph,
            merge=self.merge,
        )


class ReplaceNode(EditCommand[None], frozen=True):
    """Give a node another type; links and values stay where they fit."""

    id: str
    type_id: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        kind = type(make_node(document, self.type_id))
        graph = wiring.replace_node(document.graph, self.id, kind)
        return Edited(translate("Replace {id} by {type_id}", id=self.id, type_id=self.type_id), None, graph)


class RenameNode(EditCommand[None], frozen=True):
    """Rename a node; links, keys and expressions follow."""

    id: str
    new: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph.rename(self.id, self.new)
        old, new = ElementId(self.id), ElementId(self.new)
        selected = order_selection(document.selection, document.active)
        selection = [new if element == old else element for element in selected]
        return Edited(translate("Rename {old} to {new}", old=old, new=new), None, graph, selection, renamed=(old, new))


class ToggleMute(EditCommand[None], frozen=True):
    """Mute the selected nodes; if all are muted already, let them work again."""

    def apply(self, document: OpenDocument) -> Edited[None]:
        ids = require_nodes(document, translate("no node is selected: select what to mute"))
        mutes = not document.graph.muted.issuperset(ids)
        graph = document.graph
        for id in ids:
            graph = graph.mute(id, mutes)
        elements = naming.describe_elements(document.selection)
        label = translate("Mute {elements}", elements=elements)
        if not mutes:
            label = translate("Unmute {elements}", elements=elements)
        return Edited(label, None, graph)


class ToggleCollapse(EditCommand[None], frozen=True):
    """Fold the selected nodes to their title; if all are folded, unfold them."""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        chosen = [key for key in document.elements if key in document.selection and elements.can_be_linked(key, graph)]
        if not chosen:
            raise GraphError(translate("no node is selected: select what to collapse"))
        collapses = not all(elements.entry(graph, key).get("collapsed") is True for key in chosen)
        facts: dict[ElementId, Mapping[str, object]] = {
            key: {"collapsed": True if collapses else None} for key in chosen
        }
        label = translate("Collapse {elements}", elements=naming.describe_elements(chosen))
        if not collapses:
            label = translate("Expand {elements}", elements=naming.describe_elements(chosen))
        return Edited(label, None, elements.with_entries(graph, facts))
