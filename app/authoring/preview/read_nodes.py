"""Whether two graphs show the same pictures at some ports, in every frame: they may differ in what nothing reads.

Nodes are followed from the ports upwards, through links and the names in expressions, and into groups. The first
picture of a graph without a size decides the size of all, so sources of pictures count as read there.

`UpstreamHashes` of the compiler answers another question: which thumbnails an edit has made old, at every node at once.
It could answer this one as well, but it is slower than comparing parts of immutable graphs, which are mostly the same
objects, and a dragged value waits for the answer. For a chain of 300 nodes whose first one changes it takes 5.5 ms
instead of 1.3, with keys 12 instead of 0.5 (medians on four cores). Thumbnails are drawn when nothing else is to do.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from halation.nodes import Source

from ...graph import OUTPUTS, Expression, Graph, Group, Port
from ...graph.graph import Item


def shows_same_pictures(before: Graph, after: Graph, ports: Collection[Port]) -> bool:
    """True if these ports, by the paths of their nodes, have the same pixels in both graphs in every frame."""
    if before is after:
        return True  # another frame of the same graph, as in playback
    return (before.settings, before.folder) == (after.settings, after.folder) and _has_same_parts(
        before, after, ports, has_size=after.settings.size is not None
    )


def _has_same_parts(before: Graph, after: Graph, ports: Collection[Port], has_size: bool) -> bool:
    nodes = list_read_nodes(after, ports, has_size)
    if nodes != list_read_nodes(before, ports, has_size):
        return False
    ends = {port for port in ports if port.node == OUTPUTS}
    return (
        (before.inputs, before.outputs, before.controls) == (after.inputs, after.outputs, after.controls)
        and before.settings.reference_height == after.settings.reference_height
        and before.muted & nodes == after.muted & nodes
        and _select_links(before, nodes, ends) == _select_links(after, nodes, ends)
        and _select_animations(before, nodes) == _select_animations(after, nodes)
        and all(
            _is_same_item(before.nodes.get(name), after.nodes.get(name), _find_inner_ports(name, ports), has_size)
            for name in nodes
        )
    )


def list_read_nodes(graph: Graph, ports: Collection[Port], has_size: bool = True) -> frozenset[str]:
    """The nodes on which ports of a graph depend; those of groups count as their group."""
    nodes = set[str]()
    pending = [name for name, item in graph.nodes.items() if not has_size and _has_source(item)]
    for port in ports:
        start = graph.links.get(port) if port.node == OUTPUTS else port
        pending += [start.node.partition("/")[0]] if start else []
    sources: dict[str, list[str]] = {}
    for target, source in graph.links.items():
        sources.setdefault(target.node, []).append(source.node)
    for port, animation in graph.animation.items():
        if isinstance(animation, Expression):
            sources.setdefault(port.node, []).extend(_find_owners(graph, animation))
    while pending:
        name = pending.pop()
        if name in nodes or name not in graph.nodes:
            continue
        nodes.add(name)
        pending += sources.get(name, [])
    return frozenset(nodes)


def _find_owners(graph: Graph, expression: Expression) -> Iterator[str]:
    """The nodes whose values an expression reads, by name or through a control."""
    for name in expression.names:
        control = graph.controls.get(name)
        yield control.target.node if control else name.partition(".")[0]


def _select_links(graph: Graph, nodes: frozenset[str], ends: Collection[Port]) -> dict[Port, Port]:
    return {target: source for target, source in graph.links.items() if target.node in nodes or target in ends}


def _select_animations(graph: Graph, nodes: frozenset[str]) -> dict[Port, object]:
    return {port: animation for port, animation in graph.animation.items() if port.node in nodes}


def _find_inner_ports(name: str, ports: Collection[Port]) -> list[Port]:
    """The ports inside of a group, by their paths from there."""
    start = f"{name}/"
    return [Port(port.node.removeprefix(start), port.socket) for port in ports if port.node.startswith(start)]


def _is_same_item(before: Item | None, after: Item | None, inner_ports: Collection[Port], has_size: bool) -> bool:
    """True if two nodes are the same; of groups, what their outputs and the given ports inside of them read."""
    if before is after:
        return True
    if not (isinstance(before, Group) and isinstance(after, Group)):
        return before == after
    if (before.path, before.values) != (after.path, after.values) or before.graph.settings != after.graph.settings:
        return False
    ends = [Port(OUTPUTS, name) for name in after.graph.outputs]
    return before.graph.folder == after.graph.folder and _has_same_parts(
        before.graph, after.graph, [*ends, *inner_ports], has_size
    )


def _has_source(item: Item) -> bool:
    """True if a node, or one inside of a group, may read a picture."""
    if isinstance(item, Group):
        has_file = any(end.file for end in item.graph.inputs.values())
        return has_file or any(map(_has_source, item.graph.nodes.values()))
    return isinstance(item, Source)
