"""Commands for inputs and outputs of the graph: where pictures come in and leave."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from halation.nodes import Kind, Missing, Plain

from ...errors import GraphError
from ...graph import INPUTS, Graph, Input, Output, Port, problems
from ...language.translation import translate
from ..edits.element_id import ElementId
from ..edits.elements import Place, clean_text, with_places
from ..edits.selection import order_selection
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class Keep:
    """A marker: the field stays as it is. None means something else there."""


KEEP = Keep()


class AddInput(EditCommand[ElementId], frozen=True):
    """Add an input of the graph, selected; gives its id. `width` counts the channels of a Vector."""

    name: str
    kind: Kind | str = Kind.IMAGE
    width: int = 4
    at: Place | None = None

    def apply(self, document: OpenDocument) -> Edited[ElementId]:
        graph = document.graph.add_input(self.name, Input(Kind(self.kind), self.width))
        return _add_end(graph, ElementId.of("input", self.name), self.at)


class AddOutput(EditCommand[ElementId], frozen=True):
    """Add an output of the graph, selected; gives its id. `width` counts the channels of a Vector."""

    name: str
    kind: Kind | str = Kind.IMAGE
    width: int = 3
    at: Place | None = None

    def apply(self, document: OpenDocument) -> Edited[ElementId]:
        graph = document.graph.add_output(self.name, Output(Kind(self.kind), self.width))
        return _add_end(graph, ElementId.of("output", self.name), self.at)


class RemoveEnd(EditCommand[None], frozen=True):
    """Remove an input or output and its links."""

    end: ElementId

    def apply(self, document: OpenDocument) -> Edited[None]:
        port, graph = _find_port(document.graph, self.end), document.graph
        remove = graph.remove_input if port.node == INPUTS else graph.remove_output
        return Edited(translate("Remove {end}", end=self.end), None, remove(port.socket))


class RenameEnd(EditCommand[None], frozen=True):
    """Give an input or output another name; links and files bound to it follow."""

    end: ElementId
    new: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        port, graph = _find_port(document.graph, self.end), document.graph
        rename = graph.rename_input if port.node == INPUTS else graph.rename_output
        graph, new_port = rename(port.socket, self.new), Port(port.node, self.new)
        new_end = ElementId.of_port(new_port)
        selected = order_selection(document.selection, document.active)
        selection = [new_end if element == self.end else element for element in selected]
        label = translate("Rename {end} to {new}", end=self.end, new=self.new)
        return Edited(label, None, graph, selection, moves={port: new_port}, renamed=(self.end, new_end))


class SetInput(EditCommand[None], frozen=True):
    """Change an input; what is not given stays. A default of None means that there is none."""

    name: str
    file: str | None = None
    layer: str | None = None
    default: Plain | Keep | None = KEEP
    doc: str | None = None
    missing: Missing | None = None
    color_space: str | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        if self.name not in graph.inputs:
            raise GraphError(translate("the graph has no input '{name}'", name=self.name))
        facts = _clean_set_texts(
            file=self.file, layer=self.layer, doc=self.doc, missing=self.missing, color_space=self.color_space
        )
        if not isinstance(self.default, Keep):
            facts["default"] = self.default
        changed = replace(graph.inputs[self.name], **facts)
        graph = replace(graph, inputs={**graph.inputs, self.name: changed})
        _check_default(graph, self.name)
        return Edited(translate("Set inputs.{name}", name=self.name), None, graph, merge=self.merge)


class SetOutput(EditCommand[None], frozen=True):
    """Change how an output is saved and shown; what is not given stays."""

    name: str
    layer: str | None = None
    view: str | None = None
    overscan: bool | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        if self.name not in graph.outputs:
            raise GraphError(translate("the graph has no output '{name}'", name=self.name))
        end = graph.outputs[self.name]
        overscan = end.overscan if self.overscan is None else self.overscan
        changed = replace(end, overscan=overscan, **_clean_set_texts(layer=self.layer, view=self.view))
        graph = replace(graph, outputs={**graph.outputs, self.name: changed})
        return Edited(translate("Set outputs.{name}", name=self.name), None, graph, merge=self.merge)


def _add_end(graph: Graph, end: ElementId, at: Place | None) -> Edited[ElementId]:
    return Edited(translate("Add {end}", end=end), end, with_places(graph, {end: at}) if at else graph, (end,))


def _find_port(graph: Graph, end: ElementId) -> Port:
    """The port of an input or output. Raises GraphError if the graph has none of that name."""
    port = end.port
    if port is None or port.socket not in (graph.inputs if port.node == INPUTS else graph.outputs):
        raise GraphError(translate("the graph has no '{end}'", end=end))
    return port


def _clean_set_texts(**facts: str | None) -> dict[str, Any]:
    return {name: clean_text(text) for name, text in facts.items() if text is not None}


def _check_default(graph: Graph, name: str) -> None:
    """Raise GraphError if an input cannot have the default that it has."""
    for problem in problems(Graph(inputs={name: graph.inputs[name]}), {}):
        if problem.node == INPUTS:
            raise GraphError(problem.sentence)
    if isinstance(graph.inputs[name].default, str | bool):
        raise GraphError(translate("input '{name}': the default is a number, or one per channel", name=name))
