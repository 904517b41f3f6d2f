"""Random graphs for property tests: any nodes of the catalogue, wired in any way that fits."""

from __future__ import annotations

from random import Random

import numpy as np
from halation.graph import Graph, Input, Output, Port, signature
from halation.nodes import Kind, Node, Pointwise, Source, Temporal, catalogue, look_at

SIZE = (37, 23)
CLASSES = [node for node in catalogue().values() if not issubclass(node, Source)]


def random_node(rng: Random, node: type[Node] | None = None) -> Node:
    """A node, of any class unless one is given, with values anywhere in their soft ranges."""
    node = node or rng.choice(CLASSES)
    values = {}
    for value in node.values.values():
        if value.type == "choice":
            values[value.name] = rng.choice(value.choices)
        elif value.type == "bool":
            values[value.name] = rng.random() < 0.5
        elif value.unit is not None and value.type in ("float", "int"):
            low, high = max(value.low, value.minimum), min(value.high, value.maximum)
            number = rng.uniform(low, high)
            values[value.name] = round(number) if value.type == "int" else number
    return node(**values)


def random_graph(seed: int, length: int = 10) -> Graph:
    """A graph of `length` nodes over pictures of every type and a camera; every loose end is an output."""
    rng = Random(seed)
    graph = Graph(
        inputs={
            "image": Input(Kind.IMAGE),
            "field": Input(Kind.FIELD),
            "vector": Input(Kind.VECTOR, 2),
            "normal": Input(Kind.VECTOR, 3),
            "motion": Input(Kind.VECTOR, 4),
            "camera": Input(Kind.CAMERA, default=look_at((1.0, -5.0, 2.0), (0.0, 0.0, 0.5), (1.2, 1.9)).rows),
        }
    )
    for index in range(length):
        name, node = f"n{index}", random_node(rng)
        graph = graph.add(name, node)
        face = signature(node)
        wires = [
            value
            for value in face.values
            if face.pointwise and not takes_passes(node) and face.values[value].wireable and rng.random() < 0.15
        ]
        for target in [*face.inputs, *wires]:
            fitting = [
                port
                for port in sources(graph, name)
                if graph.link_fault(port, Port(name, target)) is None
                and not (looks_around(node) and remembers(graph, port.node))
            ]
            if fitting and (target in wires or not face.inputs[target].optional or rng.random() < 0.7):
                # Late nodes are more likely, so that chains grow long.
                graph = graph.connect(fitting[-1 - int(len(fitting) * rng.random() ** 3)], Port(name, target))
    read = set(graph.links.values())
    sockets = {port: graph.source(port) for port in sources(graph, "") if port not in read and port.node != "inputs"}
    loose = [(port, socket) for port, socket in sockets.items() if socket and socket.kind is not Kind.CAMERA]
    for number, (port, socket) in enumerate(loose[-4:]):
        kind = {Kind.NUMBER: Kind.FIELD, Kind.COLOR: Kind.IMAGE}.get(socket.kind, socket.kind)
        name = f"o{number}"
        graph = graph.add_output(name, Output(kind, socket.channels)).connect(port, Port("outputs", name))
    return graph


def takes_passes(node: Node) -> bool:
    """True if it is not drawn pixel by pixel at these values, so that none of them can be a picture."""
    return isinstance(node, Pointwise) and node.takes_passes()


def looks_around(node: Node) -> bool:
    """True if it may see other frames, which nothing that remembers can show."""
    return type(node).times is not Node.times


def remembers(graph: Graph, id: str) -> bool:
    """True if a node, or one before it, has a memory."""
    return id in graph.nodes and any(isinstance(graph.nodes[one], Temporal) for one in {id, *graph.upstream(id)})


def sources(graph: Graph, but: str) -> list[Port]:
    """Everything that a link may start from."""
    ports = [Port("inputs", name) for name in graph.inputs]
    for name in graph.nodes:
        if name != but:
            ports += [Port(name, output) for output in signature(graph.nodes[name]).outputs]
    return ports


def pictures(seed: int) -> dict[str, np.ndarray]:
    """HDR noise; the vector is a displacement."""
    rng = np.random.default_rng(seed)
    width, height = SIZE
    return {
        "image": rng.gamma(0.6, 1.0, (height, width, 4)).astype(np.float32),
        "field": rng.random((height, width), np.float32),
        "vector": rng.normal(0.0, 1.0, (height, width, 2)).astype(np.float32),
        "normal": rng.normal(0.0, 1.0, (height, width, 3)).astype(np.float32),
        "motion": rng.normal(0.0, 2.0, (height, width, 4)).astype(np.float32),
    }
