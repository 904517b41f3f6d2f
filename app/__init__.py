"""Halation from Python: load a graph, render it to numpy arrays, save.

    import halation.app as hal

    graph = hal.load("bloom.json")
    pictures = hal.render(graph, {"beauty": "shot.exr"}, values={"bloom.intensity": 0.3})
    hal.write("out.png", pictures["image"])

Pictures are float arrays [height, width, channels], row 0 at the top, scene-linear, color premultiplied.
Everything raises `HalationError` (see `halation.app.errors`) with one sentence that says what to do.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import HalationError

if TYPE_CHECKING:
    import numpy as np

    from .compiler import Precision
    from .graph import Graph
    from .media.pictures import Binding
    from .renderer import Renderer

__all__ = ["HalationError", "load", "render", "save", "write"]


def load(path: str | Path) -> Graph:
    """The graph in a JSON file. Raises DocumentError with the JSON path of a fault."""
    from . import document

    return document.load(path)


def save(graph: Graph, path: str | Path) -> None:
    """Write a graph as canonical JSON, whole or not at all. Raises OutputError."""
    from . import document

    document.save(graph, path)


def render(
    graph: Graph, inputs: Mapping[str, Binding] | None = None, *, values: Mapping[str, Any] | None = None,
    node: str = "", size: tuple[int, int] | None = None, scale: float = 1.0, frame: int = 1,
    precision: Precision | None = None,
) -> dict[str, np.ndarray]:
    """Every output of a graph by name, as float arrays [height, width, channels].

    `inputs` bind graph inputs to arrays, paths or `path:layer`. `values` set `node.value` or a control by name.
    `node` renders one node (`id` or `id.output`) instead. `size` replaces the size of canvas and pictures, `scale`
    renders a proxy with lengths in pixels shrunk too. Programs and results are kept from call to call.
    """
    from .graph import node_output
    from .renderer import Wanted

    for name, value in (values or {}).items():
        graph = graph.override(name, value)
    targets = {node: node_output(graph, node)} if node else {}
    return _renderer().render(graph, Wanted(inputs or {}, targets, size, scale, frame, precision))


def write(
    path: str | Path, picture: np.ndarray, *, view: str = "", precision: Precision = "half", compression: str = "zip"
) -> None:
    """Write one picture, whole or not at all; the suffix says the format.

    EXR keeps the numbers; PNG, JPEG, TIFF and WebP show them through an OpenColorIO `view`. Raises OutputError.
    """
    from ..nodes import Kind
    from . import media

    kind = {1: Kind.FIELD, 2: Kind.VECTOR, 3: Kind.IMAGE, 4: Kind.IMAGE}[1 if picture.ndim == 2 else picture.shape[2]]
    media.write(
        Path(path), {"image": picture}, kinds={"image": kind}, precision=precision, compression=compression, view=view
    )


@cache
def _renderer() -> Renderer:
    """One device for all calls: opening another costs more than most graphs."""
    from .renderer import Renderer

    return Renderer()
