"""What is wanted of the numbers, and whether it is reached. Standard library alone: see `tasks`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from bench.programs import BLENDERS, OURS
from bench.results import Results, median_ratio

SCRIPTS = ("opencv", "opencv_fast", "numba")
AGAINST_BLENDER: Mapping[str, float] = {
    "copy": 0.6,
    "T1s3": 0.6,
    "T1s10": 0.6,
    "T1s50": 0.6,
    "T2": 0.8,
    "T3": 0.6,
    "T4": 0.6,
    "T5": 0.5,
    "T6": 0.6,
    "T8": 0.2,
    "T9": 0.45,
    "T10": 0.42,
}
AGAINST_GEGL: tuple[str, ...] = ("copy", "T1s3", "T1s10", "T1s50", "T2", "T3", "T4", "T5", "T6", "T8", "T10")
AGAINST_SCRIPTS: Mapping[str, float] = {
    "copy": 1.0,
    "T1s3": 1.2,
    "T1s10": 1.0,
    "T1s50": 1.0,
    "T2": 1.0,
    "T3": 1.0,
    "T4": 1.0,
    "T5": 0.95,
    "T6": 1.2,
    "T7": 1.0,
    "T8": 0.6,
    "T9": 0.6,
    "T10": 0.65,
}
LIBRARIES = ("moderngl", "glcontext", "OpenImageIO", "PyOpenColorIO", "glfw", "imgui_bundle")
"""Those for drawing and for pictures, which a command without either does not load."""
EXACT: Mapping[str, float] = {"T1s3": 3e-4, "T1s10": 3e-4, "T1s50": 3e-4, "T3": 3e-4, "T4": 3e-4, "T5": 3e-4}


@dataclass(frozen=True)
class Figure:
    """A number that is wanted to be at most so much; None where it was not measured."""

    label: str
    number: float | None
    limit: float
    unit: str = ""

    @property
    def is_reached(self) -> bool:
        """True if it is known and not too large."""
        return self.number is not None and self.number <= self.limit

    def __str__(self) -> str:
        mark = "" if self.is_reached else " **(!)**"
        return f"{self.label} {format_number(self.number)}{self.unit}{mark}".strip()


@dataclass(frozen=True)
class Row:
    """A line of the table: what is looked at, what is wanted in words, the numbers."""

    what: str
    wanted: str
    figures: tuple[Figure, ...]

    @property
    def verdict(self) -> str:
        """yes, no, or a line if nothing of it was measured."""
        measured = [one for one in self.figures if one.number is not None]
        return "\N{EN DASH}" if not measured else "yes" if all(one.is_reached for one in measured) else "no"


def format_number(number: float | None) -> str:
    """Three digits; small ones with an exponent."""
    if number is None:
        return "?"
    return f"{number:.1e}" if 0.0 < abs(number) < 1e-3 else f"{number:.3g}"


def compute_rows(results: Results) -> Iterator[Row]:
    """All that is wanted, of the smallest size that was measured and of uhd."""
    hd = results.runs[0].size if results.runs else "hd"

    def ratios(size: str, what: str, limits: Mapping[str, float], others: Sequence[str]) -> tuple[Figure, ...]:
        return tuple(
            Figure(task, results.ratio(size, task, what, OURS, others), limit) for task, limit in limits.items()
        )

    def op(task: str, program: str, other: str, limit: float, label: str) -> Figure:
        return Figure(label, results.ratio(hd, task, "op", program, [other]), limit)

    def apart(task: str, other: str) -> float | None:
        one, two = results.find(hd, task, OURS), results.find(hd, other, OURS)
        return median_ratio(one.op, two.op) if one and two else None

    wanted = "copy, T1, T3, T4, T6 0.6; T2 0.8; T5 0.5; T9 0.45; T10 0.42; T8 0.2"
    yield Row(f"whole process against the best Blender, {hd}", wanted, ratios(hd, "wall", AGAINST_BLENDER, BLENDERS))
    single = {task: 1.15 for task in (*AGAINST_BLENDER, "T7") if task != "T10"}
    yield Row("whole process against raw shaders, uhd", "1.15", ratios("uhd", "wall", single, ["raw"]))
    gegl = dict.fromkeys(AGAINST_GEGL, 0.6)
    yield Row(f"whole process against GEGL, {hd}", "0.6", ratios(hd, "wall", gegl, ["gegl"]))
    wanted = "T5 0.95; T8, T9 0.6; T10 0.65; T1s3, T6 1.2; all else 1"
    scripts = ratios(hd, "wall", AGAINST_SCRIPTS, SCRIPTS)
    yield Row(f"whole process against OpenCV and numba scripts, {hd}", wanted, scripts)
    blender = results.best(hd, "T5", BLENDERS, "op") or BLENDERS[0]
    wanted = "T5 1.15 of raw shaders, 1/6 of Blender, 0.6 of unfused; sigma 50 1.3 of sigma 10; T7 0.2 of numba"
    yield Row(
        f"in memory, {hd}",
        wanted,
        (
            op("T5", OURS, "raw", 1.15, "T5 / raw"),
            op("T5", OURS, blender, 1.0 / 6.0, "T5 / Blender"),
            op("T5", OURS, "halation_unfused", 0.6, "fused / unfused"),
            Figure("sigma 50 / 10", apart("T1s50", "T1s10"), 1.3),
            op("T7", OURS, "numba", 0.2, "T7 / numba"),
        ),
    )
    yield Row(
        f"blur of sigma 3 in memory against OpenCV, {hd}",
        "to be known",
        (op("T1s3", OURS, "opencv", float("inf"), ""),),
    )
    frames = results.extras.get("frames")
    yield Row(
        f"24 frames, {hd}",
        "1.1 of raw shaders; memory of 240 frames that of 24 (1.05)",
        (
            Figure("T10 / raw", results.ratio(hd, "T10", "wall", OURS, ["raw"]), 1.1),
            Figure("memory 240 / 24", frames["240"] / frames["24"] if frames else None, 1.05),
        ),
    )
    memory = ratios(hd, "memory", dict.fromkeys(AGAINST_BLENDER, 0.8), BLENDERS)
    opencv = Figure("T5 / OpenCV", results.ratio(hd, "T5", "memory", OURS, ["opencv"]), 1.0)
    yield Row(f"peak memory, {hd}", "0.8 of Blender's; T5 below OpenCV's", (*memory, opencv))
    yield from _compute_extras(results.extras)
    yield Row(
        f"accuracy, {hd}: RMS of the difference as a part of the picture's",
        "3e-4",
        tuple(
            Figure(task, found.rms if (found := results.find(hd, task, OURS)) else None, limit)
            for task, limit in EXACT.items()
        ),
    )
    yield Row(
        f"accuracy, {hd}: largest difference as a part of the largest number",
        "1e-3",
        tuple(
            Figure(task, found.peak if (found := results.find(hd, task, OURS)) else None, 1e-3)
            for task in ("T1s3", "T1s10", "T1s50")
        ),
    )
    yield Row(
        f"copy of one EXR, whole process, {hd}",
        "1.1 of raw shaders",
        (Figure("", results.ratio(hd, "copy", "wall", OURS, ["raw"]), 1.1),),
    )


def _compute_extras(extras: Mapping[str, Any]) -> Iterator[Row]:
    """What is not one of the tasks."""
    start = [
        figure
        for name in ("help", "check")
        if name in extras
        for figure in (
            Figure(name, median(extras[name]["wall"]), 0.15, " s"),
            Figure(f"libraries that {name} loads", len(set(extras[name]["loaded"]) & set(LIBRARIES)), 0),
        )
    ]
    yield Row("`--help`, and `check` of a graph without files", "0.15 s, neither GL nor OpenImageIO", tuple(start))
    yield Row(
        "cold cache of shaders against warm, T5",
        "2",
        (Figure("", median_ratio(extras["cold"], extras["warm"]) if "cold" in extras else None, 2.0),),
    )
    plans = {plan["nodes"]: plan for plan in extras.get("plans", ())}
    small, large = plans.get(1000), plans.get(2000)
    yield Row(
        "planning 1,000 nodes",
        "150 ms; 2,000 at most 2.2 times that",
        (
            Figure("1,000", median(small["plan"]) * 1e3 if small else None, 150.0, " ms"),
            Figure("2,000 / 1,000", median(large["plan"]) / median(small["plan"]) if small and large else None, 2.2),
        ),
    )
    yield Row(
        "a value changes in 1,000 nodes",
        "no new program, a plan in 10 ms",
        (
            Figure("programs", small["programs"] if small else None, 0),
            Figure("plan", median(small["change"]) * 1e3 if small else None, 10.0, " ms"),
        ),
    )
    checks = {check["name"]: check for check in extras.get("checks", ())}
    chain = checks.get("99,000 nodes")
    yield Row(
        "processor time and memory of `check` with 99,000 nodes",
        "10 s, 1,000 MiB",
        (
            Figure("", chain["seconds"] if chain else None, 10.0, " s"),
            Figure("", chain["memory"] if chain else None, 1000.0, " MiB"),
        ),
    )
    sigma = extras.get("sigma")
    yield Row(
        "sigma 200 against sigma 20, in memory",
        "1.5",
        (Figure("", median_ratio(sigma["200"], sigma["20"]) if sigma else None, 1.5),),
    )


def format_table(rows: Iterable[Row]) -> str:
    """The table in Markdown."""
    lines = ["| what | wanted, at most | measured | reached |", "|---|---|---|---|"]
    for row in rows:
        known = ", ".join(str(one) for one in row.figures if one.number is not None) or "not measured"
        lines.append(f"| {row.what} | {row.wanted} | {known} | {row.verdict} |")
    return "\n".join(lines)
