"""Compares a benchmark with an older one: what became slower, and how much."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from msgspec import Struct

from ..errors import InputError, UsageError
from ..resources.input_files import read_bytes
from ..resources.sandbox import Sandbox
from .bench import Benchmark, identify_passes

MIN_JUDGED_SHARE = 0.02
"""The share of the total time that a pass must have to be judged. Chosen by judgement: on a busy machine totals vary by
some percent, so a pass that takes less cannot change the result."""


class Ratio(Struct, frozen=True):
    """How many times as long something takes as before: by its median, and by its fastest time.

    `nodes` are those of a pass; none for the total. Noise makes one of both ratios large, rarely both, so the smaller
    one is judged.
    """

    nodes: tuple[str, ...]
    functions: tuple[str, ...]
    median: float
    fastest: float
    before: float
    current: float

    @property
    def smaller(self) -> float:
        """The smaller one of both ratios."""
        return min(self.median, self.fastest)


class BaselineComparison(Struct, frozen=True):
    """The ratios to a baseline: the total first, then passes that both have. Others are counted as missing or new."""

    ratios: tuple[Ratio, ...]
    missing_passes: int
    new_passes: int
    device: str

    def find_slower(self, limit: float) -> tuple[Ratio, ...]:
        """The ratios above a limit, the largest first."""
        return tuple(
            sorted((ratio for ratio in self.ratios if ratio.smaller > limit), key=lambda ratio: -ratio.smaller)
        )


def compare_with_baseline(bench: Benchmark, path: Path, sandbox: Sandbox) -> BaselineComparison:
    """Compare with an earlier output of `halation bench --json`. Raises UsageError for any other file."""
    baseline = _read_baseline(path, sandbox)
    size = tuple(baseline["size"])
    if size != bench.size:
        then, size_text = ("x".join(map(str, sides)) for sides in (size, bench.size))
        raise UsageError(
            f"{path}: it was measured at {then} pixels, this is {size_text}: use the same --size and --scale"
        )
    before = {
        (tuple(timing["nodes"]), tuple(timing["functions"]), timing["number"]): timing for timing in baseline["passes"]
    }
    ratios = [_make_ratio((), (), bench.median, bench.fastest, baseline)]
    timings_by_name = dict(zip(identify_passes(bench.passes), bench.passes, strict=True))
    for name, timing in timings_by_name.items():
        then = before.get(name)
        if then and max(timing.median / bench.median, then["median"] / baseline["median"]) >= MIN_JUDGED_SHARE:
            ratios.append(_make_ratio(timing.nodes, timing.functions, timing.median, timing.fastest, then))
    return BaselineComparison(
        tuple(ratios),
        len(before.keys() - timings_by_name.keys()),
        len(timings_by_name.keys() - before.keys()),
        baseline["device"],
    )


def _make_ratio(
    nodes: tuple[str, ...], functions: tuple[str, ...], median: float, fastest: float, then: Mapping[str, Any]
) -> Ratio:
    return Ratio(nodes, functions, median / then["median"], fastest / then["fastest"], then["median"], median)


def _read_baseline(path: Path, sandbox: Sandbox) -> dict[str, Any]:
    try:
        baseline: Any = json.loads(read_bytes(path, sandbox))
        times = [entry[key] for entry in (baseline, *baseline["passes"]) for key in ("median", "fastest")]
        for timing in baseline["passes"]:
            _ = tuple(timing["nodes"]), tuple(timing["functions"]), int(timing["number"])
        if not all(isinstance(item, int | float) and item > 0.0 for item in times) or len(baseline["size"]) != 2:
            raise ValueError
        return {**baseline, "device": str(baseline["device"])}
    except InputError as fault:
        raise UsageError(f"--compare {fault}") from None
    except (ValueError, KeyError, TypeError, RecursionError):
        raise UsageError(
            f"--compare {path}: it is no measurement: make one with halation bench GRAPH --json > {path.name}"
        ) from None
