"""Measures `render --each` against single calls and a loop over `hal.render`: the figures of docs/batch.md.

.venv/bin/python tests/bench/batch.py                             # 200 photos of 2 MP, minutes
.venv/bin/python tests/bench/batch.py --single 200                # with as many single calls, an hour on two cores
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HALATION = (sys.executable, "-m", "halation.cli")
SIZE = (1632, 1224)
"""2 MP."""

SEED = 22
LOOK = {
    "halation": 1,
    "inputs": {"beauty": {"type": "Image"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {
        "light": {"type": "exposure", "values": {"stops": 0.3}},
        "glow": {"type": "gaussian_blur", "values": {"sigma": 3.0}},
        "edge": {"type": "vignette"},
    },
    "links": {
        "light.image": "inputs.beauty",
        "glow.image": "light.out",
        "edge.image": "glow.out",
        "outputs.image": "edge.out",
    },
}

LOOP = """
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
import halation as hal
import numpy as np
import OpenImageIO as oiio

def read(path):
    codes = oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)
    light = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    return np.dstack([light, np.ones(light.shape[:2], np.float32)]).astype(np.float32)

graph, photos = hal.load("look.json"), sorted(Path("photos").iterdir())
Path("loop").mkdir(exist_ok=True)
with ThreadPoolExecutor(1) as reader, ThreadPoolExecutor(min(4, len(photos))) as writers:
    coming, written = reader.submit(read, photos[0]), []
    for place, path in enumerate(photos):
        picture = coming.result()
        if place + 1 < len(photos):
            coming = reader.submit(read, photos[place + 1])
        image = hal.render(graph, {"beauty": picture})["image"]
        written.append(writers.submit(hal.write, f"loop/{path.stem}.png", image))
        if len(written) > 5:
            written.pop(0).result()
    for rest in written:
        rest.result()
"""
"""What somebody would write by hand: the next photo is read and those before are written on other threads."""


def write_photos(folder: Path, count: int) -> None:
    """JPEGs of smooth colors with the noise of a camera, by a seed."""
    import numpy as np
    import OpenImageIO as oiio

    (folder / "look.json").write_text(json.dumps(LOOK))
    (folder / "photos").mkdir()
    generator = np.random.default_rng(SEED)
    width, height = SIZE
    x, y = np.meshgrid(np.linspace(0, 1, width), np.linspace(0, 1, height))
    for number in range(count):
        hues = generator.random((3, 3))
        light = np.stack([a * x + b * y + c * np.sin(9 * x * y) for a, b, c in hues], -1) / 2
        codes = np.clip(light + generator.normal(0, 0.02, light.shape), 0, 1).astype(np.float32)
        image = oiio.ImageBuf(oiio.ImageSpec(width, height, 3, "uint8"))
        image.set_pixels(oiio.ROI(0, width, 0, height, 0, 1, 0, 3), codes)
        image.write(str(folder / "photos" / f"p{number:03}.jpg"))


def run(folder: Path, *words: str) -> tuple[float, int]:
    """The seconds of a command, and the bytes that it takes at most."""
    began = time.perf_counter()
    with subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, words)
    return time.perf_counter() - began, usage.ru_maxrss << 10


def render_each(folder: Path, pattern: str) -> tuple[float, int]:
    """One command for all photos of a pattern; its seconds and bytes."""
    return run(folder, *HALATION, "render", "look.json", "--each", pattern, "-o", "each/{stem}.png")


def render_singly(folder: Path, photos: list[Path]) -> float:
    """One command for each photo."""
    (folder / "single").mkdir(exist_ok=True)
    files = [(str(photo), f"single/{photo.stem}.png") for photo in photos]
    return sum(
        run(folder, *HALATION, "render", "look.json", "-i", f"beauty={photo}", "-o", name)[0] for photo, name in files
    )


def measure(folder: Path, count: int, single: int, rounds: int) -> None:
    """Measure each way once in each round, and print medians and their ratios."""
    photos = sorted((folder / "photos").iterdir())
    seconds: dict[str, list[float]] = {"--each": [], "a loop": [], "single calls": []}
    peaks: list[int] = []
    for _ in range(rounds):
        whole, peak = render_each(folder, "photos/*.jpg")
        peaks.append(peak)
        seconds["--each"].append(whole)
        seconds["a loop"].append(run(folder, sys.executable, "-c", LOOP)[0])
        seconds["single calls"].append(render_singly(folder, photos[:single]) * count / single)
    medians = {way: statistics.median(measured) for way, measured in seconds.items()}
    for way, median in medians.items():
        print(f"{way}: {median:.2f} s for {count} photos  {[round(one, 2) for one in seconds[way]]}")
    print(f"single calls: {single} were measured")
    print(f"--each takes {medians['--each'] / medians['single calls']:.2f} of single calls (wanted: at most 0.35)")
    print(f"--each takes {medians['--each'] / medians['a loop']:.2f} of a loop (wanted: at most 1.15)")
    few = render_each(folder, "photos/p??0.jpg")[1]
    print(f"memory: {few / 1e6:.0f} MB at most for {(count + 9) // 10} photos, {max(peaks) / 1e6:.0f} MB for {count}")


def main() -> None:
    """Measure with the arguments of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--photos", type=int, default=200)
    parser.add_argument("--single", type=int, default=20, help="how many single calls stand for all")
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        write_photos(Path(name), arguments.photos)
        measure(Path(name), arguments.photos, min(arguments.single, arguments.photos), arguments.rounds)


if __name__ == "__main__":
    main()
