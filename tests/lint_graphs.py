"""Chains of nodes for the tests of rules."""

from __future__ import annotations

from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind, catalogue

NODES = catalogue()

TURN, MOVE = ("transform", {"rotation": 20.0}), ("transform", {"position": (9.5, 3.0)})
DIM, TONE, BLOOM = ("grade", {"gain": (0.5, 0.5, 0.5, 1.0)}), ("tone_map", {}), ("bloom", {})
HALF, DOUBLE = ("resize", {"scale": (0.5, 0.5)}), ("resize", {"scale": (2.0, 2.0)})
SOFT, STILL = ("gaussian_blur", {"sigma": 3.0}), ("transform", {})
WRAPPED = ("transform", {"rotation": 5.0, "edge": "wrap"})
NEAREST = ("transform", {"rotation": 5.0, "kernel": "nearest"})


def chain(*steps: tuple[str, dict], file: str = "", layer: str = "", kind: Kind = Kind.IMAGE) -> Graph:
    """beauty -> a -> b -> c ... -> image, each step the type and the values of a node."""
    graph = Graph(inputs={"beauty": Input(kind, file=file, layer=layer)}, outputs={"image": Output()})
    before = Port("inputs", "beauty")
    for id, (kind_of, values) in zip("abcdefg", steps, strict=False):
        node = NODES[kind_of](**values)
        graph = graph.add(id, node).connect(before, Port(id, next(iter(node.inputs))))
        before = Port(id, "out")
    return graph.connect(before, Port("outputs", "image"))
