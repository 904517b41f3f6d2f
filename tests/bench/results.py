"""What was measured, as it is kept in a file, and what can be asked of it. Standard library alone: see `tasks`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

FORMAT = 1


@dataclass
class Run:
    """A task by a program at a size. Lists have one number for each round: seconds, MiB.

    `op` is the median of the operation in memory in a round; `rms` and `peak` say how far the file is off.
    """

    size: str
    task: str
    program: str
    wall: list[float] = field(default_factory=list[float])
    cpu: list[float] = field(default_factory=list[float])
    memory: list[float] = field(default_factory=list[float])
    op: list[float] = field(default_factory=list[float])
    rms: float | None = None
    peak: float | None = None
    error: str = ""


@dataclass
class Results:
    """All of a measurement: `extras` are what is not one of the tasks, by name."""

    machine: dict[str, Any] = field(default_factory=dict[str, Any])
    runs: list[Run] = field(default_factory=list[Run])
    extras: dict[str, Any] = field(default_factory=dict[str, Any])

    def find(self, size: str, task: str, program: str) -> Run | None:
        """The run, if there is one."""
        return next((one for one in self.runs if (one.size, one.task, one.program) == (size, task, program)), None)

    def run(self, size: str, task: str, program: str) -> Run:
        """The run; a new one if there is none."""
        run = self.find(size, task, program)
        if run is None:
            run = Run(size, task, program)
            self.runs.append(run)
        return run

    def middle(self, size: str, task: str, program: str, what: str) -> float | None:
        """The median of wall, cpu, memory or op."""
        run = self.find(size, task, program)
        numbers = getattr(run, what) if run else None
        return median(numbers) if numbers else None

    def best(self, size: str, task: str, programs: Iterable[str], what: str) -> str | None:
        """The program with the smallest median."""
        medians = {name: self.middle(size, task, name, what) for name in programs}
        measured = {name: number for name, number in medians.items() if number is not None}
        return min(measured, key=lambda name: measured[name]) if measured else None

    def ratio(self, size: str, task: str, what: str, program: str, others: Sequence[str]) -> float | None:
        """A program against the best of some others: the median of the ratios of the rounds."""
        other = self.best(size, task, others, what)
        return median_ratio(self._numbers(size, task, program, what), self._numbers(size, task, other, what))

    def _numbers(self, size: str, task: str, program: str | None, what: str) -> list[float]:
        run = self.find(size, task, program) if program else None
        return getattr(run, what) if run else []

    def save(self, path: Path) -> None:
        """Write them as JSON."""
        document = {"format": FORMAT, **asdict(self)}
        path.write_text(json.dumps(document, indent=1) + "\n", "utf-8")

    @classmethod
    def load(cls, path: Path) -> Results:
        """Read what `save` wrote. Raises SystemExit for anything else."""
        try:
            document = json.loads(path.read_text("utf-8"))
            if document["format"] != FORMAT:
                raise ValueError(f"its format is {document['format']}")
            return cls(document["machine"], [Run(**one) for one in document["runs"]], document["extras"])
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise SystemExit(f"{path}: no results of this benchmark: {error}") from None


def median_ratio(numbers: Sequence[float], others: Sequence[float]) -> float | None:
    """The median of the ratios of what was measured in the same round; of the medians, where rounds are missing."""
    if not numbers or not others:
        return None
    if len(numbers) != len(others):
        return median(numbers) / median(others)
    return median(one / other for one, other in zip(numbers, others, strict=True))
