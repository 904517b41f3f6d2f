"""How far the pages of `halation export --to web` are from our own pictures: presets in Chromium, one after another.

    .venv/bin/python tests/bench/pages.py out/pages                       # all presets at their own settings
    .venv/bin/python tests/bench/pages.py out/pages --all-settings        # at two others of each control too
    .venv/bin/python tests/bench/pages.py out/pages --all-settings --driver mesa --part 1/2     # in two processes
    .venv/bin/python tests/bench/pages.py out/pages --table               # what was measured so far

SwiftShader takes twenty times as long as Mesa's driver, which also draws our own pictures: that one tells whether
controls do what they should, and SwiftShader whether another device agrees.

Each figure is written at once to `figures.jsonl` in the folder, and what is there is not measured again: it may be
stopped at any time. Pages are kept in the folder. docs/export-web.md has the figures.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).parents[1]))

from browser import DRIVERS, Browser
from halation.cli.program import run
from halation.presets import paths
from shown_pages import SIZE, compare, list_settings, place_corners_like, show, take

USUAL = "as it is"
"""The name of the setting that the preset has."""
WHOLE = "all"
"""What is noted of a preset as soon as all its settings are measured."""
LIMIT_CODES, LIMIT_FLIP = 2.01, 0.01
"""Codes of 255 at the 99.9th percentile, and the mean of FLIP, within which a page is right."""

Figure = dict[str, Any]


def measure_preset(preset: str, folder: Path, driver: str, *, all_settings: bool) -> None:
    """Append the figures of a preset that are missing."""
    own = [figure for figure in read_figures(folder) if figure["preset"] == preset]
    done = {figure["setting"] for figure in own if figure.get("driver", driver) == driver}
    if {"refused", WHOLE} & done or (USUAL in done and not all_settings):
        return
    page = folder / f"{preset}.html"
    if not page.exists() and run(["export", preset, "-o", str(page), "--size", SIZE]):
        write_figure(folder, {"preset": preset, "setting": "refused"})
        return
    with Browser(driver=driver) as browser, tempfile.TemporaryDirectory() as work:
        picture = Path(work) / "ours.png"
        show(browser, page)
        for options, knobs in list_settings(browser.run("halation.package.controls")):
            setting = options[-1] if options else USUAL
            if setting in done:
                continue
            with place_corners_like(browser):
                assert run(["render", preset, "-o", str(picture), "--size", SIZE, "--dither", "none", *options]) == 0
            codes, flip = compare(picture, take(browser, Path(work), knobs))
            figure = {"preset": preset, "driver": driver, "setting": setting}
            figure |= {"codes": round(codes, 2), "flip": round(flip, 5), "messages": browser.messages}
            write_figure(folder, figure)
            if not all_settings:
                return
    write_figure(folder, {"preset": preset, "driver": driver, "setting": WHOLE})


def write_figure(folder: Path, figure: Figure) -> None:
    """Append one figure, and print it."""
    with (folder / "figures.jsonl").open("a", encoding="utf-8") as file:
        file.write(json.dumps(figure) + "\n")
    print(figure, flush=True)


def read_figures(folder: Path) -> list[Figure]:
    """All figures so far."""
    file = folder / "figures.jsonl"
    return [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.exists() else []


def write_table(figures: Sequence[Figure]) -> str:
    """One row for each preset: its worst figures, and the settings that are over the limits."""
    rows = ["| preset | settings | codes | FLIP | over |", "|---|---|---|---|---|"]
    for preset in sorted({figure["preset"] for figure in figures}):
        own = [figure for figure in figures if figure["preset"] == preset and "codes" in figure]
        if not own:
            rows.append(f"| {preset} | refused | | | |")
            continue
        over = [
            figure["setting"]
            for figure in own
            if figure["codes"] > LIMIT_CODES or figure["flip"] > LIMIT_FLIP or figure["messages"]
        ]
        worst = max(figure["codes"] for figure in own), max(figure["flip"] for figure in own)
        rows.append(f"| {preset} | {len(own)} | {worst[0]:.1f} | {worst[1]:.4f} | {', '.join(over)} |")
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description="How far exported pages are from our own pictures.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("presets", nargs="*")
    parser.add_argument("--all-settings", action="store_true")
    parser.add_argument("--driver", choices=tuple(DRIVERS), default="swiftshader")
    parser.add_argument("--part", default="1/1", help="which of how many parts of the presets")
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    if options.table:
        print(write_table(read_figures(options.folder)))
        return
    part, parts = map(int, options.part.split("/"))
    for preset in options.presets or [path.stem for path in paths()][part - 1 :: parts]:
        measure_preset(preset, options.folder, options.driver, all_settings=options.all_settings)


if __name__ == "__main__":
    main()
