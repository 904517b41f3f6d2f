"""Graphs that people work on: random ones with everything that a document can hold, and random edits of them."""

from __future__ import annotations

import dataclasses
from random import Random

from halation.document import dumps, loads
from halation.errors import GraphError
from halation.graph import Control, Expression, Graph, Group, Input, Key, Keys, Port, Unknown, signature
from halation.nodes import Kind
from random_graphs import random_graph, random_node, sources


def make_graph(seed: int) -> Graph:
    """Wired at random, with a group, controls, keys, an expression, a node of unknown type and a layout."""
    rng = Random(seed)
    graph = random_graph(seed, rng.randint(2, 7))
    graph = graph.add("inner", Group(random_graph(seed + 1, 3)))
    graph = graph.add("odd", Unknown("from_elsewhere", {"version": 3, "knobs": {"a": 1, "b": [1, 2]}}))
    for _ in range(6):
        graph = edit_randomly(rng, graph)
    places = {id: {"x": rng.randint(0, 900), "y": rng.randint(0, 900)} for id in graph.nodes}
    return parse_graph(dumps(dataclasses.replace(graph, ui={"nodes": places}, extra={"": {"later": {"deep": [1]}}})))


def edit_randomly(rng: Random, graph: Graph) -> Graph:
    """One edit that a person could make; the same graph where it is refused."""
    try:
        return _edit(rng, graph)
    except GraphError:
        return graph


def parse_graph(text: str) -> Graph:
    """A graph as versions are compared: from its text alone."""
    return loads(text, sandbox=None)


def _edit(rng: Random, graph: Graph) -> Graph:
    id = rng.choice([*graph.nodes])
    item, face = graph.nodes[id], signature(graph.nodes[id])
    numbers = [name for name, value in face.values.items() if value.type == "float"]
    match rng.choice(
        (
            "set",
            "set",
            "link",
            "unlink",
            "add",
            "remove",
            "rename",
            "mute",
            "move",
            "keys",
            "inside",
            "control",
            "end",
            "expression",
            "settings",
            "replace",
        )
    ):
        case "set" if numbers:
            name = rng.choice(numbers)
            value = face.values[name]
            low, high = max(value.low, value.minimum, -9.0), min(value.high, value.maximum, 9.0)
            return graph.put(Port(id, name), rng.uniform(low, max(low, high)))
        case "link":
            ends = [Port(id, name) for name in face.inputs] or [Port("outputs", name) for name in graph.outputs]
            return graph.connect(rng.choice(sources(graph, id)), rng.choice(ends)) if ends else graph
        case "unlink" if graph.links:
            return graph.disconnect(rng.choice([*graph.links]))
        case "add":
            return graph.add(graph.fresh_id(rng.choice("abcdefgh")), random_node(rng))
        case "remove" if len(graph.nodes) > 2:
            return graph.remove(id, heal=rng.random() < 0.7)
        case "rename":
            return graph.rename(id, graph.fresh_id(rng.choice("uvwxyz")))
        case "mute":
            return graph.mute(id, id not in graph.muted)
        case "move":
            nodes = {**graph.ui.get("nodes", {}), id: {"x": rng.randint(0, 900), "y": 5}}
            return dataclasses.replace(graph, ui={**graph.ui, "nodes": nodes})
        case "keys" if numbers:
            frames = rng.sample(range(1, 9), 3)
            keys = Keys(tuple(Key(frame, rng.random()) for frame in sorted(frames)))
            return graph.animate(Port(id, rng.choice(numbers)), keys)
        case "expression" if numbers:
            return graph.animate(Port(id, rng.choice(numbers)), Expression("0.1 * frame"))
        case "inside" if isinstance(item, Group):
            body = dataclasses.replace(item, graph=edit_randomly(rng, item.graph))
            return dataclasses.replace(graph, nodes={**graph.nodes, id: body})
        case "control" if numbers:
            name = rng.choice("klm")
            return graph if name in graph.controls else graph.add_control(name, Control(Port(id, numbers[0]), name))
        case "end":
            name = rng.choice("pqr")
            if name in graph.inputs:
                return graph.remove_input(name)
            return graph.add_input(name, Input(rng.choice([Kind.IMAGE, Kind.FIELD]), doc=rng.choice("xy")))
        case "settings":
            frames = (1, rng.randint(1, 9))
            return dataclasses.replace(graph, settings=dataclasses.replace(graph.settings, frames=frames))
        case "replace":
            return graph.replace(id, random_node(rng))
    return graph
