"""The tasks, measured: whole processes in turn, and the work in memory. Standard library alone: see `tasks`."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from bench.programs import HERE, Program
from bench.results import Results, Run
from bench.started import Ended, run
from bench.tasks import FRAMES, SIZES

SLOW = 20.0
"""Seconds from which a program does a task only once."""


@dataclass(frozen=True)
class Place:
    """A size, the folder of its pictures, and one for what programs write."""

    size: str
    folder: Path
    out: Path


def whole(results: Results, place: Place, task: str, programs: list[Program], rounds: int) -> None:
    """Whole processes in turn, after one of each that fills caches and whose picture is compared."""
    slow = set[str]()
    for turn in range(rounds + 1):
        for one in programs:
            if one.whole is None or task not in one.tasks:
                continue
            found = results.run(place.size, task, one.name)
            if found.error or (one.name in slow and turn > 1):
                continue
            file = place.out / (f"{one.name}.{task}.{{}}.exr" if task == "T10" else f"{one.name}.{task}.exr")
            ended = run(one.whole(task, place.folder, SIZES[place.size], file), one.environment)
            if ended.code:
                found.error = _last(ended)
            elif turn == 0:
                _compare(found, place.folder, Path(str(file).format(f"{FRAMES:04d}")))
                if ended.wall > SLOW:
                    slow.add(one.name)
            else:
                found.wall.append(ended.wall)
                found.cpu.append(ended.cpu)
                found.memory.append(ended.memory)


def memory(results: Results, place: Place, task: str, programs: list[Program], rounds: int, repeat: int) -> None:
    """The work in memory, program by program, each in a new process in every round."""
    slow = set[str]()
    for turn in range(rounds):
        for one in programs:
            if one.memory is None or task not in one.tasks or task == "T10":
                continue
            found = results.run(place.size, task, one.name)
            if found.error or (one.name in slow and turn):
                continue
            times = 1 if found.wall and median(found.wall) > SLOW else repeat
            ended = run(one.memory(task, place.folder, times), one.environment)
            if ended.code or "seconds" not in ended.result:
                found.error = _last(ended)
                continue
            found.op.append(median(ended.result["seconds"]))
            if ended.wall > SLOW:
                slow.add(one.name)


def _compare(found: Run, folder: Path, file: Path) -> None:
    """How far a file is off its reference; in another process, since this one has to stay small."""
    told = run([sys.executable, str(HERE / "references.py"), found.task, str(folder), str(file)]).result
    found.rms, found.peak = told.get("rms"), told.get("peak")


def _last(ended: Ended) -> str:
    """The last line that a program said, or how it ended."""
    return (ended.said.strip().splitlines() or [f"exit {ended.code}"])[-1][:200]
