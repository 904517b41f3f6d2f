"""Draws the pictures that drivers are compared by, each driver in processes of its own.

A folder keeps what a driver has drawn, a file per picture, so that work that was cut short goes on where it was, and a
driver that ends the process costs one picture.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).parents[1]))

import numpy as np
from devices import open_renderer
from halation import document
from halation.export.package.exact_functions import use_exact_functions
from halation.graph import Graph, Port, signature
from halation.nodes import catalogue
from halation.presets import paths, sample
from halation.reference.specimen import drawable_outputs, name_specimen, show_on_sample
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from placed_corners import place_all_corners

Array = np.ndarray
Pictures = dict[str, Array | str]

SCALE = 0.1
"""Of 480 x 270: softpipe, which interprets shaders, takes minutes for all of them."""

CORNERS = "HALATION_TEST_CORNERS"
"""The variable that says at which parts of a pixel corners of triangles are; without it they are where they are."""

ANGLES = "HALATION_TEST_EXACT_ANGLES"
"""The variable that replaces the driver's sines, cosines and arc tangents by those of exported pages."""

FRAME = 4
"""How many frames are before the one that is drawn of what moves."""


def list_pictures() -> list[str]:
    """The names of all pictures: every node that draws, every preset."""
    nodes = [f"node.{id}" for id, node in catalogue().items() if drawable_outputs(node)]
    return [*nodes, *(f"preset.{path.stem}" for path in paths())]


def list_ports(preset: str) -> list[str]:
    """The names of the pictures inside a preset: of every output of every node, `inside.turntable.key.out`."""
    graph, names = document.load(_find_preset(preset), sandbox=UNRESTRICTED), list[str]()
    for id, item in graph.nodes.items():
        outputs = signature(item).outputs
        names += [f"inside.{preset}.{id}.{name}" for name, socket in outputs.items() if not socket.kind.is_planned]
    return names


def draw_pictures(names: Sequence[str]) -> Iterator[tuple[str, Array | str]]:
    """Every picture by name, `node.bloom` or `preset.soft_bloom`, or why there is none; first the driver's name."""
    renderer = open_renderer(budget=0)
    if os.environ.get(ANGLES):
        use_exact_angles(renderer)
    yield "device", f"{renderer.device.target.renderer}, OpenGL {renderer.device.driver}"
    for name in names:
        try:
            yield name, _draw(renderer, name)
        except Exception as error:
            yield name, f"{type(error).__name__}: {error}"
    renderer.close()


def use_exact_angles(renderer: Renderer) -> None:
    """Let the programs of a renderer compute angles by themselves, as pages do that `halation export` writes."""
    device = type(renderer.device)
    create = device.create_program

    def create_exact(self: Any, fragment: str, vertex: str = "") -> Any:
        return create(self, replace_angles(fragment), replace_angles(vertex))

    device.create_program = create_exact


def replace_angles(text: str) -> str:
    """A program with functions for angles after its version and extensions."""
    changed, functions = use_exact_functions(text)
    lines = changed.splitlines(keepends=True)
    heads = [number for number, line in enumerate(lines) if line.startswith(("#version", "#extension"))]
    first = max(heads, default=-1) + 1
    return "".join([*lines[:first], functions, *lines[first:]])


def _draw(renderer: Renderer, name: str) -> Array:
    """A picture by name."""
    kind, _, id = name.partition(".")
    if kind == "node":
        node = catalogue()[id]
        with name_specimen(node):
            return _draw_graph(renderer, show_on_sample(node, sample()))
    preset, _, port = id.partition(".")
    targets = {port: Port.parse(port)} if port else {}
    return _draw_graph(renderer, document.load(_find_preset(preset), sandbox=UNRESTRICTED), targets)


def _find_preset(name: str) -> Path:
    """The file of a preset."""
    return next(path for path in paths() if path.stem == name)


def _draw_graph(renderer: Renderer, graph: Graph, targets: Mapping[str, Port] | None = None) -> Array:
    """All outputs one below the other, of what moves at an early frame."""
    request = RenderRequest(scale=SCALE, precision="float", targets=targets or {})
    frames = FrameRenderer(renderer, graph, request)
    try:
        outputs = frames.render_frame(frames.frames[min(FRAME, len(frames.frames) - 1)])
    finally:
        frames.close()
    return np.concatenate([outputs[name].astype(np.float64).ravel() for name in sorted(outputs)])


def draw_in_processes(names: Sequence[str], folder: Path, variables: Mapping[str, str]) -> Pictures:
    """What a driver draws, where the environment has these variables; `folder` keeps it.


    Where the driver cannot be opened, the result has no `device`, and says why under `failure`.
    """
    while left := [name for name in ("device", *names) if name not in (found := read_pictures(folder))]:
        (folder / "drawing").unlink(missing_ok=True)
        words = [sys.executable, __file__, str(folder), *(name for name in left if name != "device")]
        ended = subprocess.run(words, env={**os.environ, **variables}, capture_output=True, text=True)
        if ended.returncode == 0:
            continue
        reason = (ended.stderr.strip().splitlines() or [f"it ended with {ended.returncode}"])[-1]
        if not (folder / "drawing").is_file():
            # Where all is drawn, the driver ended the process after its last picture.
            found = read_pictures(folder)
            return found if {"device", *names} <= set(found) else {**found, "failure": reason}
        _keep(folder, (folder / "drawing").read_text("utf-8"), f"the process ended: {reason}")
    return read_pictures(folder)


def read_pictures(folder: Path) -> Pictures:
    """What was drawn into a folder."""
    words = folder / "words.jsonl"
    lines = words.read_text("utf-8").splitlines() if words.is_file() else []
    texts = dict[str, str](json.loads(line) for line in lines)
    return {**texts, **{file.stem: np.load(file) for file in sorted(folder.glob("*.npy"))}}


def _keep(folder: Path, name: str, picture: Array | str) -> None:
    """Keep a picture, or why there is none."""
    if isinstance(picture, str):
        with (folder / "words.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps((name, picture)) + "\n")
        return
    unfinished = folder / f"{name}.part"
    with unfinished.open("wb") as file:
        np.save(file, picture)
    unfinished.replace(folder / f"{name}.npy")


def main(folder: Path, names: Sequence[str]) -> None:
    """Draw what is named, and say before each picture which it is."""
    coming = iter(names)
    parts = int(os.environ.get(CORNERS) or 0)
    with place_all_corners(parts) if parts else nullcontext():
        for name, picture in draw_pictures(names):
            _keep(folder, name, picture)
            if following := next(coming, ""):
                (folder / "drawing").write_text(following, "utf-8")
    (folder / "drawing").unlink(missing_ok=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
