"""The same renders under other conditions: with an empty cache of shaders, and on fewer processors.

Ratios are taken within a round. Standard library alone: see `tasks`.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from statistics import median
from typing import Any

from bench.figures import Figure, Row
from bench.measuring import Place
from bench.programs import halation_command, render_command
from bench.results import median_ratio
from bench.started import run_process
from bench.tasks import SIZES

PRESETS = Path(__file__).parents[2] / "presets"
STACK = "post_stack"
"""A preset of ten effects."""
SCALED = ("T5", "T8", STACK, "T10")
Say = Callable[[str], None]


def list_presets() -> tuple[str, ...]:
    """The names of all presets."""
    return tuple(sorted(path.stem for path in PRESETS.glob("*.json")))


def measure_presets(names: tuple[str, ...], rounds: int, say: Say) -> dict[str, dict[str, list[float]]]:
    """Seconds of the first frame of each preset, `cold` with an empty cache of shaders and `warm` with that cache."""
    seconds: dict[str, dict[str, list[float]]] = {}
    for name in names:
        say(f"preset {name}")
        times: dict[str, list[float]] = {"cold": [], "warm": []}
        for turn in range(rounds + 1):
            with tempfile.TemporaryDirectory() as folder:
                command = _render_preset(name, Path(folder, "out.exr"))
                for kept in times.values():
                    wall = _run(command, {"MESA_SHADER_CACHE_DIR": folder, "MESA_GLSL_CACHE_DIR": folder})
                    if turn:  # the first round fills caches of files
                        kept.append(wall)
        seconds[name] = times
    return seconds


def measure_threads(place: Place, rounds: int, say: Say) -> dict[str, dict[str, list[float]]]:
    """Seconds of tasks by the number of processors: 1, 2, 4 and so on, as many as there are."""
    processors = sorted(os.sched_getaffinity(0))
    pin = shutil.which("taskset")
    if pin is None:
        raise SystemExit("--parts threads needs taskset, of util-linux")
    counts = [count for count in (1, 2, 4, 8, 16) if count <= len(processors)]
    seconds: dict[str, dict[str, list[float]]] = {}
    for task in SCALED:
        say(f"threads: {task}")
        file = place.out / ("threads.{}.exr" if task == "T10" else "threads.exr")
        command = (
            _render_preset(task, file) if task == STACK else render_command(task, place.folder, SIZES[place.size], file)
        )
        times: dict[str, list[float]] = {str(count): [] for count in counts}
        for turn in range(rounds + 1):
            for count, kept in times.items():
                chosen = ",".join(map(str, processors[: int(count)]))
                wall = _run([pin, "-c", chosen, *command], {"LP_NUM_THREADS": count})
                if turn:
                    kept.append(wall)
        seconds[task] = times
    return seconds


def compute_condition_rows(extras: Mapping[str, Any]) -> Iterator[Row]:
    """What is wanted of presets and threads, of what was measured."""
    if presets := extras.get("presets"):
        ratios = {name: median_ratio(times["cold"], times["warm"]) or 0.0 for name, times in presets.items()}
        walls = {name: median(times["cold"]) for name, times in presets.items()}
        worst, slowest = max(ratios, key=ratios.__getitem__), max(walls, key=walls.__getitem__)
        yield Row(
            f"{len(presets)} presets with an empty cache of shaders against a full one",
            "median 1.5, worst 2.2; none over 1.6 s",
            (
                Figure("median", median(ratios.values()), 1.5),
                Figure(worst, ratios[worst], 2.2),
                Figure(slowest, walls[slowest], 1.6, " s"),
            ),
        )
    for task, times in extras.get("threads", {}).items():
        single = times["1"]
        yield Row(
            f"{task}: speed-up by threads",
            "to be known",
            tuple(Figure(f"{count}:", median_ratio(single, seconds), float("inf")) for count, seconds in times.items()),
        )


def _render_preset(name: str, file: Path) -> list[str]:
    return [*halation_command(), "render", str(PRESETS / f"{name}.json"), "-o", str(file)]


def _run(command: list[str], environment: Mapping[str, str]) -> float:
    process = run_process(command, environment)
    if process.code:
        raise SystemExit(process.output)
    return process.wall
