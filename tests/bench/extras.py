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
from bench.programs import HERE, halation, in_memory, rendering
from bench.started import Ended, run
from bench.tasks import FRAMES, SEQUENCE, SIZES, TASKS

LONG = 240
PLANNED = (1000, 2000)
Say = Callable[[str], None]


def extras(place: Place, rounds: int, repeat: int, say: Say) -> dict[str, Any]:
    """All of it, by name."""
    say("starting up")
    words = {"help": ["--help"], "check": ["check", str(TASKS["T5"].path)]}
    found: dict[str, Any] = {name: {"wall": [], "loaded": _loaded(given)} for name, given in words.items()}
    for _ in range(rounds):
        for name, given in words.items():
            found[name]["wall"].append(run([*halation(), *given]).wall)
    say("a cold cache of shaders")
    found["cold"], found["warm"] = _cold(place, rounds)
    say("wide blurs")
    wide: dict[str, list[float]] = {"20": [], "200": []}
    for _ in range(rounds):
        for sigma, seconds in wide.items():
            ended = run([*in_memory("T1s10", place.folder, repeat), "--set", f"blur.sigma={sigma}"])
            seconds.append(median(_result(ended)["seconds"]))
    found["sigma"] = wide
    say("large graphs")
    found["plans"] = _result(run([sys.executable, str(HERE / "planning.py"), *map(str, PLANNED)]))["graphs"]
    say(f"{LONG} frames")
    found["frames"] = _long(place)
    return found


def _result(ended: Ended) -> dict[str, Any]:
    if ended.code or not ended.result:
        raise SystemExit(f"a measurement ended with {ended.code}:\n{ended.said[-2000:]}")
    return ended.result


def _loaded(words: list[str]) -> list[str]:
    """The heavy modules that a command loads."""
    said = run([sys.executable, "-X", "importtime", "-m", "halation.cli", *words]).said
    names = {line.rpartition("|")[2].strip().partition(".")[0] for line in said.splitlines() if "|" in line}
    return sorted(names & {"numpy", *LIBRARIES})


def _cold(place: Place, rounds: int) -> tuple[list[float], list[float]]:
    """T5 with an empty cache of shaders, and with one that was filled by a run before; seconds of each round."""
    cold, warm = list[float](), list[float]()
    command = rendering("T5", place.folder, SIZES[place.size], place.out / "cold.exr")
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as cache:
            kept = {"MESA_SHADER_CACHE_DIR": cache, "MESA_GLSL_CACHE_DIR": cache}
            for seconds in (cold, warm):
                ended = run(command, kept)
                if ended.code:
                    raise SystemExit(ended.said)
                seconds.append(ended.wall)
    return cold, warm


def _long(place: Place) -> dict[str, float]:
    """Peak memory of T10 over some and over many frames, in MiB; many frames are the same ones again and again."""
    found: dict[str, float] = {}
    for count in (FRAMES, LONG):
        with tempfile.TemporaryDirectory(dir=place.out) as made:
            frames = f"{made}/in.{{:04d}}.exr"
            for frame in range(1, count + 1):
                source = place.folder / SEQUENCE.format((frame - 1) % FRAMES + 1)
                Path(frames.format(frame)).symlink_to(source.resolve())
            command = rendering("T10", place.folder, SIZES[place.size], Path(made, "out.{}.exr"), frames)
            ended = run(command, patience=1800.0)
        if ended.code:
            raise SystemExit(ended.said)
        found[str(count)] = ended.memory
    return found
