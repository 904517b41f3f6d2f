"""Cases: each a graph and the pictures that it must give."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from msgspec import Struct, field

ENDING = ".suite.toml"


class Metric(Struct, frozen=True):
    """A measure of the difference of pictures. `least` means that the tolerance is the smallest allowed value."""

    name: str
    tolerance: float
    least: bool = False
    unit: str = ""

    def allows(self, value: float, tolerance: float) -> bool:
        """True if a case with this value passes."""
        return value >= tolerance if self.least else value <= tolerance

    def describe(self, value: float, tolerance: float) -> str:
        """Value and tolerance for a sentence."""
        bound = "at least" if self.least else "at most"
        measure, limit = format_number(value), format_number(tolerance)
        return f"{self.name} {measure}{self.unit} where {bound} {limit}{self.unit} is allowed"


PER_PIXEL = ("max_rel", "max_abs")
"""Measures of single pixels. The usual tolerances below are, for them, one step of 8 bits (1 / 255); for whole pictures
they are chosen by judgement, where a difference is not visible yet."""
METRICS = {
    item.name: item
    for item in (
        Metric("max_rel", 0.004),
        Metric("max_abs", 0.004),
        Metric("rms", 0.001),
        Metric("psnr", 40.0, True, " dB"),
        Metric("ssim", 0.99, True),
        Metric("flip", 0.01),
    )
}


class Golden(Struct, frozen=True):
    """A picture that a case must give. `output` is the graph's; "" stands for all of them."""

    path: Path
    output: str = ""


class Case(Struct, frozen=True):
    """One test. Paths are complete; `values` are as they stand in the file.

    Without goldens a case must only render. With `error` it must fail, with this text in the sentence. `failing` is
    the percentage of pixels that may be beyond the tolerance of `max_rel` or `max_abs`.
    """

    suite: Path
    name: str
    graph: Path
    inputs: Mapping[str, Any] = field(default_factory=dict[str, Any])
    values: Mapping[str, Any] = field(default_factory=dict[str, Any])
    frames: tuple[int, ...] = ()
    size: tuple[int, int] | None = None
    scale: float = 1.0
    node: str = ""
    goldens: tuple[Golden, ...] = ()
    metric: str = "max_rel"
    tolerance: float = METRICS["max_rel"].tolerance
    failing: float = 0.0
    precision: str = "half"
    view: str = ""
    error: str = ""
    allow: tuple[str, ...] = ()
    skip: str = ""

    @property
    def id(self) -> str:
        """The name of a case: its file and its own name."""
        return f"{self.suite.as_posix()}::{self.name}"


def format_number(value: float) -> str:
    """A measure in few digits."""
    return f"{value:.4g}"
