"""How long the window of the editor stands still while it compiles code of users, on a real X display.

    .venv/bin/python tests/bench/shader_edits.py [--seed 1] [--count 40] [--display 47]

One editor is open all the time. The file of a node gets one shader of the hostile campaign after the other, and the
pointer moves over the graph meanwhile, so that the window has something to draw. It prints the longest time between two
frames, the most processor time that the thread of the window spent on one, and the shaders with the longest. It needs
Xvfb and libXtst.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "hostile"))

from editor_display import Desk, open_desk
from hostile.shaders import write_function

PLAIN = "vec4 tint(vec4 image) {\n    return image * 0.5;\n}\n"
SECONDS = 4.0
"""How long the editor has for each shader: it tries what compiles longer in another process, and waits for that."""

STEP = 0.008
"""Seconds between two moves of the pointer."""


def write_graph(folder: Path) -> Path:
    """A graph with a node whose code is in a file."""
    (folder / "code.glsl").write_text(PLAIN)
    nodes = {
        "noise": {"type": "noise"},
        "code": {"type": "glsl", "file": "code.glsl"},
        "light": {"type": "exposure"},
    }
    links = {"code.image": "noise.out", "light.image": "code.out", "outputs.image": "light.out"}
    graph = {"halation": 1, "settings": {"size": [1280, 720]}, "outputs": {"image": {"type": "Image"}}}
    path = folder / "graph.json"
    path.write_text(json.dumps({**graph, "nodes": nodes, "links": links}))
    return path


def wait_until_idle(desk: Desk) -> None:
    """Wait until the editor has had nothing to compute for a while."""
    idle = 0
    while idle < 20:
        idle = 0 if desk.ask("state")["busy"] else idle + 1
        time.sleep(0.2)


def measure_shader(desk: Desk, path: Path, code: str) -> dict[str, float]:
    """The longest frame while the file holds this code, in milliseconds, and the most processor time of one."""
    left, top, right, bottom = desk.find_panel("Graph")
    desk.ask("take_frames")
    part = path.with_suffix(".part")
    part.write_text(code)
    part.replace(path)
    begun, step = time.monotonic(), 0
    while time.monotonic() - begun < SECONDS:
        step += 1
        desk.pointer.move(left + (right - left) * (0.3 + 0.004 * (step % 100)), (top + bottom) / 2)
        time.sleep(STEP)
    frames = desk.ask("take_frames")
    pairs = [*pairwise(frames)]
    return {
        "frames": len(frames),
        "longest ms": max((1e3 * (after[0] - before[0]) for before, after in pairs), default=1e3 * SECONDS),
        "processor ms": max((1e3 * (after[5] - before[5]) for before, after in pairs), default=0.0),
    }


def main() -> None:
    """Measure all and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--display", type=int, default=47)
    chosen = parser.parse_args()
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        graph = write_graph(Path(name))
        with open_desk(Path(name), graph, "", chosen.display) as desk:
            wait_until_idle(desk)
            for number in range(chosen.count):
                code = write_function(Random(f"{chosen.seed}.{number}"))
                rows.append({"shader": number, **measure_shader(desk, Path(name, "code.glsl"), code)})
                rows[-1]["plain ms"] = measure_shader(desk, Path(name, "code.glsl"), PLAIN)["longest ms"]
                print(json.dumps(rows[-1]), file=sys.stderr, flush=True)
    rows.sort(key=lambda row: -row["longest ms"])
    worst = {name: max(row[name] for row in rows) for name in ("longest ms", "processor ms", "plain ms")}
    print(json.dumps({"shaders": len(rows), **worst, "load": os.getloadavg()[0], "longest": rows[:5]}, indent=1))


if __name__ == "__main__":
    main()
