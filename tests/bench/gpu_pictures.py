"""What presets look like by the software rasterizer, to compare a card with. It needs no card:

    gpu_pictures.py FOLDER --precision half [--presets a,b] [--scale 0.2]

One file of numpy for each preset; those that are there already are kept.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from halation import document
from halation.compiler import Precision
from halation.presets import paths
from halation.renderer import FrameRenderer, Renderer, RenderRequest, open_pinned
from halation.resources.sandbox import UNRESTRICTED

Array = np.ndarray
PRESETS = tuple(path.stem for path in paths())


def render(renderer: Renderer, names: Sequence[str], precision: Precision, scale: float) -> Iterator[tuple[str, Array]]:
    """The first output of presets, scene-linear: of those that move, the frame in the middle."""
    graphs = {path.stem: path for path in paths()}
    for name in names:
        graph = document.load(graphs[name], sandbox=UNRESTRICTED)
        reel = FrameRenderer(renderer, graph, RenderRequest(scale=scale, precision=precision))
        try:
            yield name, reel.render_frame(sum(reel.frames) // 2)[next(iter(graph.outputs))]
        finally:
            reel.close()


def file_of(folder: Path, precision: str, name: str, scale: float) -> Path:
    """Where such a picture is kept."""
    return folder / f"{name}-{precision}-{scale:g}.npz"


def main() -> None:
    """Make what is missing."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("folder", type=Path)
    reader.add_argument("--precision", choices=("half", "float"), default="half")
    reader.add_argument("--presets", default=",".join(PRESETS))
    reader.add_argument("--scale", type=float, default=1.0)
    given = reader.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    files = {name: file_of(given.folder, given.precision, name, given.scale) for name in given.presets.split(",")}
    missing = [name for name, file in files.items() if not file.exists()]
    if not missing:
        return
    device = open_pinned(sandbox=UNRESTRICTED)
    if not device.target.software:
        raise SystemExit(
            f"{device.target.renderer} is no software rasterizer: make these pictures where there is one, and bring "
            "the folder along (--software)"
        )
    renderer = Renderer(device, sandbox=UNRESTRICTED)
    for name, array in render(renderer, missing, given.precision, given.scale):
        np.savez_compressed(files[name], image=array)
        print(name, file=sys.stderr, flush=True)
    renderer.close()


if __name__ == "__main__":
    main()
