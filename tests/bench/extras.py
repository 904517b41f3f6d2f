"""What is measured besides the tasks: starting up, a cold cache, planning, long sequences, wide blurs."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

from bench.figures import LIBRARIES
from bench.measuring import Place
from bench.programs import HERE, halation_command, memory_command, render_command
from bench.started import FinishedProcess, run_process
from bench.tasks import FRAMES, SEQUENCE, SIZES, TASKS

LONG = 240
PLANNED = (1000, 2000)
Say = Callable[[str], None]


def measure_extras(place: Place, rounds: int, repeat: int, say: Say) -> dict[str, Any]:
    """All of it, by name."""
    say("starting up")
    words = {"help": ["--help"], "check": ["check", str(TASKS["T5"].path)]}
    figures: dict[str, Any] = {
        name: {"wall": [], "loaded": _list_loaded_libraries(arguments)} for name, arguments in words.items()
    }
    for _ in range(rounds):
        for name, given in words.items():
            figures[name]["wall"].append(run_process([*halation_command(), *given]).wall)
    say("a cold cache of shaders")
    figures["cold"], figures["warm"] = _measure_cold_cache(place, rounds)
    say("wide blurs")
    wide: dict[str, list[float]] = {"20": [], "200": []}
    for _ in range(rounds):
        for sigma, seconds in wide.items():
            process = run_process([*memory_command("T1s10", place.folder, repeat), "--set", f"blur.sigma={sigma}"])
            seconds.append(median(_require_result(process)["seconds"]))
    figures["sigma"] = wide
    say("large graphs")
    figures["plans"] = _require_result(run_process([sys.executable, str(HERE / "planning.py"), *map(str, PLANNED)]))[
        "graphs"
    ]
    say("checks of large files")
    figures["checks"] = _require_result(run_process([sys.executable, str(HERE / "checking.py")]))["checks"]
    say(f"{LONG} frames")
    figures["frames"] = _measure_long_sequence(place)
    return figures


def _require_result(process: FinishedProcess) -> dict[str, Any]:
    if process.code or not process.result:
        raise SystemExit(f"a measurement ended with {process.code}:\n{process.output[-2000:]}")
    return process.result


def _list_loaded_libraries(words: list[str]) -> list[str]:
    """The heavy modules that a command loads."""
    output = run_process([sys.executable, "-X", "importtime", "-m", "halation.cli", *words]).output
    names = {line.rpartition("|")[2].strip().partition(".")[0] for line in output.splitlines() if "|" in line}
    return sorted(names & {"numpy", *LIBRARIES})


def _measure_cold_cache(place: Place, rounds: int) -> tuple[list[float], list[float]]:
    """T5 with an empty cache of shaders, and with one that was filled by a run before; seconds of each round."""
    cold, warm = list[float](), list[float]()
    command = render_command("T5", place.folder, SIZES[place.size], place.out / "cold.exr")
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as cache:
            environment = {"MESA_SHADER_CACHE_DIR": cache, "MESA_GLSL_CACHE_DIR": cache}
            for seconds in (cold, warm):
                process = run_process(command, environment)
                if process.code:
                    raise SystemExit(process.output)
                seconds.append(process.wall)
    return cold, warm


def _measure_long_sequence(place: Place) -> dict[str, float]:
    """Peak memory of T10 over some and over many frames, in MiB; many frames are the same ones again and again."""
    peaks: dict[str, float] = {}
    for count in (FRAMES, LONG):
        with tempfile.TemporaryDirectory(dir=place.out) as folder:
            frames = f"{folder}/in.{{:04d}}.exr"
            for frame in range(1, count + 1):
                source = place.folder / SEQUENCE.format((frame - 1) % FRAMES + 1)
                Path(frames.format(frame)).symlink_to(source.resolve())
            command = render_command("T10", place.folder, SIZES[place.size], Path(folder, "out.{}.exr"), frames)
            process = run_process(command, patience=1800.0)
        if process.code:
            raise SystemExit(process.output)
        peaks[str(count)] = process.memory
    return peaks
