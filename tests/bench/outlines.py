"""What outlines of `roto` and `text` cost. Run it as `.venv/bin/python tests/bench/outlines.py`; it prints JSON.

For each case the processor time of a picture of 1920x1080, and what part that is of a blur with a sigma of 10 pixels.
Of both a picture without outlines, or without the blur, is subtracted: what it takes to plan, and to hand over pixels.
Everything is drawn in turn, `--rounds` times, and the median counts. Points move from picture to picture, so that all
tables are made anew, as while a point is dragged.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Mapping
from statistics import median
from typing import Any

import numpy as np
from halation.graph import Graph, Output, Port
from halation.nodes import Kind, RotoShape, join_points, make_ellipse, name_roto_shapes
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.input.checker import Checker
from halation.nodes.input.roto import Roto
from halation.nodes.input.text import Text
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED

SIZE = (1920, 1080)
SIGMA = 10.0
"""Pixels: a blur that everybody knows, and that costs the same on all pictures of this size."""

SOFT = 40.0 / SIZE[1]
"""The width of soft edges: 40 pixels."""

WORDS = "The quick brown fox jumps over the lazy dog. " * 10
"""450 letters, about as many as a page of credits has."""


def make_wave(shift: float, count: int = 500, lobes: int = 31, feather: float = 0.0) -> tuple[float, ...]:
    """A closed wave of smooth points, turned a little by each shift."""
    turns = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False) + shift
    radii, arm = 0.32 + 0.08 * np.cos(lobes * turns), 0.6 / count
    x, y = np.cos(turns), np.sin(turns)
    rows = [0.5 + radii * x, 0.5 + radii * y, arm * y, -arm * x, -arm * y, arm * x, np.full(count, feather)]
    return join_points(map(tuple, np.column_stack(rows).tolist()))


def make_ten(shift: float, feather: float) -> Roto:
    """Ten ellipses that overlap."""
    middles = [(0.15 + 0.07 * number + 0.01 * shift, 0.3 + 0.04 * (number % 5)) for number in range(10)]
    shapes = {
        f"shape_{number}": RotoShape(points=make_ellipse(x, y, 0.3, 0.4), feather=feather)
        for number, (x, y) in enumerate(middles, 1)
    }
    return Roto(shapes=name_roto_shapes(**shapes))


def make_one(shift: float, **fields: Any) -> Roto:
    """One shape of 500 points."""
    points = make_wave(shift, feather=fields.pop("each", 0.0))
    return Roto(shapes=name_roto_shapes(shape_1=RotoShape(points=points, **fields)))


CASES: Mapping[str, Callable[[float], Roto | Text]] = {
    "500 points, hard": make_one,
    "500 points, soft": lambda shift: make_one(shift, feather=SOFT),
    "500 points, each with a feather": lambda shift: make_one(shift, each=SOFT),
    "ten shapes, hard": lambda shift: make_ten(shift, 0.0),
    "ten shapes, soft": lambda shift: make_ten(shift, SOFT),
    "a title": lambda shift: Text(text="A title", size=0.15, anchor=(0.5 + 0.01 * shift, 0.5)),
    "450 letters": lambda shift: Text(text=WORDS, size=0.04, wrap_width=1.5, anchor=(0.5 + 0.01 * shift, 0.5)),
}


def make_graph(node: Roto | Text) -> Graph:
    """The mask of a node."""
    graph = Graph().add("node", node).add_output("picture", Output(Kind.FIELD))
    return graph.connect(Port("node", "mask" if isinstance(node, Roto) else "matte"), Port("outputs", "picture"))


def make_blur(sigma: float) -> Graph:
    """A checkerboard, blurred if there is a sigma."""
    graph = Graph().add("checker", Checker()).add_output("picture", Output(Kind.IMAGE))
    if not sigma:
        return graph.connect(Port("checker", "out"), Port("outputs", "picture"))
    graph = graph.add("blur", GaussianBlur(sigma=sigma)).connect(Port("checker", "out"), Port("blur", "image"))
    return graph.connect(Port("blur", "out"), Port("outputs", "picture"))


def measure(rounds: int) -> dict[str, Any]:
    """The median processor time of each case in milliseconds, and its part of a blur."""
    renderer = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    graphs: dict[str, Callable[[float], Graph]] = {
        "nothing": lambda shift: make_graph(Roto(shapes=name_roto_shapes())),
        "no blur": lambda shift: make_blur(0.0),
        "blur": lambda shift: make_blur(SIGMA + 1e-4 * shift),
        **{name: lambda shift, make=make: make_graph(make(shift)) for name, make in CASES.items()},
    }
    seconds: dict[str, list[float]] = {name: [] for name in graphs}
    for turn in range(rounds + 1):
        for name, make in graphs.items():
            graph, start = make(0.01 * turn), time.process_time()
            renderer.render(graph, RenderRequest({}, size=SIZE, precision="float"))
            if turn:  # the first one translates programs
                seconds[name].append(time.process_time() - start)
    renderer.close()
    times = {name: 1000.0 * median(each) for name, each in seconds.items()}
    blur = times["blur"] - times["no blur"]
    cases = {
        name: {
            "milliseconds": round(times[name] - times["nothing"], 1),
            "of a blur": round((times[name] - times["nothing"]) / blur, 3),
        }
        for name in CASES
    }
    return {"blur, milliseconds": round(blur, 1), "cases": cases}


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=7)
    print(json.dumps(measure(parser.parse_args().rounds), indent=2))
