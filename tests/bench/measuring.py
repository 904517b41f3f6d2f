"""The tasks, measured: whole processes in turn, and the work in memory. Standard library alone: see `tasks`."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from bench.programs import HERE, Program
from bench.results import Results, Run
from bench.started import FinishedProcess, run_process
from bench.tasks import FRAMES, SIZES

SLOW = 20.0
"""Seconds from which a program does a task only once."""


@dataclass(frozen=True)
class Place:
    """A size, the folder of its pictures, and one for what programs write."""

    size: str
    folder: Path
    out: Path


def measure_processes(results: Results, place: Place, task: str, programs: list[Program], rounds: int) -> None:
    """Whole processes in turn, after one of each that fills caches and whose picture is compared."""
    slow = set[str]()
    for turn in range(rounds + 1):
        for program in programs:
            if program.whole is None or task not in program.tasks:
                continue
            measured_run = results.run(place.size, task, program.name)
            if measured_run.error or (program.name in slow and turn > 1):
                continue
            file = place.out / (f"{program.name}.{task}.{{}}.exr" if task == "T10" else f"{program.name}.{task}.exr")
            process = run_process(program.whole(task, place.folder, SIZES[place.size], file), program.environment)
            if process.code:
                measured_run.error = _last_line(process)
            elif turn == 0:
                _compare(measured_run, place.folder, Path(str(file).format(f"{FRAMES:04d}")))
                if process.wall > SLOW:
                    slow.add(program.name)
            else:
                measured_run.wall.append(process.wall)
                measured_run.cpu.append(process.cpu)
                measured_run.memory.append(process.memory)


def measure_in_memory(
    results: Results, place: Place, task: str, programs: list[Program], rounds: int, repeat: int
) -> None:
    """The work in memory, program by program, each in a new process in every round."""
    slow = set[str]()
    for turn in range(rounds):
        for program in programs:
            if program.memory is None or task not in program.tasks or task == "T10":
                continue
            measured_run = results.run(place.size, task, program.name)
            if measured_run.error or (program.name in slow and turn):
                continue
            times = 1 if measured_run.wall and median(measured_run.wall) > SLOW else repeat
            process = run_process(program.memory(task, place.folder, times), program.environment)
            if process.code or "seconds" not in process.result:
                measured_run.error = _last_line(process)
                continue
            measured_run.op.append(median(process.result["seconds"]))
            if process.wall > SLOW:
                slow.add(program.name)


def _compare(measured_run: Run, folder: Path, file: Path) -> None:
    """How far a file is off its reference; in another process, since this one has to stay small."""
    errors = run_process(
        [sys.executable, str(HERE / "references.py"), measured_run.task, str(folder), str(file)]
    ).result
    measured_run.rms, measured_run.peak = errors.get("rms"), errors.get("peak")


def _last_line(process: FinishedProcess) -> str:
    """The last line that a program said, or how it ended."""
    return (process.output.strip().splitlines() or [f"exit {process.code}"])[-1][:200]
