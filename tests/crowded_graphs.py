"""Graph files that hold as much of one kind of part as fits into a file: what no real graph has.

Each is a function of a count, beside the count that fills a file or reaches an older limit. They are for measurements
and for tests that count; `large_graphs` has those whose time once grew with a square.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from large_graphs import GRAPHS, Document, chain, change, document, fan, wide

LETTERS = "äöü漢字🎬"
"""Letters that take two to four bytes in UTF-8."""


def hold(count: int, type: str, values: Callable[[int], Document]) -> Document:
    """Nodes of one type, each with other values, beside a picture."""
    nodes = {f"n{number}": {"type": type, "values": values(number)} for number in range(count)}
    return document({"n": {"type": "noise"}, **nodes}, {"outputs.image": "n.out"})


def used(count: int, type: str, values: Callable[[int], Document]) -> Document:
    """The same nodes, in a row of merges that leads to the output."""
    graph = hold(count, type, values)
    for number in range(count):
        graph["nodes"][f"m{number}"] = {"type": "merge"}
        graph["links"] |= {
            f"m{number}.a": f"n{number}.out",
            f"m{number}.b": f"m{number - 1}.out" if number else "n.out",
        }
    graph["links"]["outputs.image"] = f"m{count - 1}.out"
    return graph


def items(type: str, value: str, count: int, item: Callable[[int], Document]) -> Document:
    """One node with many named items."""
    settings = {value: {f"item_{number}": item(number) for number in range(count)}}
    node = {"type": type, "values": settings}
    return document({"n": {"type": "noise"}, "i": node}, {"outputs.image": "n.out"})


def animate(count: int, entry: Callable[[int], Document]) -> Document:
    """One value of each node is animated."""
    return change(fan(count), animation={f"n{number}.stops": entry(number) for number in range(count)})


def nest(width: int, depth: int) -> Document:
    """Groups inside of each other, many times side by side."""

    def body(level: int) -> Document:
        inner = {"type": "group", "graph": body(level - 1)} if level else {"type": "noise"}
        return document({"g": inner}, {"outputs.image": "g.image" if level else "g.out"})

    nodes = {f"g{number}": {"type": "group", "graph": body(depth)} for number in range(width)}
    return document(nodes, {"outputs.image": "g0.image"})


def share(depth: int) -> Document:
    """Equal groups, twice in each other."""
    body = document({"e": {"type": "noise"}}, {"outputs.image": "e.out"})
    for _ in range(depth):
        body = document({"a": {"type": "group", "graph": body}, "b": {"type": "group", "graph": body}}, {})
    return body


def own(section: str, count: int, entry: Document) -> Document:
    """Many entries in a section of ends."""
    return change(chain(2), **{section: {f"e{number}": entry for number in range(count)}})


def rename(graph: Document, name: Callable[[str], str]) -> Document:
    """The same graph with other ids."""

    def move(port: str) -> str:
        node, _, socket = port.partition(".")
        return f"{node if node in ('inputs', 'outputs') else name(node)}.{socket}"

    nodes = {name(id): node for id, node in graph["nodes"].items()}
    return change(graph, nodes=nodes, links={move(end): move(start) for end, start in graph["links"].items()})


def value(values: Callable[[int], Document], count: int) -> Document:
    """A row of nodes, each with other values."""
    graph = chain(count)
    for number in range(count):
        graph["nodes"][f"n{number}"]["values"] = values(number)
    return graph


def relink(count: int, change_link: Callable[[int], tuple[str, str]]) -> Document:
    """A row of nodes with one more link each."""
    graph = chain(count)
    graph["links"] |= dict(map(change_link, range(count)))
    return graph


def write_points(count: int, length: int) -> list[list[float]]:
    return [[0.001 * place] * length for place in range(count)]


CROWDED: Mapping[str, tuple[Callable[[int], Document], int]] = MappingProxyType(
    {
        **{name: (GRAPHS[name], 99_000) for name in ("mislinked", "paired", "looped", "mistyped", "animated", "coded")},
        "distinct": (GRAPHS["distinct"], 99_000),
        "fan": (fan, 99_000),
        "unused": (GRAPHS["unused"], 49_000),
        "read behind": (GRAPHS["read behind"], 49_000),
        "missing": (lambda count: hold(count, "read_image", lambda n: {"path": f"r{n}.exr"}), 99_000),
        "missing, used": (lambda count: used(count, "read_image", lambda n: {"path": f"r{n}.exr"}), 49_000),
        "spellings of a file": (
            lambda count: used(count, "read_image", lambda n: {"path": f"{'./' * (n % 50)}a{n}.png"}),
            49_000,
        ),
        "absolute paths": (lambda count: hold(count, "read_image", lambda n: {"path": f"/a/r{n}.exr"}), 99_000),
        "paths with a file number": (
            lambda count: hold(count, "read_image", lambda n: {"path": f"r{n}.####.exr"}),
            99_000,
        ),
        "texts": (lambda count: hold(count, "text", lambda n: {"text": f"title {n}"}), 99_000),
        "texts, used": (lambda count: used(count, "text", lambda n: {"text": f"title {n}"}), 49_000),
        "a long text": (lambda count: hold(1, "text", lambda n: {"text": "word " * count}), 4_000_000),
        "long texts": (lambda count: hold(count, "text", lambda n: {"text": f"{n} " * 2000}), 2_000),
        "odd letters in texts": (lambda count: hold(1, "text", lambda n: {"text": LETTERS * count}), 1_000_000),
        "formulas": (lambda count: hold(count, "pixel_formula", lambda n: {"formula": f"r + {n}"}), 99_000),
        "wrong formulas": (lambda count: hold(count, "pixel_formula", lambda n: {"formula": f"r + x{n} +"}), 99_000),
        "groups": (wide, 30_000),
        "groups in groups": (lambda count: nest(count, 18), 5_000),
        "shared groups": (lambda count: share(count), 12),
        "deep": (GRAPHS["deep"], 99_000),
        "unknown keys": (GRAPHS["unknown keys"], 1_000_000),
        "unknown lists": (lambda count: change(chain(2), extra=[[n] for n in range(count)]), 700_000),
        "unknown keys of nodes": (lambda count: chain(count, **{f"k{n}": 1 for n in range(5)}), 99_000),
        "unknown values": (lambda count: value(lambda n: {f"v{n}": 1, f"w{n}": 2}, count), 99_000),
        "unknown settings": (lambda count: change(chain(2), settings={f"s{n}": n for n in range(count)}), 900_000),
        "unknown keys of ends": (
            lambda count: own("outputs", 2, {"type": "Image", **{f"k{n}": n for n in range(count)}}),
            500_000,
        ),
        "unknown nodes, large": (
            lambda count: hold(count, "odd", lambda n: {f"v{k}": [n, k] for k in range(10)}),
            25_000,
        ),
        "plug-in nodes": (lambda count: hold(count, "acme.odd", lambda n: {"v": n}), 99_000),
        "plug-in nodes of packages": (
            lambda count: change(
                document({}, {}),
                nodes={f"n{n}": {"type": f"acme{n}.odd", "package": f"acme{n}==1"} for n in range(count)},
            ),
            99_000,
        ),
        "notes": (
            lambda count: change(
                chain(2), ui={"notes": {f"n{n}": {"text": f"note {n}", "box": [n, 1, 2, 3]} for n in range(count)}}
            ),
            180_000,
        ),
        "places": (lambda count: change(chain(2), ui={"nodes": {f"n{n}": [n, 1] for n in range(count)}}), 450_000),
        "routes": (
            lambda count: change(chain(2), ui={"routes": {f"n{n}.image": [[n, 1], [2, n]] for n in range(count)}}),
            190_000,
        ),
        "viewers": (
            lambda count: change(chain(2), ui={"viewers": {f"{n}": f"n{n}.out" for n in range(count)}}),
            900_000,
        ),
        "lists in the layout": (lambda count: change(chain(2), ui={"x": [[]] * count}), 740_000),
        "deep layout": (lambda count: change(chain(2), ui={"y": [_nested(50)] * count}), 14_000),
        "inputs": (lambda count: own("inputs", count, {"type": "Image"}), 10_000),
        "inputs with files": (
            lambda count: change(
                chain(2), inputs={f"i{n}": {"type": "Image", "file": f"f{n}.exr"} for n in range(count)}
            ),
            10_000,
        ),
        "outputs": (lambda count: own("outputs", count, {"type": "Image"}), 10_000),
        "outputs, fed": (
            lambda count: change(
                own("outputs", count, {"type": "Image"}), links={f"outputs.e{n}": "n.out" for n in range(count)}
            ),
            10_000,
        ),
        "outputs with views": (
            lambda count: change(
                own("outputs", count, {}),
                outputs={f"e{n}": {"view": f"v{n}"} for n in range(count)},
                links={f"outputs.e{n}": "n.out" for n in range(count)},
            ),
            10_000,
        ),
        "controls": (lambda count: own("controls", count, {"target": "n0.stops"}), 10_000),
        "controls of nothing": (lambda count: own("controls", count, {"target": "x.stops"}), 10_000),
        "controlled group": (GRAPHS["controlled"], 10_000),
        "ends of groups": (
            lambda count: document(
                {f"g{n}": {"type": "group", "graph": own("inputs", count // 10, {"type": "Image"})} for n in range(10)},
                {},
            ),
            99_000,
        ),
        "keys": (
            lambda count: change(
                chain(2), animation={"n0.stops": {"keys": [{"frame": n, "value": n % 7} for n in range(count)]}}
            ),
            250_000,
        ),
        "keys with handles": (
            lambda count: change(
                chain(2),
                animation={
                    "n0.stops": {
                        "keys": [
                            {"frame": n, "value": 1, "interpolation": "bezier", "left": [-0.3, 0], "right": [0.3, 0]}
                            for n in range(count)
                        ]
                    }
                },
            ),
            130_000,
        ),
        "keys of many nodes": (
            lambda count: animate(count, lambda n: {"keys": [{"frame": 1, "value": n}, {"frame": 9, "value": 1}]}),
            80_000,
        ),
        "keys of outlines": (
            lambda count: change(
                items("roto", "shapes", 1, lambda n: {"kind": "spline"}),
                animation={
                    "i.shapes.item_0.points": {
                        "keys": [{"frame": n, "value": write_points(100, 2)} for n in range(count)]
                    }
                },
            ),
            4_500,
        ),
        "expressions, equal": (lambda count: animate(count, lambda n: {"expression": "sin(frame) * 0.5"}), 99_000),
        "expressions, different": (lambda count: animate(count, lambda n: {"expression": f"frame * {n}"}), 99_000),
        "expressions, wrong": (lambda count: animate(count, lambda n: {"expression": f"frame * * {n}"}), 99_000),
        "expressions of names": (lambda count: animate(count, lambda n: {"expression": f"nothing{n}.stops"}), 99_000),
        "expressions, long": (lambda count: animate(count, lambda n: {"expression": f"{n}" + "+1" * 480}), 500),
        "animation of nothing": (
            lambda count: change(chain(2), animation={f"x{n}.stops": {"expression": "frame"} for n in range(count)}),
            200_000,
        ),
        "roto shapes": (
            lambda count: items("roto", "shapes", count, lambda n: {"kind": "spline", "points": write_points(4, 2)}),
            90_000,
        ),
        "roto points": (
            lambda count: items("roto", "shapes", count, lambda n: {"kind": "spline", "points": write_points(4000, 6)}),
            50,
        ),
        "roto points, pairs": (
            lambda count: items("roto", "shapes", count, lambda n: {"kind": "spline", "points": write_points(4000, 2)}),
            120,
        ),
        "roto nodes": (
            lambda count: hold(
                count, "roto", lambda n: {"shapes": {"a": {"kind": "spline", "points": write_points(4, 2)}}}
            ),
            60_000,
        ),
        "paint strokes": (
            lambda count: items("paint", "strokes", count, lambda n: {"kind": "brush", "points": write_points(6, 2)}),
            60_000,
        ),
        "lights": (
            lambda count: items(
                "deferred_lighting", "lights", count, lambda n: {"kind": "point", "position": [n, 1, 2]}
            ),
            150_000,
        ),
        "unknown fields": (
            lambda count: items("roto", "shapes", count, lambda n: {"kind": "spline", f"f{n}": n}),
            250_000,
        ),
        "unknown kinds": (lambda count: items("roto", "shapes", count, lambda n: {"kind": f"k{n}"}), 250_000),
        "curve points": (
            lambda count: (
                value(lambda n: {}, 2)
                | {"nodes": {"n": {"type": "curves", "values": {"master": [k * 1e-6 for k in range(2 * count)]}}}}
            ),
            600_000,
        ),
        "ramp stops": (lambda count: hold(1, "gradient_map", lambda n: {"ramp": [0.1] * 5 * count}), 290_000),
        "matrices": (lambda count: hold(count, "color_matrix", lambda n: {"matrix": [n] * 9}), 70_000),
        "lines of code": (
            lambda count: document({}, {}) | {"nodes": {"c": {"type": "glsl", "code": ["// x"] * count}}},
            1_000_000,
        ),
        "equal code": (
            lambda count: chain(count, type="glsl", code=["vec4 f(vec4 image) { return image; }"], values={}),
            99_000,
        ),
        "broken code": (
            lambda count: (
                document({}, {}) | {"nodes": {f"c{n}": {"type": "glsl", "code": [f"vec4 ( {n}"]} for n in range(count)}}
            ),
            99_000,
        ),
        "isf code": (
            lambda count: (
                document({}, {})
                | {
                    "nodes": {
                        "c": {
                            "type": "isf",
                            "code": [
                                "/*{",
                                '"INPUTS": [',
                                *[f'{{"NAME": "a{n}", "TYPE": "float"}},' for n in range(count)],
                                '{"NAME": "b", "TYPE": "float"}]}*/',
                                "void main() {}",
                            ],
                        }
                    }
                }
            ),
            20_000,
        ),
        "files of code": (
            lambda count: (
                document({}, {}) | {"nodes": {f"c{n}": {"type": "glsl", "file": f"f{n}.glsl"} for n in range(count)}}
            ),
            99_000,
        ),
        "files of groups": (
            lambda count: (
                document({}, {}) | {"nodes": {f"c{n}": {"type": "group", "path": f"f{n}.json"} for n in range(count)}}
            ),
            99_000,
        ),
        "allowed": (GRAPHS["allowed"], 10_000),
        "allowed and unused": (lambda count: change(fan(count), settings={"allow": {"unused-branch": "x"}}), 99_000),
        "long ids": (lambda count: rename(chain(count), lambda id: id + "x" * 250), 30_000),
        "very long ids": (lambda count: rename(chain(count), lambda id: id + "x" * 950), 8_000),
        "long ids, linked from nothing": (
            lambda count: rename(GRAPHS["mislinked"](count), lambda id: id + "x" * 250),
            30_000,
        ),
        "long ids of many bytes": (lambda count: rename(chain(count), lambda id: id + LETTERS * 20), 40_000),
        "long ids in a loop": (lambda count: rename(GRAPHS["looped"](count), lambda id: id + "x" * 250), 30_000),
        "names alike": (lambda count: rename(GRAPHS["mislinked"](count), lambda id: f"{'a' * 60}{id}"), 90_000),
        "links from an output that is none": (
            lambda count: relink(count, lambda n: (f"n{n}.image", "n.nothing")),
            99_000,
        ),
        "links to sockets that are none": (lambda count: relink(count, lambda n: (f"n{n}.sock{n}", "n.out")), 99_000),
        "links to nodes that are none": (lambda count: relink(count, lambda n: (f"x{n}.image", "n.out")), 99_000),
        "links to outputs that are none": (lambda count: relink(count, lambda n: (f"outputs.x{n}", "n.out")), 99_000),
        "links to values": (lambda count: relink(count, lambda n: (f"n{n}.stops", "n.out")), 99_000),
        "links from themselves": (lambda count: relink(count, lambda n: (f"n{n}.image", f"n{n}.out")), 99_000),
        "links alone": (
            lambda count: document({"n": {"type": "noise"}}, {f"x{n}.a": "n.out" for n in range(count)}),
            290_000,
        ),
        "unlinked": (lambda count: hold(count, "exposure", lambda n: {"stops": n / 1000}), 99_000),
        "out of range": (lambda count: value(lambda n: {"stops": 1e9 + n}, count), 99_000),
        "wrong types of values": (lambda count: value(lambda n: {"stops": f"{n}"}, count), 99_000),
        "choices": (lambda count: hold(count, "gaussian_blur", lambda n: {"edge": f"e{n}"}), 99_000),
        "units": (
            lambda count: change(
                chain(2), nodes={f"n{n}": {"type": "gaussian_blur", "units": {"sigma": f"u{n}"}} for n in range(count)}
            ),
            99_000,
        ),
        "units that are right": (
            lambda count: change(
                chain(2),
                nodes={
                    f"n{n}": {"type": "gaussian_blur", "values": {"sigma": n / 1e6}, "units": {"sigma": "height"}}
                    for n in range(count)
                },
            ),
            90_000,
        ),
        "versions": (
            lambda count: change(
                chain(2),
                nodes={
                    f"n{n}": {"type": "read_render", "version": 1, "values": {"path": f"{n}"}} for n in range(count)
                },
            ),
            90_000,
        ),
        "muted": (GRAPHS["muted"], 99_000),
        "neutral": (GRAPHS["neutral"], 99_000),
        "filters": (lambda count: chain(count, type="gaussian_blur", values={"sigma": 0.1}), 99_000),
        "transforms": (lambda count: chain(count, type="transform", values={"angle": 1.0}), 99_000),
        "tone maps": (lambda count: chain(count, type="tone_map", values={}), 99_000),
        "blooms": (lambda count: chain(count, type="bloom", values={}), 20_000),
        "merges": (lambda count: used(count, "noise", lambda n: {"seed": n}), 49_000),
    }
)


def _nested(depth: int) -> Any:
    return [_nested(depth - 1)] if depth else []
