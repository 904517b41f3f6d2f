"""What the viewer shows, on its sides A and B."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Port, signature
from ..edits.elements import end_port, with_sections
from ..edits.folding import body_at
from .state import State

Side = Literal["A", "B"]

NUMBERS = range(1, 10)
"""The keys that recall a port."""


class Viewing(State):
    """Which port is looked at. Every graph, groups too, has its own; it is no part of the document."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._wanted: dict[tuple[tuple[str, ...], Side], tuple[Port, ...]] = {}

    def view(self, port: Port, side: Side = "A") -> None:
        """Show an output of a node, or an end of the graph, on one side."""
        if not _exists(self.graph, port):
            raise GraphError(f"there is no '{port}' to show")
        self._wanted[self.place, side] = (port,)
        self._touch()

    def view_nothing(self, side: Side = "B") -> None:
        """Let a side show what it shows by itself: nothing on B."""
        self._wanted.pop((self.place, side), None)
        self._touch()

    def viewed(self, side: Side = "A") -> Port | None:
        """The port of `graph` that a side shows.

        A port that vanished comes back with it. Meanwhile, and where nobody chose one, A shows the first output of
        the graph, else the last node, and B nothing.
        """
        wanted = self._wanted.get((self.place, side), ())
        found = next((port for port in wanted if _exists(self.graph, port)), None)
        return found or (self._kept("fallback", (self.graph,), lambda: _fallback(self.graph)) if side == "A" else None)

    def viewed_in_root(self, side: Side = "A") -> Port | None:
        """The same port as the document calls it, groups on the way included: `glow/blur.out`."""
        port, place = self.viewed(side), self.place
        while port and port.node == INPUTS and place:
            outer = body_at(self.root, place[:-1]).links.get(Port(place[-1], port.socket))
            if outer is None:
                break
            port, place = outer, place[:-1]
        return port and Port("/".join((*place, port.node)), port.socket)

    def view_node(self, id: str, side: Side = "A") -> None:
        """Show a node's first output, or the one after that which is shown; an end by its key."""
        if end := end_port(id):
            self.view(end, side)
            return
        ports = _outputs(self.graph, id)
        if not ports:
            raise GraphError(f"node '{id}' has no output to show")
        now = self.viewed(side) if (self.place, side) in self._wanted else None
        self.view(ports[(ports.index(now) + 1) % len(ports)] if now in ports else ports[0], side)

    def assign_viewer(self, number: int, port: Port | None = None) -> None:
        """Let a key from 1 to 9 show a port: the one given, else the active element's, else the one shown on A."""
        if number not in NUMBERS:
            raise GraphError(f"there is no viewer {number}: choose 1 to 9")
        port = port or self._active_port() or self.viewed()
        if port is None or not _exists(self.graph, port):
            raise GraphError("there is nothing to show: select a node first")
        known = self.graph.ui.get("viewers")
        viewers = {**(known if isinstance(known, Mapping) else {}), str(number): str(port)}
        self.edit(f"Assign viewer {number}", with_sections(self.graph, {"viewers": viewers}))
        self.view(port)

    def recall_viewer(self, number: int, side: Side = "A") -> None:
        """Show what a key stands for."""
        if number not in self.viewers:
            raise GraphError(f"nothing is assigned to viewer {number}: select a node and assign it first")
        self.view(self.viewers[number], side)

    @property
    def viewers(self) -> Mapping[int, Port]:
        """The ports that keys 1 to 9 stand for."""
        known, found = self.graph.ui.get("viewers"), dict[int, Port]()
        for number in NUMBERS:
            text = known.get(str(number)) if isinstance(known, Mapping) else None
            node, dot, socket = text.partition(".") if isinstance(text, str) else ("", "", "")
            if dot and _exists(self.graph, Port(node, socket)):
                found[number] = Port(node, socket)
        return MappingProxyType(found)

    def _active_port(self) -> Port | None:
        if end := end_port(self.active):
            return end
        ports = _outputs(self.graph, self.active) if self.active in self.graph.nodes else []
        return ports[0] if ports else None

    def _restart(self, root: Graph, path: Path | None, saved: Graph | None) -> None:
        self._wanted = {}
        super()._restart(root, path, saved)

    def _renamed(self, old: str, new: str) -> None:
        """Follow a node or end to its new key; the old one stays for when that is undone."""
        super()._renamed(old, new)

        def moved(port: Port) -> Port:
            return end_port(new) or Port(new, port.socket) if old in (port.node, str(port)) else port

        for key, ports in self._wanted.items():
            if key[0] == self.place:
                self._wanted[key] = tuple(dict.fromkeys((*(moved(port) for port in ports), *ports)))


def _outputs(graph: Graph, id: str) -> list[Port]:
    return [Port(id, name) for name in signature(graph.node(id)).outputs]


def _exists(graph: Graph, port: Port) -> bool:
    if port.node == INPUTS:
        return port.socket in graph.inputs
    if port.node == OUTPUTS:
        return port.socket in graph.outputs
    return port.node in graph.nodes and port.socket in signature(graph.nodes[port.node]).outputs


def _fallback(graph: Graph) -> Port | None:
    """The first output that shows something, else the last node's, else an input."""
    for name in graph.outputs:
        if Port(OUTPUTS, name) in graph.links:
            return Port(OUTPUTS, name)
    try:
        order = graph.order()
    except GraphError:
        order = tuple(graph.nodes)
    ports = (port for id in reversed(order) for port in _outputs(graph, id))
    return next(ports, None) or next((Port(INPUTS, name) for name in graph.inputs), None)
