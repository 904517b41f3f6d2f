"""A fit of a graph to the picture that the same graph makes with other values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from halation.fit.fitting import Comparison, FitTask, fit_values
from halation.fit.results import FitResult
from halation.fit.search_space import find_search_space
from halation.fit.shown_output import ShownOutput
from halation.fit.value_patterns import ValuePattern
from halation.graph import Graph
from halation.renderer import Renderer, RenderRequest

Array = np.ndarray


@dataclass(frozen=True)
class Recovery:
    """What came out, and by which share of its range each number is off."""

    result: FitResult
    off: Array

    @property
    def off_where_determined(self) -> float:
        return max(
            (off for off, item in zip(self.off, self.result.values, strict=True) if item.is_determined), default=0.0
        )


Recover = Callable[..., Recovery]


@pytest.fixture
def recover(renderer: Renderer) -> Recover:
    """`recover(graph, ["light.stops"], seed)` moves the values by up to a quarter of their ranges, and finds them."""

    def run(
        graph: Graph, patterns: Sequence[str], seed: int, request: RenderRequest, renders: int = 200, points: int = 5
    ) -> Recovery:
        wanted = [ValuePattern(text) for text in patterns]
        truth = find_search_space(graph, wanted, points)
        moved = truth.start + np.random.default_rng(seed).uniform(-0.25, 0.25, truth.start.size)
        output = ShownOutput(renderer, graph, request, next(iter(graph.outputs)), "", is_light=False)
        reference = round_to_bytes(output.render(graph, 1.0))
        space = find_search_space(truth.graph_at(np.clip(moved, 0.0, 1.0)), wanted, points)
        result = fit_values(FitTask(space, output, reference, "pixels", 600.0, renders))
        off = [
            abs(item.after - number.start) / (number.high - number.low)
            for item, number in zip(result.values, truth.numbers, strict=True)
        ]
        return Recovery(result, np.array(off))

    return run


def fit_to(renderer: Renderer, graph: Graph, request: RenderRequest, reference: Array, *patterns: str, **options):
    """The fit of a graph to light, with the options of a task."""
    by: Comparison = options.pop("by", "pixels")
    space = find_search_space(graph, [ValuePattern(text) for text in patterns], options.pop("points", 5))
    output = ShownOutput(renderer, graph, request, next(iter(graph.outputs)), "none", is_light=False)
    task = FitTask(space, output, reference, by, 600.0, options.pop("renders", 2000))
    return fit_values(task, **options)


def encode(light: Array) -> Array:
    """sRGB by IEC 61966-2-1."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1.0 / 2.4) - 0.055)


def decode(codes: Array) -> Array:
    """Its inverse."""
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def round_to_bytes(light: Array) -> Array:
    """Light as a file of 8 bits holds it."""
    return decode(np.round(np.clip(encode(light), 0.0, 1.0) * 255.0) / 255.0).astype(np.float32)
