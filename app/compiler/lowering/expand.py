"""Replaces groups by their bodies: nested graphs become one flat graph, in which names are paths."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import Any

from halation.nodes import Node, Socket
from msgspec import Struct, field

from ...custom_nodes import CustomNode
from ...errors import GraphError
from ...glsl import GlslText
from ...graph import INPUTS, OUTPUTS, Graph, Group, Input, Port, Unknown, conversion
from ...graph.model import MAX_GROUP_DEPTH
from ...graph.names import pick


class FlatGraph(Struct):
    """A graph without groups. Node names are paths such as `glow/bloom`; an input's node is `<path>/inputs`."""

    nodes: dict[str, Node] = field(default_factory=dict[str, Node])
    links: dict[Port, Port] = field(default_factory=dict[Port, Port])
    inputs: dict[Port, Input] = field(default_factory=dict[Port, Input])
    muted: set[str] = field(default_factory=set[str])
    unknown: dict[str, Unknown] = field(default_factory=dict[str, Unknown])
    faults: dict[Port, str] = field(default_factory=dict[Port, str])
    """Why links are invalid, by target: an error when something follows such a link."""
    folders: dict[str, str] = field(default_factory=dict[str, str])
    reference_heights: dict[str, int] = field(default_factory=dict[str, int])
    """The reference height of bodies that have one, by the prefix of their nodes, such as `glow/`."""
    linked: dict[str, list[str]] = field(default_factory=dict[str, list[str]])
    """The inputs and values that something is linked to, by node."""
    _sources: dict[Port, Port] = field(default_factory=dict[Port, Port])
    """What has been followed already: thousands of links may share a way through many groups."""

    def find_reference_height(self, path: str) -> int | None:
        """The reference height that holds for a node."""
        return self.reference_heights.get(path[: path.rfind("/") + 1]) if self.reference_heights else None

    def find_source(self, port: Port) -> Port | None:
        """What is linked to an input, followed through the ends of groups to a node or a graph input."""
        after = self.links.get(port)
        if after is None or (after not in self.links and port not in self.faults):
            return after  # the usual case: nothing, or an output of a node
        source, visited = port, dict[Port, None]()
        while source in self.links:
            if source in self._sources:
                source = self._sources[source]
                break
            if source in self.faults:
                raise GraphError(self.faults[source], node=source.node)
            if source in visited:
                group = source.node.rpartition("/")[0]
                raise GraphError(f"group '{group}' feeds itself: cut one link of the loop", node=group)
            visited[source] = None
            source = self.links[source]
        self._sources.update(dict.fromkeys(visited, source))
        return source

    def follow(self, end: Port) -> Port:
        """Like `find_source` without checks, for links that were checked before; the end itself if nothing feeds it."""
        if end in self._sources:
            return self._sources[end]
        for _ in range(len(self.links)):
            if end not in self.links:
                break
            end = self.links[end]
        return end


def find_stand_in(output: Socket, inputs: Mapping[str, Socket]) -> str | None:
    """The input that an output of a muted node or group shows: the first of its type, else one that fits."""
    same = (name for name, socket in inputs.items() if (socket.kind, socket.channels) == (output.kind, output.channels))
    fitting = (name for name, socket in inputs.items() if conversion(socket, output) is None)
    return next(chain(same, fitting), None)


def make_zero(socket: Socket) -> float | tuple[float, ...]:
    """Zero in every channel: the value of a muted output that no input can replace."""
    return 0.0 if socket.channels == 1 else (0.0,) * socket.channels


def expand(graph: Graph) -> FlatGraph:
    """Expand every group of `graph`. A group's unlinked input keeps its own default file."""
    flat = FlatGraph()
    # Depth first, with a list in place of recursion: the depth is then an error that names the group.
    todo: list[tuple[str, Graph, Mapping[str, Any]]] = [("", graph, {})]
    while todo:
        prefix, body, values = todo.pop()
        if prefix.count("/") > MAX_GROUP_DEPTH:
            group = prefix.rstrip("/")
            fault = f"group '{group}': groups nest deeper than {MAX_GROUP_DEPTH}; flatten some of them"
            raise GraphError(fault, node=group)
        body = _set_controls(body, values)
        flat.folders[prefix] = body.folder
        if body.settings.reference_height:
            flat.reference_heights[prefix] = body.settings.reference_height
        for name, socket in body.inputs.items():
            flat.inputs[Port(prefix + INPUTS, name)] = socket
        for name, item in body.nodes.items():
            path = prefix + name
            if isinstance(item, Group) and name in body.muted:
                _mute(flat, path + "/", item.graph)
            elif isinstance(item, Group):
                todo.append((path + "/", item.graph, item.values))
            elif isinstance(item, Unknown):
                flat.unknown[path] = item
            else:
                flat.nodes[path] = item
                flat.folders[path] = body.folder
                if name in body.muted:
                    flat.muted.add(path)
        for target, source in body.links.items():
            inner_target = _enter_groups(body, prefix, target)
            flat.linked.setdefault(inner_target.node, []).append(inner_target.socket)
            flat.links[inner_target] = _leave_group(body, prefix, source)
            if fault := body.link_faults.get(target):
                place = f"in group '{prefix.rstrip('/')}': " if prefix else ""
                flat.faults[inner_target] = f"{place}'{source}' cannot feed '{target}': {fault}"
    return flat


