"""Measures one request to `halation serve` after the first: the figures of docs/serve.md.

.venv/bin/python tests/bench/serving.py                    # seconds
.venv/bin/python tests/bench/serving.py --against FOLDER   # and another version in turn, the package FOLDER/halation
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

GRAPH = {
    "halation": 1,
    "inputs": {"beauty": {"type": "Image"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {
        "a": {"type": "exposure", "values": {"stops": 0.3}},
        "b": {"type": "gaussian_blur", "values": {"sigma": 4}},
        "c": {"type": "vignette"},
        "d": {"type": "hue_saturation"},
        "e": {"type": "grade"},
    },
    "links": {
        "a.image": "inputs.beauty",
        "b.image": "a.out",
        "c.image": "b.out",
        "d.image": "c.out",
        "e.image": "d.out",
        "outputs.image": "e.out",
    },
}
"""Five nodes; a value changes with each request, so that nothing is found in a cache of results."""

DRIVER = """
import sys, time
import halation as hal
with hal.connect() as server:
    for number, line in enumerate(sys.stdin):
        began = time.perf_counter()
        server.render("five.json", {"beauty": "in.exr"}, values={"b.sigma": 2.0 + 0.01 * number})
        print(time.perf_counter() - began, flush=True)
"""

WARMING = 3
"""Requests that are not counted: the first ones compile programs."""


def start_driver(folder: Path, package: str) -> subprocess.Popen[str]:
    """A process that asks a server of its own, once for each line that it reads."""
    environment = {**os.environ, **({"PYTHONPATH": package} if package else {})}
    command = [sys.executable, "-c", DRIVER]
    return subprocess.Popen(
        command, cwd=folder, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )


def ask(driver: subprocess.Popen[str]) -> float:
    """The seconds of one request."""
    assert driver.stdin and driver.stdout
    driver.stdin.write("go\n")
    driver.stdin.flush()
    return float(driver.stdout.readline())


def write_inputs(folder: Path) -> None:
    """The graph, and a picture of 480x270."""
    import numpy as np
    import OpenImageIO as oiio

    (folder / "five.json").write_text(json.dumps(GRAPH))
    image = oiio.ImageBuf(oiio.ImageSpec(480, 270, 4, "half"))
    pixels = np.random.default_rng(1).random((270, 480, 4), np.float32)
    image.set_pixels(oiio.ROI(0, 480, 0, 270, 0, 1, 0, 4), pixels)
    image.write(str(folder / "in.exr"))


def main() -> None:
    """Ask both versions in turn, and print what a request took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--against", default="", metavar="FOLDER")
    parser.add_argument("--requests", type=int, default=60)
    arguments = parser.parse_args()
    packages = {
        "this version": "",
        **({"the other": str(Path(arguments.against).resolve())} if arguments.against else {}),
    }
    with tempfile.TemporaryDirectory() as name:
        write_inputs(Path(name))
        drivers = {title: start_driver(Path(name), package) for title, package in packages.items()}
        seconds: dict[str, list[float]] = {title: [] for title in drivers}
        for _ in range(WARMING + arguments.requests):
            for title, driver in drivers.items():
                seconds[title].append(ask(driver))
        for driver in drivers.values():
            driver.communicate()
    for title, measured in seconds.items():
        counted = sorted(measured[WARMING:])
        print(f"{title}: median {statistics.median(counted) * 1e3:.1f} ms, least {counted[0] * 1e3:.1f} ms")
    if arguments.against:
        ours, other = (statistics.median(measured[WARMING:]) for measured in seconds.values())
        print(f"this version takes {ours / other:.2f} of the other")


if __name__ == "__main__":
    main()
