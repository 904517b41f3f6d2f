"""What becomes of a folder of shaders in the Interactive Shader Format. It prints a table, and why each failure fails.

    .venv/bin/python tests/bench/isf_collection.py FOLDER [--size 192] [--frames 2] [--sheet OUT.png]

Every `.fs` file below the folder becomes a node; its pictures are linked to test pictures, its values are the defaults.
Of Vidvox/ISF-Files (commit 3d39996, 321 files) at least 318 are to compile, and 308 to be finite and not black.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from halation.custom_nodes import Code, CodeFault, node_type
from halation.errors import HalationError
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED


def make_picture(size: int) -> np.ndarray:
    """A scene: soft colors, a bright disc, a dark bar, fine stripes."""
    y, x = np.mgrid[0:size, 0:size] / size
    light = np.stack([0.1 + 0.6 * x, 0.2 + 0.5 * y, 0.6 - 0.4 * x * y, np.ones_like(x)], axis=2)
    light[(x - 0.6) ** 2 + (y - 0.4) ** 2 < 0.03] = (1.0, 0.9, 0.5, 1.0)
    light[(x > 0.1) & (x < 0.2)] = (0.02, 0.02, 0.05, 1.0)
    light[(y > 0.8) & (np.sin(x * 100.0) > 0.0)] = (0.8, 0.8, 0.8, 1.0)
    return light.astype(np.float32)


def graph_of(path: Path, size: int, frames: int) -> Graph:
    """A graph of one shader. Raises CodeFault."""
    vertex = path.with_suffix(".vs")
    code = Code(
        "isf",
        path.read_text("utf-8", "replace"),
        str(path.resolve()),
        vertex.read_text("utf-8", "replace") if vertex.is_file() else "",
    )
    kind = node_type(code)
    graph = Graph(settings=replace(Settings(), size=(size, size), frames=(1, frames)))
    graph = graph.add("shader", kind()).add_output("out", Output(Kind.IMAGE, 4))
    graph = graph.connect(Port("shader", "out"), Port("outputs", "out"))
    pictures = [name for name, socket in kind.inputs.items() if socket.kind is Kind.IMAGE]
    for number in range(min(len(pictures), 2)):
        graph = graph.add_input(f"image{number}", Input(Kind.IMAGE, 4))
    for number, name in enumerate(pictures):
        graph = graph.connect(Port("inputs", f"image{min(number, 1)}"), Port("shader", name))
    return graph


def judge(engine: Renderer, graph: Graph, size: int, frames: int) -> tuple[str, np.ndarray | None]:
    """What the last frame is, in a word or a sentence, and its pixels."""
    light = make_picture(size)
    bindings = {name: light if number == 0 else light[::-1, ::-1].copy() for number, name in enumerate(graph.inputs)}
    frame_renderer = FrameRenderer(engine, graph, RenderRequest(bindings, precision="float"))
    pictures = [frame_renderer.render_frame(frame)["out"] for frame in range(1, frames + 1)]
    frame_renderer.close()
    if not all(np.isfinite(one).all() for one in pictures):
        return "not finite", pictures[-1]
    return ("good" if any(np.abs(one[..., :3]).max() > 1.0 / 255.0 for one in pictures) else "black"), pictures[-1]


def main() -> None:
    """Go through the folder."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("folder", type=Path)
    reader.add_argument("--size", type=int, default=192)
    reader.add_argument("--frames", type=int, default=2)
    reader.add_argument("--only", default="", help="a part of the names")
    reader.add_argument("--sheet", type=Path, help="write all pictures, side by side")
    options = reader.parse_args()
    engine, started = Renderer(sandbox=UNRESTRICTED), time.perf_counter()
    names_by_kind: dict[str, list[str]] = {}
    tiles: list[np.ndarray] = []
    paths = [path for path in sorted(options.folder.rglob("*.fs")) if options.only in path.name]
    for path in paths:
        pixels = None
        try:
            kind, pixels = judge(engine, graph_of(path, options.size, options.frames), options.size, options.frames)
            why = ""
        except CodeFault as fault:
            kind, why = "refused", str(fault)
        except HalationError as fault:
            kind, why = "failed", " ".join(str(fault).split())
        names_by_kind.setdefault(kind, []).append(f"{path.stem}: {why}" if why else path.stem)
        if pixels is not None and pixels.shape[:2] == (options.size, options.size):
            tiles.append(pixels)
        engine.runner.textures.release_idle()
    compiled = sum(len(names) for kind, names in names_by_kind.items() if kind not in ("refused", "failed"))
    print(
        f"{len(paths)} shaders, {options.size}x{options.size}, {options.frames} frames, "
        f"{time.perf_counter() - started:.0f} s on {engine.device.target.renderer}"
    )
    print(f"compiled  {compiled}")
    for kind, names in sorted(names_by_kind.items()):
        print(f"{kind:<9} {len(names)}")
        for name in names if kind != "good" else ():
            print(f"          {name}")
    if options.sheet:
        write_sheet(tiles, options.sheet)
    engine.close()


def write_sheet(tiles: list[np.ndarray], path: Path) -> None:
    """All pictures over gray, half as large, twenty to a row."""
    import halation as hal

    small = [np.nan_to_num(one[::2, ::2, :3] + 0.2 * (1.0 - one[::2, ::2, 3:])) for one in tiles]
    small += [np.zeros_like(small[0])] * (-len(small) % 20)
    hal.write(path, np.vstack([np.hstack(small[at : at + 20]) for at in range(0, len(small), 20)]))


if __name__ == "__main__":
    main()
