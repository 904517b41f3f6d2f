"""The programs that are measured, and how each is started. Standard library alone: see `tasks`."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from bench.peers import gegl_peer
from bench.started import run_process
from bench.tasks import SEQUENCE, TASKS, picture_path

HERE = Path(__file__).parent
OURS = "halation"
BLENDERS = ("blender", "blender_gpu", "blender5", "blender5_gpu")

Size = tuple[int, int]


@dataclass(frozen=True)
class Program:
    """A program: the tasks it can do, its command for a whole process and, if there is one, for the work in memory."""

    name: str
    tasks: tuple[str, ...]
    whole: Callable[[str, Path, Size, Path], list[str]] | None
    memory: Callable[[str, Path, int], list[str]] | None = None
    environment: Mapping[str, str] = field(default_factory=dict)


def find_programs(venvs: Path | None) -> Iterator[Program]:
    """All programs that are there, ours first. `venvs` holds folders blender, blender5, numba, opencv."""
    yield Program(OURS, tuple(TASKS), render_command, memory_command)
    yield Program("halation_unfused", ("T5",), None, lambda *given: [*memory_command(*given), "--unfused"])
    yield from _find_script("raw", "raw", venvs, {})
    yield from _find_script("raw_unfused", "raw", venvs, {"RAW_UNFUSED": "1"}, only=("T5",))
    yield from _find_script("opencv", "opencv", venvs, {})
    yield from _find_script("opencv_fast", "opencv", venvs, {"OPENCV_FAST": "1"})
    yield from _find_script("numba", "numba", venvs, {})
    if gegl := shutil.which("gegl"):
        threads = {"GEGL_THREADS": str(len(os.sched_getaffinity(0)))}
        yield Program("gegl", gegl_peer.TASKS, lambda *given: gegl_peer.command(gegl, *given), None, threads)
    for name in BLENDERS:
        device = "GPU" if name.endswith("_gpu") else "CPU"
        yield from _find_script(name, "blender", venvs, {"BLENDER_DEVICE": device})


def halation_command() -> list[str]:
    """The command beside this Python, else its module."""
    beside = Path(sys.executable).with_name("halation")
    return [str(beside)] if beside.exists() else [sys.executable, "-m", "halation.cli"]


def render_command(task: str, folder: Path, size: Size, out: Path, frames: str = SEQUENCE) -> list[str]:
    """What a user types. Code in graphs is not watched: that would be a second process."""
    definition = TASKS[task]
    words = [*halation_command(), "render", str(definition.path)]
    for name in definition.inputs:
        path = folder / _write_pattern(frames) if (task, name) == ("T10", "a") else picture_path(folder, name)
        words += ["-i", f"{name}={path}"]
    for name, value in definition.values(size[0]).items():
        words += ["--set", f"{name}={_write_value(value)}"]
    return [*words, "-o", _write_pattern(str(out)), *(["--timeout", "0"] if definition.has_code else [])]


def memory_command(task: str, folder: Path, repeat: int) -> list[str]:
    """The engine alone."""
    return [sys.executable, str(HERE / "engine.py"), task, str(folder), "--repeat", str(repeat)]


def _write_pattern(text: str) -> str:
    return text.replace("{:04d}", "####").replace("{}", "####")


def _write_value(value: Any) -> str:
    return ",".join(f"{number!r}" for number in value) if isinstance(value, tuple) else repr(value)


def _find_script(
    name: str, script: str, venvs: Path | None, environment: Mapping[str, str], only: tuple[str, ...] = ()
) -> Iterator[Program]:
    """A peer that is a script, if its libraries are there: in the folder of its name, or beside this Python."""
    own = venvs / name.removesuffix("_gpu").removesuffix("_fast") / "bin" / "python" if venvs else None
    python = str(own) if own and own.exists() else sys.executable
    path = str(HERE / "peers" / f"{script}_peer.py")
    tasks = tuple(run_process([python, path, "--list"], environment).result.get("tasks", ()))
    if tasks:
        yield Program(
            name,
            only or tasks,
            None if only else lambda task, folder, size, out: [python, path, task, str(folder), "--out", str(out)],
            lambda task, folder, repeat: [python, path, task, str(folder), "--repeat", str(repeat)],
            environment,
        )
