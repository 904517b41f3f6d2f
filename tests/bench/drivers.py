"""Whether other drivers make the pictures that llvmpipe makes: all nodes and presets, small, one driver after another.

    .venv/bin/python tests/bench/drivers.py                          # every driver that this machine has
    .venv/bin/python tests/bench/drivers.py "softpipe" "OpenGL 4.1" --presets soft_bloom
    .venv/bin/python tests/bench/drivers.py zink --vulkan FOLDER     # an unpacked mesa-vulkan-drivers

A process per driver draws the pictures of `gallery` at a small size, in float. Prints a table; a driver that is not
there, or draws with another name, is left out by its reason. Differences are those of scene light, of the larger of 1
and the light itself, so that 1 % of a sun counts as 1 % of white. docs/performance.md has the table.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

import numpy as np
from devices import open_renderer
from halation import document
from halation.graph import Graph
from halation.nodes import catalogue
from halation.presets import paths, sample
from halation.reference.specimen import drawable_outputs, name_specimen, show_on_sample
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

Array = np.ndarray

SCALE = 0.1
"""Of 480 x 270: softpipe, which interprets shaders, takes minutes for all of them."""

VISIBLE = 1.0 / 255.0
"""A difference that a screen of 8 bits may show."""


@dataclass(frozen=True)
class Driver:
    """A way to run OpenGL: what the environment says, and a word of the name that the driver then gives itself."""

    name: str
    word: str
    environment: dict[str, str] = field(default_factory=dict[str, str])
    form: str = ""


_NEW = {"MESA_GL_VERSION_OVERRIDE": "4.5", "MESA_GLSL_VERSION_OVERRIDE": "450"}
_SOFTWARE = {"LIBGL_ALWAYS_SOFTWARE": "1"}

DRIVERS = (
    Driver("llvmpipe", "llvmpipe", {"GALLIUM_DRIVER": "llvmpipe"}, "compute"),
    Driver("llvmpipe, fragment", "llvmpipe", {"GALLIUM_DRIVER": "llvmpipe"}, "fragment"),
    Driver("OpenGL 4.1", "llvmpipe", {"MESA_GL_VERSION_OVERRIDE": "4.1", "MESA_GLSL_VERSION_OVERRIDE": "410"}),
    Driver("OpenGL 4.3", "llvmpipe", {"MESA_GL_VERSION_OVERRIDE": "4.3", "MESA_GLSL_VERSION_OVERRIDE": "430"}),
    Driver("softpipe", "softpipe", {"GALLIUM_DRIVER": "softpipe", **_NEW}),
    Driver("zink", "zink", {"GALLIUM_DRIVER": "zink", "MESA_LOADER_DRIVER_OVERRIDE": "zink", **_SOFTWARE}),
)
"""The first is what the others are compared with. Softpipe says 3.3 and can do more; zink refuses processors unless it
is told to take them."""


@dataclass(frozen=True)
class Comparison:
    """What a driver made of all pictures: how many differ, by how much, and which does most."""

    driver: str
    device: str
    nodes: int
    presets: int
    failures: tuple[str, ...]
    differing: tuple[str, ...]
    largest: float
    where: str


def draw_pictures(names: Sequence[str]) -> Iterator[tuple[str, Array | str]]:
    """Every picture by name, `node.bloom` or `preset.soft_bloom`, or why there is none."""
    renderer = open_renderer(budget=0)
    yield "device", renderer.device.target.renderer
    for name in names:
        kind, _, id = name.partition(".")
        try:
            if kind == "node":
                with name_specimen(catalogue()[id]):
                    yield name, _draw(renderer, show_on_sample(catalogue()[id], sample()))
            else:
                path = next(path for path in paths() if path.stem == id)
                yield name, _draw(renderer, document.load(path, sandbox=UNRESTRICTED))
        except Exception as error:
            yield name, f"{type(error).__name__}: {error}"
    renderer.close()


def _draw(renderer: Renderer, graph: Graph) -> Array:
    """All outputs one below the other, of what moves at an early frame."""
    frames = FrameRenderer(renderer, graph, RenderRequest(scale=SCALE, precision="float"))
    try:
        outputs = frames.render_frame(frames.frames[min(4, len(frames.frames) - 1)])
    finally:
        frames.close()
    return np.concatenate([outputs[name].astype(np.float64).ravel() for name in sorted(outputs)])


def run_driver(driver: Driver, names: Sequence[str], folder: Path, environment: dict[str, str]) -> str:
    """Draw in a process of its own; why it failed, or nothing."""
    words = [sys.executable, __file__, "--draw", str(folder), *names]
    variables = {**os.environ, **environment, **driver.environment, "HALATION_TEST_FORM": driver.form}
    ended = subprocess.run(words, env=variables, capture_output=True, text=True)
    return "" if ended.returncode == 0 else (ended.stderr.strip().splitlines() or ["it ended"])[-1]


def measure_difference(found: Array, expected: Array) -> float:
    """The largest difference of two pictures, of the larger of 1 and the light itself; infinite where one is not."""
    finite = np.isfinite(expected)
    if found.shape != expected.shape or not np.array_equal(found[~finite], expected[~finite], equal_nan=True):
        return float("inf")
    difference = np.abs(found[finite] - expected[finite]) / np.maximum(np.abs(expected[finite]), 1.0)
    return float(difference.max(initial=0.0)) if np.isfinite(difference).all() else float("inf")


def compare(driver: str, found: dict[str, Array | str], expected: dict[str, Array | str]) -> Comparison:
    """A row of the table."""
    differences, failures = dict[str, float](), list[str]()
    for name, reference in expected.items():
        picture = found.get(name, "not drawn")
        if isinstance(picture, str) and name != "device":
            failures.append(f"{name}: {picture}")
        elif isinstance(picture, np.ndarray) and isinstance(reference, np.ndarray):
            differences[name] = measure_difference(picture, reference)
    where = max(differences, key=lambda name: differences[name], default="")
    nodes = sum(name.startswith("node.") for name in differences)
    differing = tuple(name for name, difference in differences.items() if difference > VISIBLE)
    largest = differences.get(where, 0.0)
    device = str(found.get("device", ""))
    return Comparison(driver, device, nodes, len(differences) - nodes, tuple(failures), differing, largest, where)


def format_rows(rows: Sequence[Comparison]) -> str:
    """The table in Markdown."""
    lines = ["| driver | nodes | presets | differ by more than 1/255 | largest difference |", "|---|---|---|---|---|"]
    lines += [
        f"| {row.driver} | {row.nodes} | {row.presets} | {len(row.differing)} | {row.largest:.2g} {row.where} |"
        for row in rows
    ]
    return "\n".join(lines)


def read_pictures(folder: Path) -> dict[str, Array | str]:
    """What a process drew."""
    words: dict[str, str] = json.loads((folder / "words.json").read_text("utf-8"))
    return {**words, **{file.stem: np.load(file) for file in sorted(folder.glob("*.npy"))}}


def read_options() -> argparse.Namespace:
    """The command line."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("drivers", nargs="*", help=f"by default all of {', '.join(driver.name for driver in DRIVERS)}")
    reader.add_argument("--nodes", help="ids of nodes, with commas; by default all")
    reader.add_argument("--presets", help="names of presets, with commas; by default all")
    reader.add_argument("--vulkan", type=Path, metavar="FOLDER", help="where mesa-vulkan-drivers is unpacked")
    reader.add_argument("--draw", type=Path, help=argparse.SUPPRESS)
    return reader.parse_args()


