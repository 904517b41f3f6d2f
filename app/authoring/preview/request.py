"""Preview requests: which ports panels want to show."""

from __future__ import annotations

from collections.abc import Mapping, Set
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from halation.nodes import Kind, Size
from msgspec import Struct, field
from msgspec.structs import replace

from ...compiler import Region, UpstreamHashes
from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Group, Port, signature
from ...renderer import RenderRequest
from .frame_cache import FrameCache
from .read_nodes import shows_same_pictures

if TYPE_CHECKING:
    from ...inputs.provider import Binding


class PreviewRequest(Struct, eq=False):
    """Ports of a graph that panels want to show, by the panels' names. `world` counts changes outside of the graph."""

    graph: Graph
    ports: Mapping[str, Port]
    bindings: Mapping[str, Binding]
    scale: float
    frame: int
    size: Size | None
    outside_version: int = 0
    upstream: UpstreamHashes | None = None
    """What each node depends on, in this graph or in an earlier one."""
    frame_cache: FrameCache = field(default_factory=FrameCache)
    """The cached frames of this graph."""
    whole: Set[str] = frozenset()
    """The panels that show pixels beyond the frame as well."""

    def render_request(self, ports: Mapping[str, Port], frame: int, region: Region | None = None) -> RenderRequest:
        """The request as the renderer takes it."""
        whole = frozenset(self.whole & ports.keys())
        return RenderRequest(self.bindings, ports, self.size, self.scale, frame, region=region, whole=whole)

    def has_same_frames(self, before: PreviewRequest) -> bool:
        """True if every frame shows the same: the graphs may differ in what nothing reads."""
        return (
            (self.ports, self.scale, self.whole) == (before.ports, before.scale, before.whole)
            and replace(self, frame=before.frame).has_same_outside(before)
            and shows_same_pictures(before.graph, self.graph, self.ports.values())
        )

    def wants_same_pixels(self, request: PreviewRequest) -> bool:
        """True if both requests give the same pixels; layout does not matter."""
        return (
            (self.ports, self.scale, self.whole) == (request.ports, request.scale, request.whole)
            and self.has_same_outside(request)
            and (self.graph is request.graph or _pixel_facts(self.graph) == _pixel_facts(request.graph))
        )

    def has_same_outside(self, request: PreviewRequest) -> bool:
        """True if files, bindings and settings from outside of the graph are the same."""
        return (
            (self.frame, self.size) == (request.frame, request.size)
            and self.bindings.keys() == request.bindings.keys()
            and all(_is_same_binding(item, request.bindings[name]) for name, item in self.bindings.items())
        )

    def node_mark(self, path: str) -> object:
        """A value that changes when anything upstream of a node changes."""
        if self.upstream is None or self.upstream.graph is not self.graph:
            self.upstream = UpstreamHashes(self.graph, before=self.upstream)
        return self.upstream.hashes.get(path), self.outside_version


def _pixel_facts(graph: Graph) -> tuple[Any, ...]:
    """The parts of a graph that pixels depend on."""
    return (
        graph.nodes,
        graph.links,
        graph.inputs,
        graph.outputs,
        graph.controls,
        graph.animation,
        graph.settings,
        graph.muted,
        graph.folder,
    )


def _is_same_binding(first: Binding, second: Binding) -> bool:
    """True if two bindings are the same; arrays by identity, since comparing pixels in every frame is slow."""
    plain = (str, PurePath, float, int, tuple)
    return first is second or (isinstance(first, plain) and isinstance(second, plain) and first == second)


def canvas_path(port: Port) -> str:
    """The path of a port's element on the canvas: inputs are elements of their own."""
    return f"{port}" if port.node.rpartition("/")[2] == INPUTS else port.node


def find_output_place(graph: Graph, port: Port) -> int:
    """Which of the outputs of its node a port is, from 0; 0 for the ends of a graph."""
    graph, port = _enter_groups(graph, port)
    item = graph.nodes.get(port.node)
    names = list(signature(item).outputs) if item is not None else []
    return names.index(port.socket) if port.socket in names else 0


def _enter_groups(graph: Graph, port: Port) -> tuple[Graph, Port]:
    """The innermost graph that the path of a port leads to, and the port inside it."""
    *groups, last = port.node.split("/")
    for name in groups:
        item = graph.nodes.get(name)
        if not isinstance(item, Group):
            break
        graph = item.graph
    return graph, Port(last, port.socket)


def pixel_kind(graph: Graph, port: Port, channels: int) -> Kind:
    """The kind of pixels of a port."""
    graph, port = _enter_groups(graph, port)
    try:
        socket = graph.target(port) if port.node == OUTPUTS else graph.source(port)
    except GraphError:
        socket = None
    kind = getattr(socket, "kind", None)
    if isinstance(kind, Kind):
        return kind
    return Kind.FIELD if channels == 1 else Kind.IMAGE if channels == 4 else Kind.VECTOR
