"""Graphs and texts of any size, each of which once took time or memory by the square of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import deepcopy
from types import MappingProxyType
from typing import Any

Document = dict[str, Any]


def document(nodes: Document, links: Mapping[str, str], **more: Any) -> Document:
    """A small picture of these nodes."""
    ends = {"inputs": {}, "outputs": {"image": {"type": "Image"}}}
    return {"halation": 1, "settings": {"size": [8, 8]}, **ends, "nodes": nodes, "links": dict(links), **more}


def chain(count: int, **node: Any) -> Document:
    """Nodes in a row."""
    nodes: Document = {"n": {"type": "noise"}}
    links: dict[str, str] = {}
    for number, before in enumerate(["n", *(f"n{number}" for number in range(count - 1))]):
        nodes[f"n{number}"] = {"type": "exposure", "values": {"stops": 0.5}, **deepcopy(node)}
        links[f"n{number}.image"] = f"{before}.out"
    return document(nodes, {**links, "outputs.image": f"n{count - 1}.out"})


def fan(count: int) -> Document:
    """Nodes that read the same one."""
    graph = chain(count)
    graph["links"] = {**{f"n{number}.image": "n.out" for number in range(count)}, "outputs.image": "n0.out"}
    return graph


def wide(count: int, **node: Any) -> Document:
    """Groups in a row."""
    body = document({"e": {"type": "exposure"}}, {"e.image": "inputs.image", "outputs.image": "e.out"})
    body["inputs"] = {"image": {"type": "Image"}}
    graph = chain(count, **{"type": "group", "graph": body, "values": {}, **node})
    graph["links"] = {
        target: source if source == "n.out" else source.replace(".out", ".image")
        for target, source in graph["links"].items()
    }
    return graph


def deep(count: int) -> Document:
    """A long chain, inside of many groups."""
    graph = chain(count)
    for _ in range(12):
        graph = document({"g": {"type": "group", "graph": graph}}, {"outputs.image": "g.image"})
    return graph


def change(graph: Document, **sections: Any) -> Document:
    """A document with other sections."""
    return {**graph, **sections}


def controlled(count: int) -> Document:
    """A group of which many controls are set and linked."""
    body = fan(count)
    body["controls"] = {f"k{number}": {"target": f"n{number}.stops"} for number in range(count)}
    values = {f"k{number}": 0.25 for number in range(0, count, 2)}
    links = {f"g.k{number}": "f.out" for number in range(1, count, 2)}
    nodes = {"g": {"type": "group", "graph": body, "values": values}, "f": {"type": "noise"}}
    return document(nodes, {**links, "outputs.image": "g.image"})


def animated(count: int) -> Document:
    """Expressions that read each other in a row."""
    entries = {f"n{number}.stops": {"expression": f"n{number + 1}.stops * 0.5"} for number in range(count - 1)}
    return change(fan(count), animation=entries)


def keyed(count: int) -> Document:
    """A value with many keys."""
    keys = [{"frame": frame, "value": frame % 7} for frame in range(count)]
    return change(chain(2), animation={"n0.stops": {"keys": keys}})


def mislinked(count: int) -> Document:
    """Links from nodes that are not there."""
    graph = fan(count)
    graph["links"] = {target: f"{target.partition('.')[0]}x.out" for target in graph["links"]}
    return graph


def mistyped(count: int) -> Document:
    """Nodes of types that are not there."""
    graph = fan(count)
    for id, node in graph["nodes"].items():
        node["type"] = f"exposre{id}"
    return graph


def looped(count: int) -> Document:
    """Nodes that feed each other in pairs, and one long loop."""
    graph = chain(count)
    graph["links"]["n0.image"] = f"n{count // 2}.out"
    for number in range(count // 2 + 1, count - 1, 2):
        graph["links"] |= {f"n{number}.image": f"n{number + 1}.out", f"n{number + 1}.image": f"n{number}.out"}
    return graph


def paired(count: int) -> Document:
    """Nodes that feed each other in pairs."""
    graph = chain(count)
    graph["links"] = {f"n{number}.image": f"n{number ^ 1}.out" for number in range(count)}
    return graph


def missing(count: int) -> Document:
    """Files that are not there, each another one, beside many that are."""
    nodes = {f"r{number}": {"type": "read_image", "values": {"path": f"r{number}.exr"}} for number in range(count)}
    graph = document(nodes, {f"outputs.o{number}": f"r{number}.out" for number in range(count)})
    return change(graph, outputs={f"o{number}": {"type": "Image"} for number in range(count)})


def coded(count: int) -> Document:
    """Nodes of code, each of another one."""
    graph = chain(count)
    for number in range(count):
        graph["nodes"][f"n{number}"] = {
            "type": "glsl",
            "code": [f"vec4 tint(vec4 image) {{ return image * {number}.0; }}"],
        }
    return graph


def distinct(count: int) -> Document:
    """Nodes in a row, each with another number."""
    graph = chain(count)
    for number in range(count):
        graph["nodes"][f"n{number}"]["values"] = {"stops": number / 1000}
    return graph


def unused(count: int) -> Document:
    """Branches that lead nowhere and share their beginning."""
    graph = chain(count)
    ends = {f"e{number}": {"type": "exposure"} for number in range(count)}
    links = {f"e{number}.image": f"n{count - 1}.out" for number in range(count)}
    return change(graph, nodes={**graph["nodes"], **ends}, links={**graph["links"], **links, "outputs.image": "n.out"})


def read_behind(count: int) -> Document:
    """Many nodes that read a chain of which every node passes its picture through."""
    graph = chain(count, muted=True)
    readers = {f"r{number}": {"type": "bloom"} for number in range(count)}
    links = {f"r{number}.image": f"n{count - 1}.out" for number in range(count)}
    return change(graph, nodes={**graph["nodes"], **readers}, links={**graph["links"], **links})


GRAPHS: Mapping[str, Callable[[int], Document]] = MappingProxyType(
    {
        "chain": chain,
        "distinct": distinct,
        "fan": fan,
        "muted": lambda count: chain(count, muted=True),
        "neutral": lambda count: chain(count, values={}),
        "wide": wide,
        "muted groups": lambda count: wide(count, muted=True),
        "deep": deep,
        "controlled": controlled,
        "animated": animated,
        "keyed": keyed,
        "mislinked": mislinked,
        "mistyped": mistyped,
        "looped": looped,
        "paired": paired,
        "missing": missing,
        "coded": coded,
        "unused": unused,
        "read behind": read_behind,
        "unknown keys": lambda count: change(chain(2), **{f"x{number}": 1 for number in range(count)}),
        "allowed": lambda count: change(
            chain(2), settings={"allow": {f"no-{number:05}": "why" for number in range(count)}}
        ),
        "layout": lambda count: change(chain(2), ui={"nodes": {f"n{number}": [0, 1] for number in range(count)}}),
        "files": lambda count: chain(count, type="read_image", values={"path": "missing.exr"}),
    }
)

TEXTS: Mapping[str, Callable[[int], str]] = MappingProxyType(
    {
        "brackets": lambda count: "[" * count,
        "brackets in ui": lambda count: '{"halation": 1, "ui": ' + "[" * count + "]" * count + "}",
        "braces": lambda count: '{"a": ' * count,
        "quotes": lambda count: '"\\' * count,
        "a long key": lambda count: '{"halation": 1, "' + "k" * count + '": ' + '{"a": [1, 2, 3, 4]}}',
        "a key twice": lambda count: "{" + ",".join('"a": 1' for _ in range(count // 8)) + "}",
    }
)
