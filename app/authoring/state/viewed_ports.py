"""Which port each side of the viewer shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from ...errors import GraphError
from ...graph import INPUTS, Port
from ...language.translation import translate
from ..edits import folding
from ..edits.element_id import ElementId
from ..edits.folding import GroupPath
from ..edits.ports import default_view, is_viewable, list_numbered_ports, output_ports
from .document_state import DocumentState
from .memo import Memo

Side = Literal["A", "B"]
"""The two sides of the viewer."""


class ViewedPorts:
    """The ports that the viewer shows. Every graph, groups too, has its own.

    Only the keys 1 to 9 are saved with the document; which port is shown is not.
    """

    def __init__(self, document: DocumentState) -> None:
        self._document = document
        self._chosen: dict[tuple[GroupPath, Side], tuple[Port, ...]] = {}
        """For each graph and side the port that was chosen, then what counts where that is not there: the names that
        it had before it was renamed, and the ports that it followed."""
        self._memo = Memo()

    def find_port(self, side: Side = "A") -> Port | None:
        """The port of the current graph that a side of the viewer shows.

        A port that vanished comes back with it. Until then, and where the user chose none, A shows the first output of
        the graph, else the last node, and B nothing.
        """
        graph = self._document.graph
        chosen = self._chosen.get((self._document.place, side), ())
        port = next((port for port in chosen if is_viewable(graph, port)), None)
        if port is None and side == "A":
            return self._memo.get("default view", (graph,), lambda: default_view(graph))
        return port

    def find_root_port(self, side: Side = "A") -> Port | None:
        """The port that a side shows, as the whole document calls it: `glow/blur.out` in the group `glow`."""
        port, place = self.find_port(side), self._document.place
        while port and port.node == INPUTS and place:
            outer = folding.body_at(self._document.root, place[:-1]).links.get(Port(place[-1], port.socket))
            if outer is None:
                break
            port, place = outer, place[:-1]
        return port and Port("/".join((*place, port.node)), port.socket)

    def show(self, port: Port, side: Side = "A") -> None:
        """Show an output of a node, or an end of the graph, on one side of the viewer."""
        if not is_viewable(self._document.graph, port):
            raise GraphError(translate("there is no '{port}' to show", port=port))
        self._chosen[self._document.place, side] = (port,)
        self._document.revision += 1

    def follow(self, successor: Port) -> None:
        """Show what comes in the place of the port that the user chose on side A; if it vanishes, that comes back."""
        key = self._document.place, "A"
        if chosen := self._chosen.get(key):
            self._chosen[key] = (successor, *chosen)
            self._document.revision += 1

    def show_element(self, element: ElementId, side: Side = "A") -> None:
        """Show a node's first output, or the one after that which is shown; an input or output of the graph itself."""
        if end := element.port:
            self.show(end, side)
            return
        ports = output_ports(self._document.graph, element)
        if not ports:
            raise GraphError(translate("node '{element}' has no output to show", element=element))
        port = self.find_port(side) if (self._document.place, side) in self._chosen else None
        self.show(ports[(ports.index(port) + 1) % len(ports)] if port in ports else ports[0], side)

    def clear(self, side: Side = "B") -> None:
        """Let a side show what it shows by default: nothing on B."""
        self._chosen.pop((self._document.place, side), None)
        self._document.revision += 1

    @property
    def numbered_ports(self) -> Mapping[int, Port]:
        """The ports that the keys 1 to 9 show."""
        return list_numbered_ports(self._document.graph)

    def recall(self, number: int, side: Side = "A") -> None:
        """Show the port that a number key is assigned to."""
        if number not in self.numbered_ports:
            raise GraphError(
                translate("nothing is assigned to viewer {number}: select a node and assign it first", number=number)
            )
        self.show(self.numbered_ports[number], side)

    def follow_rename(self, old: ElementId, new: ElementId) -> None:
        """Show an element under its new name too; the old name stays for when the renaming is undone."""

        def rename(port: Port) -> Port:
            return new.port or Port(new, port.socket) if old in (port.node, str(port)) else port

        for key, ports in self._chosen.items():
            if key[0] == self._document.place:
                self._chosen[key] = tuple(dict.fromkeys((*map(rename, ports), *ports)))

    def reset(self) -> None:
        """Forget what was chosen: another document is open."""
        self._chosen = {}
        self._memo.clear()