def find_changed_nodes(before: Graph, after: Graph, prefix: str = "") -> dict[str, Node] | None:
    """The nodes whose values differ, by path, if two graphs differ in nothing else that changes pixels; else None.

    Graphs are immutable and an edit keeps the parts that it does not change, so that comparing identities is enough.
    """
    parts = ("links", "inputs", "outputs", "controls", "muted", "settings")
    is_same = all(getattr(before, part) is getattr(after, part) for part in parts) and before.folder == after.folder
    is_animated = before.animation is not after.animation and (before.animation or after.animation)
    if not is_same or is_animated or [*before.nodes] != [*after.nodes]:
        return None
    changed: dict[str, Node] = {}
    for id, item in after.nodes.items():
        old = before.nodes[id]
        if item is old:
            continue
        if isinstance(item, Node) and type(item) is type(old):
            changed[prefix + id] = item
        elif isinstance(item, Group) and isinstance(old, Group) and id not in after.muted:
            try:
                bodies = [_set_controls(group.graph, group.values) for group in (old, item)]
                inner = find_changed_nodes(bodies[0], bodies[1], f"{prefix}{id}/")
            except GraphError:
                return None
            if inner is None:
                return None
            changed |= inner
        else:
            return None
    return changed


def _set_controls(body: Graph, values: Mapping[str, Any]) -> Graph:
    """The body of a group with its controls set to values."""
    targets = {name: pick(body.controls, name, "the graph has no control").target for name in values}
    return body.put_all({target: body.fit(target, values[name]) for name, target in targets.items()})


def _enter_groups(body: Graph, prefix: str, target: Port) -> Port:
    """Where a link to this target ends in the flat graph: at the group's input, or at the value that a control sets."""
    item = body.nodes.get(target.node)
    if not prefix and not isinstance(item, Group):
        return target
    while isinstance(item, Group):
        prefix += target.node + "/"
        if target.socket in item.graph.inputs:
            return Port(prefix + INPUTS, target.socket)
        control = item.graph.controls.get(target.socket)
        if control is None:
            break
        target, item = control.target, item.graph.nodes.get(control.target.node)
    return Port(prefix + target.node, target.socket)


def _leave_group(body: Graph, prefix: str, source: Port) -> Port:
    """Where a link from this source starts in the flat graph: at the group's own output."""
    if isinstance(body.nodes.get(source.node), Group):
        return Port(f"{prefix}{source.node}/{OUTPUTS}", source.socket)
    return Port(prefix + source.node, source.socket) if prefix else source


def _mute(flat: FlatGraph, prefix: str, body: Graph) -> None:
    """Link the outputs of a muted group to its inputs, without its body."""
    flat.folders[prefix] = body.folder
    inputs = {name: end.socket(name) for name, end in body.inputs.items()}
    for name, end in body.inputs.items():
        flat.inputs[Port(prefix + INPUTS, name)] = end
    for name, end in body.outputs.items():
        stand_in, port = find_stand_in(end.socket(name), inputs), Port(prefix + OUTPUTS, name)
        if stand_in is not None:
            flat.links[port] = Port(prefix + INPUTS, stand_in)
        else:
            flat.inputs[port] = Input(end.kind, end.width, default=make_zero(end.socket(name)))


def find_custom_texts(graph: Graph) -> Iterator[GlslText]:
    """The code of the nodes that users wrote, groups included."""
    for item in graph.nodes.values():
        if isinstance(item, Group):
            yield from find_custom_texts(item.graph)
        elif isinstance(item, CustomNode) and item.text is not None:
            yield item.text
