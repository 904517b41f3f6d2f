"""What the user feels of the editor, on a real X display. It prints a table; run it as

    .venv/bin/python tests/bench/editor_display.py [--cores 0,1] [--busy] [--json FILE] [PART ...]

`--cores` pins display and editor to two cores, `--busy` runs an endless loop on each of them as well. Beside each
figure stands the processor time of the editor, which a busy machine changes less. It needs Xvfb and libXtst.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from halation import document
from halation.graph import Expression, Graph, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED
from node_chains import make_chain
from pointer import MIDDLE, Pointer

SIZE = (1920, 1080)
BIG = (12_000, 8_000)
_TYPES = ("exposure", "grade", "saturation", "vignette", "clip", "gaussian_blur", "tone_map", "bloom", "edge_detect")


@dataclass
class Desk:
    """A display with an editor on it."""

    process: subprocess.Popen[str]
    pointer: Pointer
    launched: float

    def ask(self, words: str) -> Any:
        """What the editor answers to a command, when the next frame is shown."""
        assert self.process.stdin and self.process.stdout
        self.process.stdin.write(words + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        assert line, f"the editor ended before it answered '{words}'"
        return json.loads(line)

    def settle(self, seconds: float = 40.0) -> dict[str, Any]:
        """Wait until all pictures are there."""
        end = time.monotonic() + seconds
        while (state := self.ask("state"))["busy"] or not state["first_picture"]:
            assert time.monotonic() < end, "the editor was never ready"
            time.sleep(0.05)
        return state

    def find_panel(self, name: str) -> tuple[float, float, float, float]:
        """Where a panel is."""
        return tuple(self.ask("state")["places"][name])


@contextmanager
def open_desk(folder: Path, graph: Path | None, cores: str, number: int) -> Iterator[Desk]:
    """An editor on a display of its own."""
    pin = ["taskset", "-c", cores] if cores else []
    screen = subprocess.Popen(
        [*pin, "Xvfb", f":{number}", "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "-noreset"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    socket = Path(f"/tmp/.X11-unix/X{number}")
    while not socket.exists():
        time.sleep(0.02)
    time.sleep(0.3)
    pointer = Pointer(f":{number}")
    launched = time.monotonic()
    environment = {name: text for name, text in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    words = [sys.executable, str(Path(__file__).with_name("recorded_editor.py")), str(folder / "state")]
    process = subprocess.Popen(
        [*pin, *words, *([str(graph)] if graph else [])],
        env={**environment, "DISPLAY": f":{number}", "HALATION_STATE": str(folder / "state")},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    desk = Desk(process, pointer, launched)
    try:
        yield desk
        desk.ask("close")
        process.wait(30)
    finally:
        process.kill()
        process.wait()
        pointer.close()
        screen.terminate()
        screen.wait()


def measure_pan(desk: Desk, seconds: float = 4.0) -> dict[str, float]:
    """Frames per second, and the processor time of each, while the middle button drags the graph."""
    left, top, right, bottom = desk.find_panel("Graph")
    x, y, reach = (left + right) / 2, (top + bottom) / 2, min(right - left, bottom - top) / 3
    desk.pointer.move(x, y)
    time.sleep(0.3)
    desk.pointer.press(MIDDLE, True)
    desk.ask("take_frames")
    before, begun, step = desk.ask("state"), time.monotonic(), 0
    while time.monotonic() - begun < seconds:
        step += 1
        desk.pointer.move(x + reach * np.sin(step / 40), y + reach * 0.5 * np.sin(step / 25))
        time.sleep(0.008)
    frames, after = desk.ask("take_frames"), desk.ask("state")
    desk.pointer.press(MIDDLE, False)
    moved = sum(1 for last, next in pairwise(frames) if last[1:3] != next[1:3])
    spent = frames[-1][0] - frames[0][0]
    used = (after["processor"] - before["processor"]) / len(frames)
    return {"frames/s": moved / spent, "processor ms/frame": 1e3 * used}


def measure_feedback(desk: Desk, turns: int = 30) -> dict[str, float]:
    """Milliseconds from a move of the mouse over the graph until a frame that knows of it is shown."""
    left, top, right, bottom = desk.find_panel("Graph")
    delays: list[float] = []
    for turn in range(turns):
        x = round(left + (right - left) * (0.2 + 0.6 * ((turn * 7) % 13) / 13))
        y = round(top + (bottom - top) * (0.3 + 0.5 * ((turn * 5) % 11) / 11))
        desk.ask("take_frames")
        sent = desk.pointer.move(x, y)
        time.sleep(0.15 + 0.05 * (turn % 3))
        shown = [frame[0] for frame in desk.ask("take_frames") if round(frame[1]) == x and round(frame[2]) == y]
        delays += [1e3 * (shown[0] - sent)] if shown else []
    return {"median ms": statistics.median(delays), "worst ms": max(delays), "seen": len(delays)}


def measure_playback(desk: Desk, seconds: float = 6.0) -> dict[str, float]:
    """Pictures per 24 that are shown while a loop of cached frames plays at 24 frames per second."""
    desk.ask("play")
    end = time.monotonic() + 240.0
    while desk.ask("state")["cached"] < 24 and time.monotonic() < end:
        time.sleep(0.2)
    time.sleep(2.0)
    desk.ask("take_frames")
    before, begun = desk.ask("state"), time.monotonic()
    time.sleep(seconds)
    frames, after = desk.ask("take_frames"), desk.ask("state")
    spent = time.monotonic() - begun
    desk.ask("play")
    changes = sum(1 for last, next in pairwise(frames) if last[4] != next[4])
    return {
        "of 24": changes / spent,
        "cached": after["cached"],
        "processor ms/frame": 1e3 * (after["processor"] - before["processor"]) / len(frames),
        "window frames/s": len(frames) / spent,
    }


def measure_unread(desk: Desk) -> dict[str, float]:
    """Cached frames that are dropped when a node is edited that nothing reads."""
    cached = desk.ask("state")["cached"]
    desk.ask("set spare.stops 0.7")
    time.sleep(0.5)
    desk.settle()
    return {"cached": cached, "dropped": cached - desk.ask("state")["cached"]}


def measure_idle(desk: Desk, seconds: float = 10.0) -> dict[str, float]:
    """Percent of a core while nothing happens."""
    desk.pointer.move(5, 5)
    time.sleep(8.0)
    before, begun = desk.ask("state"), time.monotonic()
    time.sleep(seconds)
    used = _read_processor_time(desk.process.pid) - before["processor"]
    return {"percent": 100 * used / (time.monotonic() - begun)}


def _read_processor_time(process: int) -> float:
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure_start(desk: Desk) -> dict[str, float]:
    """Seconds from the launch to the first frame of the window, and to the first picture."""
    state, frames = desk.settle(), desk.ask("take_frames")
    return {
        "first frame s": frames[0][0] - desk.launched,
        "first picture s": state["first_picture"] - desk.launched,
        "processor s": state["processor"],
    }


# --- graphs ----------------------------------------------------------------------------------------------------------


def save_graph(folder: Path, nodes: int) -> Path:
    """A chain of nodes."""
    path = folder / f"chain{nodes}.json"
    graph = make_chain([_TYPES[n % len(_TYPES)] for n in range(nodes - 2)], (480, 270))
    document.save(graph, path, sandbox=UNRESTRICTED)
    return path


def save_animation(folder: Path, size: tuple[int, int]) -> Path:
    """A noise that moves for 24 frames, and an exposure that nothing reads."""
    types = catalogue()
    graph = Graph().add("noise", types["noise"]()).add("exposure", types["exposure"]())
    graph = graph.add("spare", types["exposure"]()).connect(Port("noise", "out"), Port("exposure", "image"))
    graph = graph.add_output("image", Output(Kind.IMAGE)).connect(Port("exposure", "out"), Port("outputs", "image"))
    graph = graph.animate(Port("exposure", "stops"), Expression("frame / 24"))
    graph = replace(graph, settings=Settings(size, frames=(1, 24)))
    path = folder / f"frames{size[1]}.json"
    document.save(graph, path, sandbox=UNRESTRICTED)
    return path


def make_picture() -> Path:
    """A large EXR of half floats, made once in the cache folder of the user."""
    import OpenImageIO as oiio

    folder = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "halation_bench"
    path = folder / f"{BIG[0]}x{BIG[1]}.exr"
    if path.exists():
        return path
    folder.mkdir(parents=True, exist_ok=True)
    spec = oiio.ImageSpec(*BIG, 4, "half")
    spec.attribute("compression", "zip")
    file, random = oiio.ImageOutput.create(str(path)), np.random.default_rng(1)
    partial = path.with_suffix(".part.exr")
    assert file is not None and file.open(str(partial), spec)
    ramp = np.linspace(0.0, 1.0, BIG[0], dtype=np.float32)[None, :, None]
    for top in range(0, BIG[1], 16):
        rows = ramp * (0.2 + top / BIG[1]) + random.random((16, BIG[0], 1), np.float32) * 0.02
        rows = np.concatenate([rows, rows * 0.8, rows * 0.5, np.ones_like(rows)], 2)
        assert file.write_scanlines(top, top + 16, 0, rows.astype(np.float16))
    file.close()
    partial.rename(path)
    return path


# --- all of it -------------------------------------------------------------------------------------------------------


class _Figures(dict[str, Any]):
    """Figures that are printed as they come."""

    def __setitem__(self, part: str, numbers: Any) -> None:
        super().__setitem__(part, numbers)
        print(part, {name: round(float(number), 2) for name, number in numbers.items()}, file=sys.stderr, flush=True)


def measure_all(folder: Path, parts: list[str], cores: str, number: int) -> dict[str, Any]:
    """The figures by part."""
    figures = _Figures()

    def is_asked(part: str) -> bool:
        return not parts or part in parts

    for nodes in (14, 300):
        if is_asked(f"graph{nodes}"):
            with open_desk(folder, save_graph(folder, nodes), cores, number) as desk:
                desk.settle()
                desk.ask("arrange")
                time.sleep(2.0)
                desk.settle()
                figures[f"pan {nodes}"] = measure_pan(desk)
                figures[f"feedback {nodes}"] = measure_feedback(desk)
                if nodes == 14:
                    figures["idle"] = measure_idle(desk)
    for size in ((480, 270), (1920, 1080)):
        if is_asked(f"play{size[1]}"):
            with open_desk(folder, save_animation(folder, size), cores, number) as desk:
                desk.settle()
                figures[f"playback {size[1]}"] = measure_playback(desk)
                figures[f"unread {size[1]}"] = measure_unread(desk)
    if is_asked("start"):
        graph, turns = save_graph(folder, 14), list[dict[str, float]]()
        for _ in range(4):
            with open_desk(folder, graph, cores, number) as desk:
                turns.append(measure_start(desk))
        figures["start"] = {name: statistics.median(turn[name] for turn in turns[1:]) for name in turns[0]}
    if is_asked("big"):
        with open_desk(folder, make_picture(), cores, number) as desk:
            desk.settle(240.0)
            figures["big"] = {**measure_start(desk), "peak MiB": desk.ask("state")["peak"]}
    return figures


@contextmanager
def load_cores(cores: str) -> Iterator[None]:
    """An endless loop on each core."""
    loops = [
        subprocess.Popen(["taskset", "-c", core, sys.executable, "-c", "while True: pass"]) for core in cores.split(",")
    ]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", help="graph14, graph300, play270, play1080, start, big")
    parser.add_argument("--cores", default="0,1")
    parser.add_argument("--busy", action="store_true")
    parser.add_argument("--display", type=int, default=46)
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    assert shutil.which("Xvfb") and shutil.which("taskset"), "Xvfb and taskset are needed"
    load = load_cores(chosen.cores) if chosen.busy else nullcontext()
    with tempfile.TemporaryDirectory() as name, load:
        figures = measure_all(Path(name), chosen.parts, chosen.cores, chosen.display)
    figures["load"] = {"average": os.getloadavg()[0]}
    print(json.dumps(figures, indent=2, default=float))
    if chosen.json:
        chosen.json.write_text(json.dumps(figures, indent=2, default=float))


if __name__ == "__main__":
    main()
