"""Values of nodes, and controls: values that the graph shows under names of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from halation.nodes import Node, Plain

from ...errors import GraphError
from ...graph import Control, Graph, Group, Port, signature
from ...graph.names import fresh_name
from ..edits.elements import clean_text
from .animating import Animating


class Values(Animating):
    """What a person turns."""

    def value(self, port: Port) -> Plain:
        """What a value of a node, or a control of a group, is set to, whatever changes it over time."""
        return self.graph.value(port)

    def set(self, port: Port, value: object, merge: str = "") -> None:
        """Set a value, or where it has keys a key at `frame`; equal `merge` tokens in a row make one step."""
        if keys := self._with_key(port, self._fitted(port, value)):
            self.animate(port, keys, f"Key {port}", merge)
            return
        fitted = clean_text(value) if isinstance(value, str) else self._fitted(port, value)
        self.edit(f"Set {port}", self.graph.set(port, fitted), merge=merge)

    def set_all(self, values: Mapping[Port, object], label: str, merge: str = "") -> None:
        """The same for several values, as one step."""
        graph = self.graph
        for port, given in values.items():
            value = self._fitted(port, given)
            keys = self._with_key(port, value)
            graph = graph.animate(port, keys) if keys else graph.set(port, value)
        self.edit(label, graph, merge=merge)

    def reset(self, port: Port) -> None:
        """Set a value back to its default, for all frames."""
        self.edit(f"Reset {port}", self._without(self.graph, port))

    def reset_all(self, id: str) -> None:
        """Set all values of a node back to their defaults."""
        graph = self.graph
        for name in signature(graph.node(id)).values:
            graph = self._without(graph, Port(id, name))
        self.edit(f"Reset {id}", graph)

    def is_default(self, port: Port) -> bool:
        """True if a value is as it is in a new node, at all frames."""
        still = port not in self.graph.animation
        return still and self.graph.value(port) == self._without(self.graph, port).value(port)

    def linked(self, port: Port) -> Port | None:
        """What is linked to an input or value, if anything."""
        return self.graph.links.get(port)

    def expose(self, port: Port, name: str = "") -> str:
        """Show a value as a control of the graph; returns its name, by default that of the value."""
        if known := self.control_of(port):
            raise GraphError(f"'{port}' is the control '{known}' already")
        name = name or fresh_name(port.socket, {*self.graph.controls, *self.graph.inputs})
        item = self.graph.node(port.node)
        label = signature(item).values[port.socket].label if port.socket in signature(item).values else ""
        self.edit(f"Expose {port}", self.graph.add_control(name, Control(port, label)))
        return name

    def hide(self, name: str) -> None:
        """Remove a control; the value stays as it is."""
        self.edit(f"Hide {name}", self.graph.remove_control(name))

    def control_of(self, port: Port) -> str | None:
        """The control that shows a value, if any."""
        return next((name for name, item in self.graph.controls.items() if item.target == port), None)

    def rename_control(self, old: str, new: str) -> None:
        """Give a control another name."""
        moves = {Port("controls", old): Port("controls", new)}
        self.edit(f"Rename {old} to {new}", self.graph.rename_control(old, new), moves=moves)

    def set_control_doc(self, name: str, label: str | None = None, doc: str | None = None, merge: str = "") -> None:
        """Set the label or the tooltip of a control; None leaves it."""
        if name not in self.graph.controls:
            raise GraphError(f"the graph has no control '{name}'")
        found = {key: clean_text(text) for key, text in (("label", label), ("doc", doc)) if text is not None}
        item = replace(self.graph.controls[name], **found)
        self.edit(f"Describe {name}", replace(self.graph, controls={**self.graph.controls, name: item}), merge=merge)

    def _fitted(self, port: Port, value: object) -> object:
        """A color as the value takes it: pickers make four numbers, which is one too many for a color without alpha."""
        item = self.graph.nodes.get(port.node)
        declared = None if item is None else signature(item).values.get(port.socket)
        rgb = declared is not None and declared.type == "color" and declared.length == 3
        return value[:3] if rgb and isinstance(value, tuple) and len(value) == 4 else value

    @staticmethod
    def _without(graph: Graph, port: Port) -> Graph:
        """`graph` with a value at its default."""
        graph.value(port)
        graph = graph.animate(port, None) if port in graph.animation else graph
        item = graph.node(port.node)
        if isinstance(item, Group):
            values = {name: plain for name, plain in item.values.items() if name != port.socket}
            return replace(graph, nodes={**graph.nodes, port.node: replace(item, values=values)})
        return graph.put(port, item.values[port.socket].default) if isinstance(item, Node) else graph
