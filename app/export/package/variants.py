"""Finds the knobs that change passes, and the spans within which the passes stay the same."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

from msgspec import Struct

from .sampling import Sample

MAX_SPANS = 40
"""Spans of one knob; of more, some are left out, the picture is that of a neighbor, and a note says so. Of the presets,
blurs of varying width have the most, as their pyramids grow: 33 in a picture of 480x270."""

MAX_VARIANTS = 40
"""Combinations of spans that a package may hold: each has its own list of passes, of about 10 KB."""


class Span(Struct, frozen=True):
    """A part of the range of a knob, with a value of the knob that stands for it."""

    low: float
    high: float
    middle: float


class VariantAxis(Struct, frozen=True):
    """A knob that changes passes, and its spans from low to high."""

    knob: str
    spans: tuple[Span, ...]
    skipped: int = 0
    """How many more lists of passes the knob has: there the picture is that of a neighbor."""

    @property
    def edges(self) -> list[float]:
        """The values of the knob between one span and the next."""
        return [(a.high + b.low) / 2.0 for a, b in itertools.pairwise(self.spans)]


def find_axis(knob: str, rest: float, samples: Mapping[float, Sample]) -> VariantAxis | None:
    """The spans of a knob; None if its passes stay the same everywhere. The value at `rest` stands for its span."""
    runs: list[list[float]] = []
    structures: list[object] = []
    for x, sample in samples.items():
        if not structures or sample.structure != structures[-1]:
            runs.append([])
            structures.append(sample.structure)
        runs[-1].append(x)
    if len(runs) < 2:
        return None
    count = len(runs)
    if count > MAX_SPANS:
        chosen = {round(at * (len(runs) - 1) / (MAX_SPANS - 2)) for at in range(MAX_SPANS - 1)}
        runs = [run for at, run in enumerate(runs) if at in chosen or rest in run]
    middles = [rest if rest in run else run[len(run) // 2] for run in runs]
    spans = (Span(run[0], run[-1], middle) for run, middle in zip(runs, middles, strict=True))
    return VariantAxis(knob, tuple(spans), count - len(runs))


def choose_axes(axes: Sequence[VariantAxis]) -> tuple[list[VariantAxis], list[VariantAxis]]:
    """The axes whose combinations a package can hold, and the others: those with few spans come first."""
    chosen, others, count = list[VariantAxis](), list[VariantAxis](), 1
    for axis in sorted(axes, key=lambda axis: len(axis.spans)):
        if count * len(axis.spans) <= MAX_VARIANTS:
            chosen.append(axis)
            count *= len(axis.spans)
        else:
            others.append(axis)
    return chosen, others
