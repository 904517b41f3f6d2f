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
from concurrent.futures import ThreadPoolExecutor
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
    "a TIFF": ("render", "graph.json", "-o", "out.tif"),
    "a JPEG": ("render", "graph.json", "-o", "out.jpg"),
    "a WebP": ("render", "graph.json", "-o", "out.webp"),
    "an HDR": ("render", "graph.json", "-o", "out.hdr"),
    "a DPX": ("render", "graph.json", "-o", "out.dpx"),
    "two processes": ("render", "graph.json", "-o", "out.####.exr", "--frames", "1-6", "-j", "2"),
    "fmt": ("fmt", "messy.json"),
    "many graphs": ("fmt", "many"),
    "a log": ("check", "messy.json", "--sarif", "log.json"),
    "a long sequence": ("render", "graph.json", "-o", "out.####.exr", "--frames", "1-48"),
    "tiles": ("render", "graph.json", "-o", "out.exr", "--size", "900x700", "--memory", "12M"),
    "pictures of a sequence": ("render", "graph.json", "-o", "out.####.png", "--frames", "1-24"),
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
    (folder / "log.json").write_text("{}")
    (folder / "many").mkdir()
    for number in range(12):
        (folder / "many" / f"{number}.json").write_text(json.dumps(GRAPH, indent=5))
    for name in ("out.exr", "out.png", "out.0001.exr", "out.0002.exr"):
        oiio.ImageBuf(oiio.ImageSpec(8, 8, 4, "half")).write(str(folder / name))


def find_broken(folder: Path) -> Iterator[str]:
    """Results that are neither whole nor absent."""
    for path in sorted(folder.glob("out.*")):
        picture = oiio.ImageInput.open(str(path))
        if picture is None or picture.read_image() is None:
            yield f"half-written: {path.name}"
    for path in sorted(folder.rglob("*.json")):
        try:
            json.loads(path.read_text("utf-8"))
        except ValueError:
            yield f"half-written: {path.name}"


def run_kills(count: int, jobs: int, keep: Path | None) -> Tally:
    """Up to so many kills: every call that changes a file of the folder in a whole run, scene after scene."""
    if not shutil.which("strace"):
        raise SystemExit("kills need strace: apt-get install strace")
    with ThreadPoolExecutor(jobs) as threads:
        calls = threads.map(_find_calls, SCENES.values())
        moments = [
            (scene, *call) for scene, scene_calls in zip(SCENES, calls, strict=True) for call in sorted(scene_calls)
        ]
        results = list(threads.map(lambda moment: _kill(*moment, keep), moments[:count]))
    tally = Tally()
    for name, faults in filter(None, results):
        tally.count += 1
        tally.faults += [(name, fault) for fault in faults]
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
            if _changes_folder(call, rest, text):
                calls.add((call, counts[thread, call]))
        return calls


def _changes_folder(call: str, line: str, folder: str) -> bool:
    """True for a call that changes a file of the folder. Its path is in every `openat`, as that of the process."""
    if "strace.log" in line:
        return False
    if call == "openat":
        return "O_CREAT" in line and (folder in line.partition(">, ")[2] or '>, "/' not in line)
    return folder in line


def _run(folder: Path, words: tuple[str, ...], *options: str) -> int:
    command = ["strace", "-f", "-qq", "--seccomp-bpf", *options, sys.executable, "-P", "-m", "halation.cli", *words]
    environment = {**os.environ, "LP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(command, cwd=folder, capture_output=True, env=environment).returncode


def _kill(scene: str, call: str, number: int, keep: Path | None) -> tuple[str, list[str]] | None:
    """The name and the faults of a kill; None if the run came to its end, because its threads went another way."""
    with tempfile.TemporaryDirectory(prefix="hostile-kill-") as text:
        folder = Path(text)
        prepare(folder)
        inject = f"inject={call}:signal=KILL:when={number}"
        if _run(folder, SCENES[scene], "-o", "/dev/null", "-e", f"trace={call}", "-e", inject) == 0:
            return None
        name = f"kill {scene} {call} {number}"
        faults = list(find_broken(folder))
        for fault in faults:
            print(f"{name}: {fault}", flush=True)
        if faults and keep:
            shutil.copytree(folder, keep / name.replace(" ", "-"), dirs_exist_ok=True)
        return name, faults
