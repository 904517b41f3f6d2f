"""Renders and saves that are killed at every system call that writes: what is there afterwards is whole, old or new.

strace sends the signal as the n-th call of a kind begins, for n = 1, 2, ... until the program comes to its end, so no
moment is left to luck. Needs strace (Debian: apt-get install strace).
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
    """Up to so many kills, scene by scene and call by call."""
    if not shutil.which("strace"):
        raise SystemExit("kills need strace: apt-get install strace")
    tally = Tally()
    for scene, words in SCENES.items():
        for call in CALLS:
            number = 0
            while tally.count < count:
                number += 1
                if not _kill_once(tally, scene, words, call, number, keep):
                    break
    return tally


def _kill_once(tally: Tally, scene: str, words: tuple[str, ...], call: str, number: int, keep: Path | None) -> bool:
    """Whether there was a call of that number to die at."""
    folder = Path(tempfile.mkdtemp(prefix="hostile-kill-"))
    try:
        prepare(folder)
        command = [
            *("strace", "-f", "-qq", "-o", "/dev/null", "-P", str(folder)),
            *("-e", f"trace={call}", "-e", f"inject={call}:signal=KILL:when={number}"),
            sys.executable, "-P", "-m", "halation.cli", *words,
        ]  # fmt: skip
        # -P follows only calls on paths below the folder; descriptors of files there count as such.
        result = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, env={**os.environ, "LP_NUM_THREADS": "1"}
        )
        if result.returncode == 0:
            return False
        tally.count += 1
        name = f"kill {scene} {call} {number}"
        for fault in find_broken(folder):
            tally.faults.append((name, fault))
            print(f"{name}: {fault}", flush=True)
            if keep:
                shutil.copytree(folder, keep / name.replace(" ", "-"), dirs_exist_ok=True)
        return True
    finally:
        shutil.rmtree(folder, ignore_errors=True)
