"""How long a visitor waits for the picture of a page that `halation export --to web` wrote, in a Chromium.

    .venv/bin/python tests/bench/first_picture.py                        # three looks with ten passes, SwiftShader
    .venv/bin/python tests/bench/first_picture.py soft_bloom --size 1920x1080 --driver mesa --rounds 9

Each round starts a browser with an empty profile, waits until it is idle, and opens the page. Times are from the
start of navigation, medians of all rounds. A page of a large picture shows a draft first; `first` is when the device
has drawn it and the screen has had two frames with it, `whole` when the device has drawn the picture in full. Other
programs on the same processor count: the load at the start and at the end is printed.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from browser import DRIVERS, Browser
from halation.cli.program import run

PRESETS = ("glitch_art", "pencil_sketch", "emboss_and_edges")
"""Looks with ten passes, and one with eleven."""
IDLE_SECONDS = 2.0
"""A browser that has just started is still starting its other processes."""
WATCH = """
    const times = window.times = {};
    const look = () => {
        const page = window.halation;
        if (page && page.firstPictureAt) {
            const isSeen = page.package.draft ? !page.fence && !(page.framesToWait > 0) : !page.isDirty;
            if (isSeen) times.first ??= performance.now();
            if (!page.isDirty) {
                page.gl.bindFramebuffer(page.gl.FRAMEBUFFER, null);
                page.gl.readPixels(0, 0, 1, 1, page.gl.RGBA, page.gl.UNSIGNED_BYTE, new Uint8Array(4));
                times.whole = performance.now();
                if (!page.package.draft) times.first = times.whole;
                return;
            }
        }
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
"""
"""Runs in the page before its own script. To read a pixel waits until the device has drawn it."""


def measure_page(page: Path, driver: str) -> dict[str, float]:
    """Seconds from navigation to the first picture and to the whole one."""
    with Browser(driver=driver) as browser:
        time.sleep(IDLE_SECONDS)
        browser.prepare(WATCH)
        browser.open(page)
        browser.wait_until("window.times.whole")
        assert not browser.messages, browser.messages
        return {name: milliseconds / 1000.0 for name, milliseconds in browser.run("times").items()}


def main() -> None:
    parser = argparse.ArgumentParser(description="How long a visitor waits for the picture of an exported page.")
    parser.add_argument("presets", nargs="*", default=PRESETS)
    parser.add_argument("--size", default="960x540")
    parser.add_argument("--driver", choices=tuple(DRIVERS), default="swiftshader")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as folder:
        for preset in options.presets:
            page = Path(folder) / f"{preset}.html"
            assert run(["export", preset, "-o", str(page), "--size", options.size]) == 0
            rounds = [measure_page(page, options.driver) for _ in range(options.rounds)]
            for name in ("first", "whole"):
                seconds = sorted(times[name] for times in rounds)
                listed = " ".join(f"{each:.2f}" for each in seconds)
                print(f"{preset} {name}: {statistics.median(seconds):.2f} s ({listed})", flush=True)
    print(f"load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
