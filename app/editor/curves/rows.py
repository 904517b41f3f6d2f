"""Animated values as rows, grouped by node. Nothing here draws."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from msgspec import Struct

from ...authoring.edits.naming import value_label
from ...errors import GraphError
from ...graph import Animation, Graph, Keys, Port

Spot = tuple[Port, float, int]
"""A channel of a key: the value, its frame, and which number of it."""

Lane = tuple[Port, int]
"""A channel of a value."""

COLORS, VECTORS = "rgba", "xyzw"


class CurveRow(Struct, frozen=True):
    """A value of a node; one without a port is the node, which sums up the rows below it."""

    node: str
    port: Port | None
    label: str
    animation: Animation | None
    ports: tuple[Port, ...]
    """The values in this row."""
    channels: str = ""
    """The letters of the channels; empty for a single number."""

    @property
    def keys(self) -> Keys | None:
        """The keys of the value, or None."""
        return self.animation if isinstance(self.animation, Keys) else None


def make_rows(
    graph: Graph, selection: Collection[str] = (), only: bool = False, folded: Collection[str] = ()
) -> tuple[CurveRow, ...]:
    """A row for every node and every value of it that is animated: selected nodes first, or `only` those."""
    by_node: dict[str, list[Port]] = {}
    for port in graph.animation:
        if port.node in graph.nodes:
            by_node.setdefault(port.node, []).append(port)
    order = {id: place for place, id in enumerate(graph.nodes)}
    curve_rows: list[CurveRow] = []
    for node in sorted(by_node, key=lambda id: (id not in selection, order[id])):
        if only and node not in selection:
            continue
        names = list(_list_value_names(graph, node))
        ports = tuple(sorted(by_node[node], key=lambda port: _make_sort_key(names, port.socket)))
        curve_rows.append(CurveRow(node, None, node, None, ports))
        if node not in folded:
            curve_rows.extend(
                CurveRow(
                    node, port, value_label(graph, port), graph.animation[port], (port,), name_channels(graph, port)
                )
                for port in ports
            )
    return tuple(curve_rows)


def name_channels(graph: Graph, port: Port) -> str:
    """The letters of the channels that a value has; none for one number."""
    try:
        value = graph.declaration(port)
    except GraphError:
        return ""
    if not isinstance(value.default, tuple):
        return ""
    letters = COLORS if value.type == "color" else VECTORS
    return letters[: len(value.default)] if len(value.default) <= 4 else "abcdefghijklmnop"[: len(value.default)]


def count_channels(graph: Graph, port: Port) -> int:
    """The number of channels of a value."""
    return len(name_channels(graph, port)) or 1


def list_spots(port: Port, keys: Keys, frames: Iterable[float] | None = None) -> frozenset[Spot]:
    """All channels of the keys at those frames, or of all."""
    count = max((len(key.channels) for key in keys.keys), default=0) or 1
    return frozenset(
        (port, frame, channel) for frame in (keys.frames if frames is None else frames) for channel in range(count)
    )


def find_limits(graph: Graph, port: Port) -> tuple[float, float]:
    """The smallest and the largest number that a value may have."""
    try:
        value = graph.declaration(port)
    except GraphError:
        return float("-inf"), float("inf")
    return value.minimum, value.maximum


def _list_value_names(graph: Graph, node: str) -> Iterable[str]:
    graph_item = graph.nodes[node]
    return getattr(graph_item, "values", {})


def _make_sort_key(names: list[str], name: str) -> tuple[int, str]:
    return (names.index(name) if name in names else len(names)), name
