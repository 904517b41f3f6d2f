"""Measures `render -j auto` against fixed numbers of processes, in turn: the table of docs/performance.md.

.venv/bin/python tests/bench/sharing.py --rounds 3 --frames 24 --size 1280x720

T5, T8 and the preset `post_stack` render a sequence. Wanted: at most 1.05 of the best fixed choice.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "presets" / "samples" / "neon.exr"
CHOICES = {
    "-j 1": ("1", ""),
    "-j 1, one thread": ("1", "1"),
    "-j 2": ("2", ""),
    "-j 2, two threads": ("2", "2"),
    "-j auto": ("auto", ""),
}
"""Each with the number of processes, and of threads of the rasterizer in each; "" for as many as Halation chooses."""
TASKS = {
    "T5": ("tests/bench/graphs/T5.json", {"a": "Combined", "b": "Combined"}),
    "T8": ("tests/bench/graphs/T8.json", {"a": "Combined", "depth": "Depth"}),
    "post_stack": ("presets/post_stack.json", {"beauty": "Combined", "depth": "Depth", "normal": "Normal"}),
}
"""The graph of each, and the layers of the sample that its inputs read."""


def render(folder: Path, task: str, choice: str, frames: int, size: str) -> tuple[float, float]:
    """The seconds that a render takes, and those of processors."""
    graph, layers = TASKS[task]
    processes, threads = CHOICES[choice]
    inputs = [word for name, layer in layers.items() for word in ("-i", f"{name}=s.####.exr:{layer}")]
    words = [*inputs, "-o", "f.####.exr", "--frames", f"1-{frames}", "--size", size, "-j", processes]
    environment = {**os.environ, **({"LP_NUM_THREADS": threads} if threads else {})}
    before, began = os.times(), time.perf_counter()
    command = [sys.executable, "-m", "halation.cli", "render", str(ROOT / graph), *words]
    subprocess.run(command, cwd=folder, env=environment, stderr=subprocess.DEVNULL, check=True)
    seconds, after = time.perf_counter() - began, os.times()
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds, processor


def main() -> None:
    """Print a row for each task and choice: the least of all rounds."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--tasks", default=",".join(TASKS))
    options = parser.parse_args()
    measured: dict[tuple[str, str], list[tuple[float, float]]] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for frame in range(1, options.frames + 1):
            (folder / f"s.{frame:04d}.exr").symlink_to(SAMPLE)
        for task in options.tasks.split(","):
            render(folder, task, "-j 1", 2, options.size)  # fills the cache of programs
            for _ in range(options.rounds):
                for choice in CHOICES:
                    seconds = render(folder, task, choice, options.frames, options.size)
                    measured.setdefault((task, choice), []).append(seconds)
            print(f"{task}, {options.frames} frames of {options.size}, load {os.getloadavg()[0]:.1f}")
            for choice in CHOICES:
                pairs = measured[task, choice]
                facts = ", ".join(f"{seconds:.2f} ({used:.2f})" for seconds, used in pairs)
                print(
                    f"| {choice} | {min(pairs)[0]:.2f} | {min(used for _, used in pairs):.2f} | {facts} |", flush=True
                )


if __name__ == "__main__":
    main()
