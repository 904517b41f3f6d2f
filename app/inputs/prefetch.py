"""Reads files while the libraries for rendering are still being loaded, before there is a plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import islice
from pathlib import Path, PurePath

from ..color.management import get_color_manager
from ..errors import HalationError
from ..graph import INPUTS, OUTPUTS, Graph, Input, color_settings
from ..graph.frames import Pattern, is_video
from ..media.convert import LayerRequest, Pixels
from ..media.info import read_info
from ..media.layers import split_layer
from ..media.pixels import read_layers
from ..resources.sandbox import Sandbox
from .layer_choice import choose_layer

MAX_WAITING = 4
"""Pictures that may wait in memory. Chosen by judgement: a render has a few large ones, and more would not be decoded
before the graph is compiled."""

PixelRequest = tuple[str, LayerRequest]
"""A path, and the layer to read."""


class Prefetcher:
    """Reads the files of inputs that the outputs of a graph are likely to need, one after the other.

    `inputs` are paths, or `path:layer`, by the names of inputs. A file that cannot be read is not an error here: the
    error is raised when its pixels are requested.
    """

    def __init__(self, graph: Graph, inputs: Mapping[str, str], sandbox: Sandbox) -> None:
        threads = ThreadPoolExecutor(1, thread_name_prefix="ahead")
        self._pending: dict[PixelRequest, Future[Pixels]] = {
            request: threads.submit(_read, *request, sandbox)
            for request in islice(dict.fromkeys(_predict_requests(graph, inputs, sandbox)), MAX_WAITING)
        }
        threads.shutdown(wait=False)

    def take(self, request: PixelRequest) -> Pixels | None:
        """The pixels of a request, once; None if it is not being read. Raises the error of reading it."""
        pending = self._pending.pop(request, None)
        return pending.result() if pending else None


def _read(path: str, request: LayerRequest, sandbox: Sandbox) -> Pixels:
    return read_layers(path, [request], sandbox=sandbox)[0]


def _predict_requests(graph: Graph, inputs: Mapping[str, str], sandbox: Sandbox) -> Iterator[PixelRequest]:
    """The requests that rendering will make, if they are certain before the graph is compiled.

    Sequences and videos are left out, as their frame is not known yet, and so are inputs whose file follows another
    input to a new file: which layer that has is decided by binding.
    """
    needed = graph.upstream(OUTPUTS) | {OUTPUTS}
    links = ((target, source) for target, source in graph.links.items() if source.node == INPUTS)
    linked = {source.socket for target, source in links if target.node in needed}
    replaced = {graph.inputs[name].file for name in inputs}
    manager = get_color_manager(color_settings(graph), sandbox)
    for name, socket in graph.inputs.items():
        if name not in linked or socket.kind.is_single or (name not in inputs and socket.file in replaced):
            continue
        path, layer = _find_file(graph, socket, inputs.get(name), sandbox=sandbox)
        if path and not is_video(path) and Pattern.parse(path) is None and Path(path).is_file():
            extends = graph.settings.overscan > 0.0
            yield path, LayerRequest(layer, socket.kind, socket.width, socket.color_space, manager, extends)


def _find_file(graph: Graph, socket: Input, bound: str | None, sandbox: Sandbox) -> tuple[str, str]:
    """The file of an input and the layer of it; "" without one."""
    if bound is None:
        return (str(PurePath(graph.folder, socket.file)), socket.layer) if socket.file else ("", "")
    path, layer = split_layer(bound)
    try:
        return path, layer or (
            choose_layer(read_info(path, sandbox=sandbox), socket, sandbox) if Path(path).is_file() else ""
        )
    except HalationError:
        return "", ""
