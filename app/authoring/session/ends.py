"""Inputs and outputs of the graph."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from halation.nodes import Kind, Missing, Plain, Size

from ...errors import GraphError
from ...graph import INPUTS, Graph, Input, Output, Port, problems
from ..edits.elements import Place, clean_text, end_port, with_places
from .state import State


class Keep:
    """Says that something stays as it is, where None means something else."""


KEEP = Keep()


class Ends(State):
    """Where pictures come in and leave."""

    def add_input(self, name: str, kind: Kind | str = Kind.IMAGE, width: int = 4, at: Place | None = None) -> str:
        """One more input of the graph, selected; returns its key. `width` counts the channels of a Vector."""
        return self._add_end(self.graph.add_input(name, Input(Kind(kind), width)), f"inputs.{name}", at)

    def add_output(self, name: str, kind: Kind | str = Kind.IMAGE, width: int = 3, at: Place | None = None) -> str:
        """One more output of the graph, selected; returns its key. `width` counts the channels of a Vector."""
        return self._add_end(self.graph.add_output(name, Output(Kind(kind), width)), f"outputs.{name}", at)

    def remove_end(self, key: str) -> None:
        """Remove an input or output and its links."""
        end = self._end(key)
        graph = self.graph
        self.edit(f"Remove {key}", (graph.remove_input if end.node == INPUTS else graph.remove_output)(end.socket))

    def rename_end(self, key: str, new: str) -> None:
        """Give an input or output another name; links and files bound to it follow."""
        end = self._end(key)
        rename = self.graph.rename_input if end.node == INPUTS else self.graph.rename_output
        graph, fresh = rename(end.socket, new), Port(end.node, new)
        if end.node == INPUTS and not self.place and end.socket in self._bound:
            self._bound[new] = self._bound[end.socket]
        chosen = [str(fresh) if one == key else one for one in self._ordered_selection()]
        self._renamed(key, str(fresh))
        self.edit(f"Rename {key} to {new}", graph, chosen, moves={end: fresh})

    def set_input(
        self,
        name: str,
        *,
        file: str | None = None,
        layer: str | None = None,
        default: Plain | Keep | None = KEEP,
        doc: str | None = None,
        missing: Missing | None = None,
        color_space: str | None = None,
        merge: str = "",
    ) -> None:
        """Change an input; what is not given stays. A default of None means that there is none."""
        if name not in self.graph.inputs:
            raise GraphError(f"the graph has no input '{name}'")
        facts = _given(file=file, layer=layer, doc=doc, missing=missing, color_space=color_space)
        if not isinstance(default, Keep):
            facts["default"] = default
        changed = replace(self.graph.inputs[name], **facts)
        graph = replace(self.graph, inputs={**self.graph.inputs, name: changed})
        self.edit(f"Set inputs.{name}", _checked(graph, name), merge=merge)

    def set_output(self, name: str, *, layer: str | None = None, view: str | None = None, merge: str = "") -> None:
        """Change how an output is saved and shown; what is not given stays."""
        if name not in self.graph.outputs:
            raise GraphError(f"the graph has no output '{name}'")
        changed = replace(self.graph.outputs[name], **_given(layer=layer, view=view))
        graph = replace(self.graph, outputs={**self.graph.outputs, name: changed})
        self.edit(f"Set outputs.{name}", graph, merge=merge)

    def set_size(self, size: Size | None, merge: str = "") -> None:
        """Set the size of what is made from nothing, in pixels; None for that of the first picture."""
        if size is not None and min(size) < 1:
            raise GraphError(f"the size {size[0]} x {size[1]} has no pixels: give at least 1 x 1")
        settings = replace(self.graph.settings, size=size and (int(size[0]), int(size[1])))
        self.edit("Set size", replace(self.graph, settings=settings), merge=merge)

    def _add_end(self, graph: Graph, key: str, at: Place | None) -> str:
        self.edit(f"Add {key}", with_places(graph, {key: at}) if at else graph, (key,))
        return key

    def _end(self, key: str) -> Port:
        end = end_port(key)
        if end is None or end.socket not in (self.graph.inputs if end.node == INPUTS else self.graph.outputs):
            raise GraphError(f"the graph has no '{key}'")
        return end


def _given(**facts: str | None) -> dict[str, Any]:
    return {name: clean_text(text) for name, text in facts.items() if text is not None}


def _checked(graph: Graph, name: str) -> Graph:
    """`graph`, if the default of that input can be. Raises GraphError."""
    for problem in problems(Graph(inputs={name: graph.inputs[name]}), {}):
        if problem.node == INPUTS:
            raise GraphError(problem.sentence)
    default = graph.inputs[name].default
    if isinstance(default, str | bool):
        raise GraphError(f"input '{name}': the default is a number, or one per channel")
    return graph