def find_vulkan(folder: Path | None) -> dict[str, str]:
    """The environment in which zink finds lavapipe."""
    if folder is None:
        return {}
    (library,) = folder.rglob("libvulkan_lvp.so")
    icd = folder / "lvp.json"
    driver = {"library_path": str(library), "api_version": "1.3.0"}
    icd.write_text(json.dumps({"file_format_version": "1.0.0", "ICD": driver}))
    libraries = os.pathsep.join(filter(None, [str(library.parent), os.environ.get("LD_LIBRARY_PATH")]))
    return {"VK_ICD_FILENAMES": str(icd), "LD_LIBRARY_PATH": libraries}


def main() -> int:
    """Draw, compare, print; 1 if a picture is missing or differs."""
    options = read_options()
    if options.draw:
        words = dict[str, str]()
        for name, picture in draw_pictures(options.drivers):
            if isinstance(picture, str):
                words[name] = picture
            else:
                np.save(options.draw / f"{name}.npy", picture)
        (options.draw / "words.json").write_text(json.dumps(words), "utf-8")
        return 0
    drawable = [id for id, node in catalogue().items() if drawable_outputs(node)]
    nodes = drawable if options.nodes is None else filter(None, options.nodes.split(","))
    presets = [path.stem for path in paths()] if options.presets is None else filter(None, options.presets.split(","))
    names = [*(f"node.{id}" for id in nodes), *(f"preset.{name}" for name in presets)]
    chosen = [driver for driver in DRIVERS[1:] if not options.drivers or driver.name in options.drivers]
    environment = find_vulkan(options.vulkan.absolute() if options.vulkan else None)
    rows: list[Comparison] = []
    expected: dict[str, Array | str] = {}
    for driver in (DRIVERS[0], *chosen):
        with tempfile.TemporaryDirectory() as folder:
            failure = run_driver(driver, names, Path(folder), environment)
            found = {} if failure else read_pictures(Path(folder))
        if driver.word not in str(found.get("device", "")):
            print(f"{driver.name}: left out ({failure or found.get('device')})", flush=True)
            continue
        expected = expected or found
        rows.append(row := compare(driver.name, found, expected))
        print(f"{row.driver}: {row.device}", *row.failures, *row.differing, sep="\n  ", flush=True)
    print(format_rows(rows))
    return int(any(row.failures or row.differing for row in rows))


if __name__ == "__main__":
    sys.exit(main())
