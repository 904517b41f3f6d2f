"""A task by Halation's engine in memory: arrays in, arrays out. It prints JSON.

    engine.py TASK FOLDER [--repeat 5] [--unfused] [--set NODE.VALUE=NUMBER]

`seconds` are those of uploading the pictures, all passes and reading the result back, again and again; `first` is the
first time, with the compilation of shaders, `plan` how long the graph takes to a plan.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
from halation.resources.sandbox import UNRESTRICTED

sys.path.append(str(Path(__file__).parents[1]))

from bench.exr import read
from bench.tasks import TASKS, picture_path
from halation import document
from halation.renderer import Renderer, RenderRequest


def main() -> None:
    """Measure one task."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("task", choices=TASKS)
    reader.add_argument("folder", type=Path)
    reader.add_argument("--repeat", type=int, default=5)
    reader.add_argument("--unfused", action="store_true")
    reader.add_argument("--set", action="append", default=[])
    options = reader.parse_args()
    task = TASKS[options.task]
    given = {name: read(picture_path(options.folder, name), half=name in "ab") for name in task.inputs}
    width = next(iter(given.values())).shape[1]
    graph = document.load(task.path, sandbox=UNRESTRICTED)
    for name, value in task.values(width).items():
        graph = graph.override(name, value)
    for item in options.set:
        name, _, number = item.partition("=")
        graph = graph.override(name, float(number))
    engine = Renderer(budget=0, fusion=not options.unfused, sandbox=UNRESTRICTED)
    started = time.perf_counter()
    plan = engine.compile(graph, RenderRequest(given))
    planned = time.perf_counter()
    engine.runner.run(plan)
    first, seconds = time.perf_counter() - planned, []
    pixels = np.empty(0)
    for _ in range(options.repeat + 1):
        before = time.perf_counter()
        pixels = engine.runner.run(plan)["out"]
        seconds.append(time.perf_counter() - before)
    print(
        json.dumps(
            {
                "seconds": seconds[1:],
                "first": first,
                "plan": planned - started,
                "passes": len(plan.passes),
                "device": engine.device.description,
                "finite": bool(np.isfinite(pixels).all()),
            }
        )
    )
    engine.close()


if __name__ == "__main__":
    main()
