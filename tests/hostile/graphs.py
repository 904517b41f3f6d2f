"""Graph files that are almost right: presets with a few things changed by rules that know the format."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from copy import deepcopy
from pathlib import Path
from random import Random
from typing import Any

from cases import Case
from halation import presets
from halation.nodes import catalogue

NUMBERS = (0, -1, 1, 2, 0.5, -0.0, 1e-9, 1e9, 2**31, -(2**31), 2**53, 2**63, 1e38, 1e300, -1e300, 5e-324, 999999999)
TEXTS = (
    "", " ", ".", "..", "/", "a/b", "inputs", "outputs", "inputs.", "nodes", "\u0000", "\ud83d", "\u202e",
    "é" * 300, "x" * 70000, "=", "=1/0", "=frame*", "=((((1))))", "=a.b", "=sin(frame)^999", "graph.json",
    "fifo", "/dev/zero", "$F99999", "####", "a.####.exr", "%04d.png", "http://localhost/x.png",
    "file:///etc/passwd", "ocio://default", "ocio://nothing", "missing.exr", "linked.exr",
)  # fmt: skip
"""Text that some part of the program reads as something else: names, paths, patterns, expressions."""

SIZES = ([0, 0], [1, 1], [-1, 5], [24, 16], [1e6, 1e6], [2**31, 1], [1.5, 2], ["a", "b"], [1], [], None, "64x64")
FRAMES = ([1, 5], [5, 1], [0, 0], [-5, -1], [1, 10**9], [1.5, 2], [1], [], None, "1-5")


def build_cases(seed: int, count: int) -> Iterator[Case]:
    """So many cases; the same for the same seed."""
    sources = [json.loads(path.read_text("utf-8")) for path in presets.paths()]
    for number in range(count):
        rng = Random(f"graphs {seed} {number}")
        text = mutate(rng, rng.choice(sources))
        yield Case(f"graph-{seed}-{number}", _writer(text), _command(rng))


def _command(rng: Random) -> tuple[str, ...]:
    render = ("render", "graph.json", "-o", "out.exr", "--size", "24x16", "--timeout", "8")
    return rng.choices(
        (
            ("check", "graph.json"),
            render,
            ("explain", "graph.json"),
            ("fmt", "--check", "graph.json"),
            ("api", "graph.json"),
        ),
        (4, 3, 1, 1, 1),
    )[0]


def _writer(text: bytes) -> Callable[[Path], None]:
    def prepare(folder: Path) -> None:
        import os

        (folder / "graph.json").write_bytes(text)
        os.mkfifo(folder / "fifo")
        (folder / "linked.exr").symlink_to("linked.exr")

    return prepare


def mutate(rng: Random, source: dict[str, Any]) -> bytes:
    """A graph file with one to six things changed; one in twenty is damaged as text, too."""
    tree = deepcopy(source)
    for _ in range(rng.choice((1, 1, 2, 3, 6))):
        rng.choice(CHANGES)(rng, tree)
    text = json.dumps(tree, allow_nan=True, ensure_ascii=rng.random() < 0.9).encode("utf-8", "surrogatepass")
    if rng.random() < 0.05:
        at = rng.randrange(len(text))
        text = rng.choice((text[:at], text[:at] + text[at + 1 :], text + b"}", b"\xff\xfe" + text, b"[" * 30000 + text))
    return text


def any_value(rng: Random, depth: int = 0) -> Any:
    """Anything that JSON can say."""
    kind = rng.randrange(7 if depth < 3 else 4)
    if kind == 0:
        return rng.choice(NUMBERS) * rng.choice((1, 1, rng.random()))
    if kind == 1:
        return rng.choice(TEXTS)
    if kind in (2, 3):
        return rng.choice((None, True, False, float("nan"), float("inf")))
    if kind == 4:
        return [any_value(rng, depth + 1) for _ in range(rng.choice((0, 1, 2, 3, 4, 12)))]
    return {rng.choice(TEXTS): any_value(rng, depth + 1) for _ in range(rng.choice((0, 1, 3)))}


def _places(tree: Any) -> list[tuple[Any, Any]]:
    """Every container with every key or index of it."""
    places: list[tuple[Any, Any]] = []
    waiting = [tree]
    while waiting:
        container = waiting.pop()
        keys = container.keys() if isinstance(container, dict) else range(len(container))
        for key in list(keys):
            places.append((container, key))
            if isinstance(container[key], dict | list):
                waiting.append(container[key])
    return places


def _replace_any(rng: Random, tree: dict[str, Any]) -> None:
    container, key = rng.choice(_places(tree))
    container[key] = any_value(rng)


def _replace_alike(rng: Random, tree: dict[str, Any]) -> None:
    """A number by a number, text by text: what passes the first checks."""
    places = [(container, key) for container, key in _places(tree) if isinstance(container[key], int | float | str)]
    if places:
        container, key = rng.choice(places)
        container[key] = rng.choice(TEXTS if isinstance(container[key], str) else NUMBERS)


def _remove(rng: Random, tree: dict[str, Any]) -> None:
    container, key = rng.choice(_places(tree))
    del container[key]


def _rename(rng: Random, tree: dict[str, Any]) -> None:
    places = [(container, key) for container, key in _places(tree) if isinstance(container, dict)]
    container, key = rng.choice(places)
    container[rng.choice((*TEXTS, *(str(other) for _, other in places)))] = container.pop(key)


def _section(tree: dict[str, Any], name: str) -> dict[str, Any]:
    if not isinstance(tree.get(name), dict):
        tree[name] = {}
    return tree[name]


def _relink(rng: Random, tree: dict[str, Any]) -> None:
    """Another source for a target: loops, wrong types, ends that do not exist."""
    links, nodes = _section(tree, "links"), list(_section(tree, "nodes")) or ["n"]
    ends = [
        str(end) for end in (*links.values(), *links, *(f"{node}.out" for node in nodes), "inputs.x", "outputs.image")
    ]
    links[rng.choice([*links, *ends])] = rng.choice(ends)


def _retype(rng: Random, tree: dict[str, Any]) -> None:
    nodes = [node for node in _section(tree, "nodes").values() if isinstance(node, dict)]
    if nodes:
        rng.choice(nodes)["type"] = rng.choice((*catalogue(), "group", "glsl", "isf", "nothing"))


def _add_node(rng: Random, tree: dict[str, Any]) -> None:
    """A node of any type with values of the right names and any content."""
    kind = rng.choice(list(catalogue().values()))
    values = {name: any_value(rng) for name in kind.values if rng.random() < 0.4}
    name = f"added{rng.randrange(99)}"
    _section(tree, "nodes")[name] = {"type": kind.id, "version": rng.choice((1, 1, 1, 0, 2, 99)), "values": values}
    _relink(rng, tree)


def _nest(rng: Random, tree: dict[str, Any]) -> None:
    """The whole graph as a group of itself, a few times."""
    inner = deepcopy({key: tree[key] for key in tree if key != "ui"})
    for _ in range(rng.choice((1, 2, 5, 33))):
        inner = {
            "halation": 1,
            "nodes": {"inner": {"type": "group", "graph": inner}},
            "outputs": inner.get("outputs", {}),
        }
    _section(tree, "nodes")["nested"] = {"type": "group", "graph": inner}


def _settings(rng: Random, tree: dict[str, Any]) -> None:
    settings = _section(tree, "settings")
    name = rng.choice(("size", "frames", "rate", "color", "precision"))
    choices: dict[str, tuple[Any, ...]] = {"size": SIZES, "frames": FRAMES, "rate": NUMBERS}
    settings[name] = rng.choice(choices[name]) if name in choices else any_value(rng)


def _animate(rng: Random, tree: dict[str, Any]) -> None:
    targets = [
        f"{id}.{name}"
        for id, node in _section(tree, "nodes").items()
        if isinstance(node, dict)
        for name in _section(node, "values") or {"x": 0}
    ]
    keys = [{"frame": rng.choice(NUMBERS), "value": any_value(rng, 2)} for _ in range(rng.choice((0, 1, 2, 9)))]
    expression = {"expression": rng.choice([text[1:] for text in TEXTS if text.startswith("=")])}
    _section(tree, "animation")[rng.choice(targets or ["n.x"])] = rng.choice(
        ({"keys": keys}, expression, any_value(rng))
    )


CHANGES = (
    *(_replace_any, _replace_alike, _replace_alike, _remove, _rename),
    *(_relink, _relink, _retype, _add_node, _add_node, _nest, _settings, _animate),
)
