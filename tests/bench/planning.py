"""How long large graphs take from graph to plan, and again after a value has changed. It prints JSON.

`planning.py COUNT...` measures graphs of so many nodes: `plan`, seconds for graphs that were never planned before;
`change`, those after a value in the middle of a graph was changed; `programs`, how many shaders of the changed plan
are new; `read`, how long the JSON takes to a graph.
"""

from __future__ import annotations

import gc
import json
import sys
import time
from collections.abc import Callable

import numpy as np
from halation.document import dumps, loads
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind, catalogue
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

TIMES = 7
TYPES = (
    "exposure",
    "grade",
    "saturation",
    "gaussian_blur",
    "cdl",
    "mix_images",
    "vignette",
    "edge_detect",
    "clip",
    "merge",
)
"""In turn. Those of two pictures take the node before and the one five before it."""


def make_large_graph(count: int, first: int = 0) -> Graph:
    """A graph of so many nodes in a chain with side branches; no two are alike, nor two graphs with another `first`."""
    types, ports = catalogue(), [Port("inputs", "image")]
    graph = Graph().add_input("image", Input(Kind.IMAGE))
    for number in range(count):
        kind, amount = types[TYPES[(number + first) % len(TYPES)]], 0.1 + 0.8 * (number + 1) / (count + first)
        value = next(name for name, item in kind.values.items() if isinstance(item.default, float))
        graph = graph.add(f"n{number}", kind().with_values(**{value: amount}))
        sockets = [name for name in kind.inputs if name != "mask"]
        for socket, source in zip(sockets, (ports[-1], ports[-5:][0]), strict=False):
            graph = graph.connect(source, Port(f"n{number}", socket))
        ports.append(Port(f"n{number}", "out"))
    graph = graph.add_output("out", Output(Kind.IMAGE))
    return graph.connect(ports[-1], Port("outputs", "out"))


def time_runs(work: Callable[[int], object]) -> list[float]:
    """Seconds of some runs, each with its number, after one that does not count."""
    seconds: list[float] = []
    for turn in range(TIMES + 1):
        gc.collect()
        started = time.perf_counter()
        work(turn)
        seconds.append(time.perf_counter() - started)
    return seconds[1:]


def measure_planning(engine: Renderer, count: int) -> dict[str, object]:
    """All figures of one graph."""
    graph, request = make_large_graph(count), RenderRequest({"image": np.zeros((64, 64, 4), np.float32)})
    number = count // 2 // len(TYPES) * len(TYPES)
    changed = [graph.override(f"n{number}.stops", 0.001 * (turn + 1)) for turn in range(TIMES + 1)]
    text = dumps(graph)
    first = {one.shader for one in engine.compile(graph, request).passes}
    fresh_graphs = [make_large_graph(count, turn + 1) for turn in range(TIMES + 1)]
    plan = time_runs(lambda turn: engine.compile(fresh_graphs[turn], request))
    engine.compile(graph, request)
    change = time_runs(lambda turn: engine.compile(changed[turn], request))
    after = {one.shader for one in engine.compile(changed[-1], request).passes}
    return {
        "nodes": count,
        "passes": len(engine.compile(graph, request).passes),
        "plan": plan,
        "change": change,
        "programs": len(after - first),
        "read": time_runs(lambda turn: loads(text, sandbox=UNRESTRICTED)),
    }


def main() -> None:
    """Print what each graph took."""
    engine = Renderer(sandbox=UNRESTRICTED)
    print(json.dumps({"graphs": [measure_planning(engine, int(count)) for count in sys.argv[1:]]}))
    engine.close()


if __name__ == "__main__":
    main()
