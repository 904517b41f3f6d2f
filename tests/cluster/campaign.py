"""Renders shots again and again while a cluster is harmed at random, and compares all frames with one process.

.venv/bin/python tests/cluster/campaign.py --runs 100 --seed 1

Workers are killed (SIGKILL), the scheduler is started again, connections are closed, and one worker has a full disk.
The graph of every second run has a memory, so that its workers share results.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from farms import FULL, PYTHON, Farm, Proxy, customize, end_group, find_port, start_scheduler

FRAMES = 24
WORKERS = 3
HARMS = ("kill", "kill", "cut", "restart")
GRAPHS = {
    "free": {
        "nodes": {"c": {"type": "noise"}, "blur": {"type": "gaussian_blur"}},
        "links": {"blur.image": "c.out", "outputs.image": "blur.out"},
    },
    "memory": {
        "nodes": {"c": {"type": "noise"}, "blur": {"type": "gaussian_blur"}, "trail": {"type": "feedback"}},
        "links": {"trail.image": "c.out", "blur.image": "trail.out", "outputs.image": "blur.out"},
    },
}
SHARED = {
    "halation": 1,
    "outputs": {"image": {"type": "Image"}},
    "animation": {"blur.sigma": {"keys": [{"frame": 1, "value": 0.0}, {"frame": 24, "value": 9.0}]}},
    "settings": {"size": [320, 180], "frames": [1, FRAMES]},
}


class HarmedFarm:
    """A farm whose sender reaches the scheduler through a proxy."""

    def __init__(self, folder: Path, draw: random.Random) -> None:
        port = find_port()
        self._draw, self._port = draw, port
        self._full = customize(folder / "full", FULL)
        self.proxy = Proxy(port)
        self.address = f"tcp://127.0.0.1:{self.proxy.port}"
        self.farm = Farm(folder, f"tcp://127.0.0.1:{port}", start_scheduler(folder, port))

    def fill(self) -> None:
        """Start workers that are missing: at most one of them has a full disk."""
        for _ in range(WORKERS - len(self.farm.workers)):
            self.farm.start_worker()

    def start_full_worker(self) -> None:
        """Start a worker that cannot write."""
        self.farm.start_worker(**self._full)

    def harm(self, kind: str) -> None:
        """Do one thing that may not lose a frame."""
        if kind == "kill":
            end_group(self.farm.workers.pop(self._draw.randrange(len(self.farm.workers))))
        elif kind == "cut":
            self.proxy.cut()
        else:
            for group in (self.farm.scheduler, *self.farm.workers):
                end_group(group)
            self.farm.workers.clear()
            self.farm.scheduler = start_scheduler(self.farm.folder, self._port)
        self.fill()


def render(folder: Path, *words: str) -> subprocess.Popen[str]:
    """Start a render of all frames in a folder."""
    command = [PYTHON, "-m", "halation.cli", "render", *words, "--deterministic"]
    environment = {**os.environ, "HALATION_DEBUG": "1"}
    return subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )


def read_all(folder: Path) -> list[bytes]:
    """The bytes of all frames. A process that is killed leaves its temporary file, which a later render removes."""
    return [path.read_bytes() for path in sorted(folder.glob("f.*.exr"))]


def try_once(folder: Path, number: int, draw: random.Random) -> tuple[str, list[str]]:
    """Render on a cluster that is harmed: what is wrong, or "", and what was done."""
    name = tuple(GRAPHS)[number % len(GRAPHS)]
    output = folder / f"run{number}"
    output.mkdir()
    farm_folder = Path(tempfile.mkdtemp(prefix="farm", dir=folder))
    harmed = HarmedFarm(farm_folder, draw)
    harms: list[str] = []
    process: subprocess.Popen[str] | None = None
    try:
        if draw.random() < 0.5:
            harmed.start_full_worker()
            harms.append("full disk")
        harmed.fill()
        process = render(folder, f"{name}.json", "-o", f"run{number}/f.####.exr", "--cluster", harmed.address)
        while not any(output.iterdir()) and process.poll() is None:  # a job that has not begun is refused instead
            time.sleep(0.05)
        for _ in range(draw.randint(1, 3)):
            time.sleep(draw.uniform(0.0, 3.0))
            if process.poll() is None:
                harms.append(draw.choice(HARMS))
                harmed.harm(harms[-1])
        _, err = process.communicate(timeout=240)
    except subprocess.TimeoutExpired:
        if process is not None:
            process.kill()
        return "it does not end", harms
    finally:
        harmed.farm.stop()
        harmed.proxy.close()
    if process.returncode:
        return f"exit code {process.returncode}:\n{err}", harms
    frames = read_all(output)
    left = [path.name for path in output.iterdir() if path.name.startswith(".halation-shared-")]
    if frames != read_all(folder / name):
        return f"{len(frames)} frames, of which some differ or are missing", harms
    return f"{left} is left" if left else "", harms


def main() -> None:
    """Run as many times as the command line says."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    draw, faults, total = random.Random(options.seed), 0, Counter[str]()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for graph, document in GRAPHS.items():
            (folder / f"{graph}.json").write_text(json.dumps({**SHARED, **document}))
            (folder / graph).mkdir()
            assert render(folder, f"{graph}.json", "-o", f"{graph}/f.####.exr").wait(240) == 0
        for number in range(options.runs):
            fault, harms = try_once(folder, number, draw)
            faults += bool(fault)
            total.update(harms)
            print(f"run {number} ({', '.join(harms)}): {fault or 'all frames are those of one process'}", flush=True)
    print(f"{options.runs} runs, {faults} faults: {dict(total)}")
    raise SystemExit(bool(faults))


if __name__ == "__main__":
    main()
