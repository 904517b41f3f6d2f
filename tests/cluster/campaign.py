"""Renders a shot again and again while workers are killed at random, and compares all frames with one process.

.venv/bin/python tests/cluster/campaign.py --runs 100 --seed 1
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from farms import PYTHON, Farm, end_group, find_port, start_scheduler

FRAMES = 24
GRAPH = {
    "halation": 1,
    "nodes": {"c": {"type": "noise"}, "blur": {"type": "gaussian_blur"}},
    "outputs": {"image": {"type": "Image"}},
    "links": {"blur.image": "c.out", "outputs.image": "blur.out"},
    "animation": {"blur.sigma": {"keys": [{"frame": 1, "value": 0.0}, {"frame": 24, "value": 9.0}]}},
    "settings": {"size": [320, 180]},
}


def render(folder: Path, *words: str) -> subprocess.Popen[bytes]:
    """Start a render of all frames into a folder below."""
    command = [PYTHON, "-m", "halation.cli", "render", "shot.json", "--frames", f"1-{FRAMES}", "--deterministic"]
    return subprocess.Popen([*command, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def read_all(folder: Path) -> list[bytes]:
    """The bytes of all frames. A process that is killed leaves its temporary file, which a later render removes."""
    return [path.read_bytes() for path in sorted(folder.glob("f.*.exr"))]


def try_once(folder: Path, farm: Farm, expected: list[bytes], number: int, draw: random.Random) -> str:
    """Render while workers are killed; what is wrong, or ""."""
    output = folder / f"run{number}"
    output.mkdir()
    process = render(folder, "-o", f"run{number}/f.####.exr", "--cluster", farm.address)
    for _ in range(draw.randint(1, 3)):
        time.sleep(draw.uniform(0.2, 2.0))
        place = draw.randrange(len(farm.workers))
        end_group(farm.workers.pop(place))
        farm.start_worker()
    code = process.wait(240)
    return "" if code == 0 and read_all(output) == expected else f"exit code {code}, {len(read_all(output))} files"


def main() -> None:
    """Run as many times as the command line says."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    draw, faults = random.Random(options.seed), 0
    with tempfile.TemporaryDirectory() as name:
        folder, port = Path(name), find_port()
        (folder / "shot.json").write_text(json.dumps(GRAPH))
        (folder / "one").mkdir()
        assert render(folder, "-o", "one/f.####.exr").wait(240) == 0
        farm = Farm(folder, f"tcp://127.0.0.1:{port}", start_scheduler(folder, port))
        try:
            for _ in range(3):
                farm.start_worker()
            for number in range(options.runs):
                fault = try_once(folder, farm, read_all(folder / "one"), number, draw)
                faults += bool(fault)
                print(f"run {number}: {fault or 'all frames are those of one process'}", flush=True)
        finally:
            farm.stop()
    print(f"{options.runs} runs, {faults} faults")
    raise SystemExit(bool(faults))


if __name__ == "__main__":
    main()
