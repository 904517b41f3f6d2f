"""Renders and saves that are killed at every system call that writes: what is there afterwards is whole, old or new.

A first run is only watched: it tells which calls concern files of the folder. Then strace sends the signal as each of
them begins, so no moment is left to luck. Needs strace (Debian: apt-get install strace).
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import OpenImageIO as oiio
from pool import Tally

CALLS = (
    "write",
    "pwrite64",
    "writev",
    "rename",
    "renameat2",
    "openat",
    "ftruncate",
    "fallocate",
    "sendfile",
    "fsync",
    "unlink",
    "unlinkat",
)
"""The calls that change files."""

SCENES: dict[str, tuple[str, ...]] = {
    "one EXR": ("render", "graph.json", "-o", "out.exr"),
    "a PNG": ("render", "graph.json", "-o", "out.png"),
    "two files": ("render", "graph.json", "-o", "out.exr", "-o", "image=out.png"),
    "a sequence": ("render", "graph.json", "-o", "out.####.exr", "--frames", "1-3"),
    "fmt": ("fmt", "messy.json"),
}

GRAPH = {
    "halation": 1,
    "settings": {"size": [40, 24]},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"n": {"type": "noise"}},
    "links": {"outputs.image": "n.out"},
}


def prepare(folder: Path) -> None:
    """Graphs, and older results where new ones will be written."""
    (folder / "graph.json").write_text(json.dumps(GRAPH))
    (folder / "messy.json").write_text(json.dumps(GRAPH, indent=7))
    for name in ("out.exr", "out.png", "out.0001.exr", "out.0002.exr"):
        oiio.ImageBuf(oiio.ImageSpec(8, 8, 4, "half")).write(str(folder / name))


def find_broken(folder: Path) -> Iterator[str]:
    """Results that are neither whole nor absent."""
    for path in sorted(folder.glob("out.*")):
        picture = oiio.ImageInput.open(str(path))
        if picture is None or picture.read_image() is None:
            yield f"half-written: {path.name}"
    for path in sorted(folder.glob("*.json")):
        try:
            json.loads(path.read_text("utf-8"))
        except ValueError:
            yield f"half-written: {path.name}"


def run_kills(count: int, keep: Path | None) -> Tally:
    """Up to so many kills: every call on a file of the folder that a whole run makes, scene after scene."""
    if not shutil.which("strace"):
        raise SystemExit("kills need strace: apt-get install strace")
    tally = Tally()
    for scene, words in SCENES.items():
        for call, number in sorted(_find_calls(words)):
            if tally.count < count:
                _kill(tally, scene, words, call, number, keep)
    return tally


def _find_calls(words: tuple[str, ...]) -> set[tuple[str, int]]:
    """The calls that concern the folder, each with its number among those of its name in its thread."""
    with tempfile.TemporaryDirectory(prefix="hostile-kill-") as text:
        folder, log = Path(text), Path(text, "strace.log")
        prepare(folder)
        _run(folder, words, "-y", "-o", str(log), "-e", f"trace={','.join(CALLS)}")
        counts: dict[tuple[str, str], int] = {}
        calls: set[tuple[str, int]] = set()
        for line in log.read_text("utf-8", "replace").splitlines():
            thread, _, rest = line.partition(" ")
            call = rest.strip().partition("(")[0]
            if call not in CALLS:  # the end of a call that another thread interrupted
                continue
            counts[thread, call] = counts.get((thread, call), 0) + 1
            if text in rest and "strace.log" not in rest:
                calls.add((call, counts[thread, call]))
        return calls


def _run(folder: Path, words: tuple[str, ...], *options: str) -> int:
    command = ["strace", "-f", "-qq", "--seccomp-bpf", *options, sys.executable, "-P", "-m", "halation.cli", *words]
    environment = {**os.environ, "LP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(command, cwd=folder, capture_output=True, env=environment).returncode


def _kill(tally: Tally, scene: str, words: tuple[str, ...], call: str, number: int, keep: Path | None) -> None:
    with tempfile.TemporaryDirectory(prefix="hostile-kill-") as text:
        folder = Path(text)
        prepare(folder)
        inject = f"inject={call}:signal=KILL:when={number}"
        if _run(folder, words, "-o", "/dev/null", "-e", f"trace={call}", "-e", inject) == 0:
            return
        tally.count += 1
        name = f"kill {scene} {call} {number}"
        for fault in find_broken(folder):
            tally.faults.append((name, fault))
            print(f"{name}: {fault}", flush=True)
            if keep:
                shutil.copytree(folder, keep / name.replace(" ", "-"), dirs_exist_ok=True)
