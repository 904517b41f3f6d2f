"""Halation from Python: load a graph, render it to numpy arrays, save.

    import halation as hal

    graph = hal.load("bloom.json")
    pictures = hal.render(graph, {"beauty": "shot.exr"}, values={"bloom.intensity": 0.3})
    hal.write("out.png", pictures["image"])

Pictures are float arrays [height, width, channels], row 0 at the top, scene-linear, color premultiplied.
Everything raises `HalationError` (see `halation.errors`) with one sentence that says what to do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import HalationError, UsageError
from .version import VERSION

if TYPE_CHECKING:
    import numpy as np

    from .compiler import Precision
    from .graph import Graph, Port
    from .inputs.provider import Binding
    from .renderer import Renderer
    from .renderer.execution.trials import TrialProcess
    from .resources.sandbox import Sandbox

__all__ = ["Graph", "HalationError", "__version__", "load", "render", "render_frames", "save", "write"]

__version__ = VERSION


def load(path: str | Path) -> Graph:
    """The graph in a JSON file, or a preset by its name. Raises DocumentError with the JSON path of a fault."""
    from . import document
    from .custom_nodes.plugins import find_graph_or_preset
    from .resources.sandbox import read_process_sandbox

    return document.load(find_graph_or_preset(path), sandbox=read_process_sandbox())


def save(graph: Graph, path: str | Path) -> None:
    """Write a graph as canonical JSON, whole or not at all. Raises OutputError."""
    from . import document
    from .resources.sandbox import read_process_sandbox

    document.save(graph, path, sandbox=read_process_sandbox())


def render(
    graph: Graph,
    inputs: Mapping[str, Binding] | None = None,
    *,
    values: Mapping[str, Any] | None = None,
    node: str = "",
    size: tuple[int, int] | None = None,
    scale: float = 1.0,
    frame: int | None = None,
    precision: Precision | None = None,
) -> dict[str, np.ndarray]:
    """Every output of a graph by name, as float arrays [height, width, channels].

    `inputs` bind graph inputs to arrays, paths or `path:layer`; the name of a sequence has `####` for the frame.
    `values` set `node.value` or a control by name. `node` renders one node (`id` or `id.output`) instead. `size`
    replaces the size of canvas and pictures, `scale` renders a proxy with lengths in pixels shrunk too. `frame` is by
    default the first of the graph. Programs and results are kept from call to call.
    """
    frames = None if frame is None else (frame,)
    made = render_frames(graph, inputs, frames, values=values, node=node, size=size, scale=scale, precision=precision)
    return next(iter(made))[1]


def render_frames(
    graph: Graph,
    inputs: Mapping[str, Binding | Callable[[int], Binding]] | None = None,
    frames: Iterable[int] | None = None,
    *,
    values: Mapping[str, Any] | None = None,
    node: str = "",
    size: tuple[int, int] | None = None,
    scale: float = 1.0,
    precision: Precision | None = None,
) -> Iterator[tuple[int, dict[str, np.ndarray]]]:
    """Frames of a graph, by default all that it has, one after the other, each with its outputs as `render` has them.

    An input may also be bound to a function that makes the picture of a frame. Whatever the order, a frame is always
    the same: nodes with a memory are led up to it from the first frame of the graph, or by its pre-roll.
    """
    from .graph.custom_code import has_code

    if has_code(graph):
        _trial_process().start()  # while the renderer is loaded
    from .renderer import FrameRenderer, RenderRequest
    from .resources.sandbox import read_process_sandbox

    if not 0.0 < scale <= 1.0:
        raise UsageError(f"scale {scale:g}: give a number above 0 and up to 1")
    if size is not None and min(size) < 1:
        raise UsageError(f"size {size[0]}x{size[1]}: give width and height in pixels, at least 1")
    for name, value in (values or {}).items():
        graph = graph.override(name, value)
    targets = {node: _output(graph, node)} if node else {}
    reel = FrameRenderer(
        _renderer(read_process_sandbox()), graph, RenderRequest(inputs or {}, targets, size, scale, precision=precision)
    )
    first, last = reel.frames
    try:
        for frame in range(first, last + 1) if frames is None else frames:
            yield frame, reel.render_frame(frame)
    finally:
        reel.close()


def write(
    path: str | Path, picture: np.ndarray, *, view: str = "", precision: Precision = "half", compression: str = "zip"
) -> None:
    """Write one picture, whole or not at all; the suffix says the format.

    EXR keeps the numbers; PNG, JPEG, TIFF and WebP show them through an OpenColorIO `view`. Raises OutputError.
    """
    from halation.nodes import Kind

    from . import media
    from .resources.sandbox import read_process_sandbox

    channels = {2: 1, 3: picture.shape[-1]}.get(picture.ndim, 0)
    if not 1 <= channels <= 4:
        raise UsageError(f"{path}: the array is {list(picture.shape)}; give [height, width] or [height, width, 1 to 4]")
    kind = (Kind.FIELD, Kind.VECTOR, Kind.IMAGE, Kind.IMAGE)[channels - 1]
    media.write_picture(
        Path(path),
        {"image": picture},
        kinds={"image": kind},
        precision=precision,
        compression=compression,
        view=view,
        sandbox=read_process_sandbox(),
    )


def _output(of: Graph, node: str) -> Port:
    from .graph import find_node_output

    return find_node_output(of, node)


@cache
def _renderer(sandbox: Sandbox) -> Renderer:
    """One device for all calls: opening another costs more than most graphs."""
    from .renderer import Renderer

    return Renderer(sandbox=sandbox, trial_process=_trial_process())


@cache
def _trial_process() -> TrialProcess:
    """The process in which programs with code of users are tried."""
    from .renderer.execution.trials import TrialProcess

    return TrialProcess()


def __getattr__(name: str) -> Any:
    # Loaded when asked for (PEP 562): every command imports this package first, and many need no graph.
    if name == "Graph":
        from .graph import Graph

        return Graph
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
