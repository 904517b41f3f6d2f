"""What the peers in Python share: pictures in, a function, a picture out; or the function alone, again and again.

opencv_peer.py --list
opencv_peer.py TASK FOLDER --out FILE        the whole work of a process; of T10 FILE has {} for the frame
opencv_peer.py TASK FOLDER --repeat 5        seconds of the function with arrays in memory, as JSON
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from bench.tasks import FRAMES, SEQUENCE, TASKS, picture_path

Work = Callable[..., Any]


def read_arguments() -> tuple[str, Path, str, int, bool]:
    """Task, folder of the pictures, file to write, repeats, and whether only the tasks are to be listed."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("task", nargs="?", default="")
    reader.add_argument("folder", nargs="?", type=Path, default=Path())
    reader.add_argument("--out", default="")
    reader.add_argument("--repeat", type=int, default=5)
    reader.add_argument("--list", action="store_true")
    given = reader.parse_args()
    return given.task, given.folder, given.out, given.repeat, given.list


def time_runs(work: Callable[[], Any], repeat: int) -> list[float]:
    """Seconds of some runs, after one that does not count."""
    seconds: list[float] = []
    for _ in range(repeat + 1):
        started = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - started)
    return seconds[1:]


def print_seconds(seconds: list[float]) -> None:
    """Print the result."""
    print("\n" + json.dumps({"seconds": seconds}), flush=True)


def main(works: Mapping[str, Work], read: Work | None = None, write: Work | None = None) -> None:
    """A peer: `works` make a picture of those that a task takes; they are float arrays, unless `read` says else."""
    task, folder, out, repeat, listed = read_arguments()
    if listed:
        print(json.dumps({"tasks": list(works)}))
        return
    from bench import exr

    exr.use_all_processors()
    work, read = works[task], read or exr.read
    write = write or (lambda path, pixels: exr.write(path, pixels, half=True))
    if task == "T10":
        b = read(picture_path(folder, "b"))
        for frame in range(1, FRAMES + 1):
            write(Path(out.format(f"{frame:04d}")), work(read(folder / SEQUENCE.format(frame)), b))
        return
    given = [read(picture_path(folder, name)) for name in TASKS[task].inputs]
    if out:
        write(Path(out), work(*given))
    else:
        print_seconds(time_runs(lambda: work(*given), repeat))
