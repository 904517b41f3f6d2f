"""Halation from Python: load a graph, render it to numpy arrays, save.

    import halation as hal

    graph = hal.load("bloom.json")
    pictures = hal.render(graph, {"beauty": "shot.exr"}, values={"bloom.intensity": 0.3})
    hal.write("out.png", pictures["image"])

Pictures are float arrays [height, width, channels], row 0 at the top, scene-linear, color premultiplied.
Everything raises `HalationError` (see `halation.errors`) with one sentence that says what to do, arguments of a wrong
type included; a missing argument or an unknown keyword is a TypeError, as in all of Python.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Mapping
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import HalationError, UsageError
from .version import VERSION

if TYPE_CHECKING:
    import numpy as np

    from .compiler import Precision
    from .graph import Graph
    from .inputs.provider import Binding
    from .resources.render_choices import Dither
    from .scripting.client import ServiceConnection

__all__ = ["Graph", "HalationError", "__version__", "connect", "load", "render", "render_frames", "save", "write"]

__version__ = VERSION


def load(path: str | Path) -> Graph:
    """The graph in a JSON file, or a preset by its name. Raises DocumentError with the JSON path of a fault."""
    from . import document
    from .document.locating import locate_graph
    from .resources.sandbox import read_process_sandbox
    from .scripting.arguments import check_path

    return document.load(locate_graph(check_path("path", path)), sandbox=read_process_sandbox())


def connect(socket: str | Path | None = None) -> ServiceConnection:
    """A connection to a warm process that renders: the server at this socket, or one that is started for you.

    `render`, `make_thumbnail` and `ask` of a connection send requests (docs/serve.md). Raises RenderError where no
    server listens.
    """
    from .scripting.arguments import check_path
    from .scripting.client import open_connection

    return open_connection(None if socket is None else check_path("socket", socket))


def save(graph: Graph, path: str | Path) -> None:
    """Write a graph as canonical JSON, whole or not at all. Raises OutputError."""
    from . import document
    from .resources.sandbox import read_process_sandbox
    from .scripting.arguments import check_graph, check_path

    document.save(check_graph(graph), check_path("path", path), sandbox=read_process_sandbox())


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
    default the first of the graph. Programs and results are kept from call to call. Any thread may call this: the main
    thread renders by itself, all others share one renderer.
    """
    frames = None if frame is None else (frame,)
    rendered = render_frames(
        graph, inputs, frames, values=values, node=node, size=size, scale=scale, precision=precision
    )
    with closing(rendered):
        return next(rendered)[1]


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
) -> Generator[tuple[int, dict[str, np.ndarray]]]:
    """Frames of a graph, by default all that it has, one after the other, each with its outputs as `render` has them.

    An input may also be bound to a function that makes the picture of a frame; it is called on the thread that renders.
    Whatever the order, a frame is always the same: nodes with a memory are led up to it from the first frame of the
    graph, or by its pre-roll. Arguments are checked while another thread loads the renderer.
    """
    from .scripting import arguments
    from .scripting.threads import choose_thread

    graph = arguments.check_graph(graph)
    thread = choose_thread()
    thread.prepare(graph)  # while the renderer is loaded
    from .renderer import RenderRequest
    from .resources.sandbox import read_process_sandbox
    from .scripting.rendering import ScriptedRendering

    proxy, canvas = arguments.check_scale(scale), arguments.check_size(size)
    if precision is not None:
        arguments.check_choice("precision", precision, ("half", "float"))
    for name, value in arguments.check_mapping("values", values).items():
        graph = graph.override(name, value)
    targets = arguments.check_target(graph, node)
    request = RenderRequest(arguments.check_inputs(inputs), targets, canvas, proxy, precision=precision)
    chosen = None if frames is None else arguments.check_frame_numbers(frames)
    rendering = ScriptedRendering(graph, request, thread, read_process_sandbox())
    first, last = rendering.frames
    try:
        for frame in range(first, last + 1) if chosen is None else chosen:
            yield frame, rendering.render(frame)
    finally:
        rendering.close()


def write(
    path: str | Path,
    picture: np.ndarray,
    *,
    view: str = "",
    precision: Precision = "half",
    compression: str = "zip",
    dither: Dither = "blue",
    frame: int = 1,
) -> None:
    """Write one picture, whole or not at all; the suffix says the format.

    EXR keeps the numbers; PNG, JPEG, TIFF, WebP and DPX show colors through an OpenColorIO `view`, and hold the
    numbers of a Field, which has one channel. Colors of 8 and 10 bits are dithered by blue noise, whose
    pattern `frame` chooses, unless `dither` is "none". Raises OutputError.
    """
    from halation.nodes import Kind

    from . import media
    from .color.encoding import Encoding
    from .resources.sandbox import read_process_sandbox
    from .scripting import arguments

    file = arguments.check_path("path", path)
    array = arguments.as_array(str(file), picture)
    channels = {2: 1, 3: (0, *array.shape)[-1]}.get(array.ndim, 0)
    if not 1 <= channels <= 4 or not array.size:
        raise UsageError(f"{file}: the array is {list(array.shape)}; give [height, width] or [height, width, 1 to 4]")
    kind = (Kind.FIELD, Kind.VECTOR, Kind.IMAGE, Kind.IMAGE)[channels - 1]
    media.write_picture(
        file,
        {"image": array},
        kinds={"image": kind},
        precision=arguments.check_choice("precision", precision, ("half", "float")),
        compression=arguments.check_text("compression", compression),
        encoding=Encoding(
            arguments.check_text("view", view), dither=arguments.check_choice("dither", dither, ("blue", "none"))
        ),
        frame=arguments.check_frame_number(frame),
        sandbox=read_process_sandbox(),
    )


def __getattr__(name: str) -> Any:
    # Loaded when asked for (PEP 562): every command imports this package first, and many need no graph.
    if name == "Graph":
        from .graph import Graph

        return Graph
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
