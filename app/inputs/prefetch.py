"""Files are read while what will want their pixels is still being loaded, and before there is a plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import islice
from pathlib import Path, PurePath

from halation.nodes import ColorSettings, Kind

from ..errors import HalationError
from ..graph import INPUTS, OUTPUTS, Graph, Input, color_settings
from ..graph.frames import Pattern, is_video
from ..media.convert import Pixels
from ..media.info import read_info
from ..media.layers import split_layer
from ..media.pixels import read_layer
from .layer_choice import choose_layer

MOST = 4
"""Pictures that may wait for somebody to want them."""

What = tuple[str, str, Kind, int, str, ColorSettings]
"""What is read: path, layer, for what kind of socket of how many channels, from which color space, and to which."""


class Ahead:
    """Reads, one after the other, what the outputs of a graph are likely to want: plain files of its inputs.

    `inputs` are paths, or `path:layer`, by the names of inputs. A file that cannot be read is no matter here: who wants
    it will find out.
    """

    def __init__(self, graph: Graph, inputs: Mapping[str, str]) -> None:
        threads = ThreadPoolExecutor(1, thread_name_prefix="ahead")
        self._begun: dict[What, Future[Pixels]] = {
            what: threads.submit(_read, what) for what in islice(dict.fromkeys(_wanted(graph, inputs)), MOST)
        }
        threads.shutdown(wait=False)

    def take(self, what: What) -> Pixels | None:
        """What was read of it, once; None if nothing was begun. Raises what reading it raised."""
        begun = self._begun.pop(what, None)
        return begun.result() if begun else None


def _read(what: What) -> Pixels:
    path, layer, kind, width, space, color = what
    return read_layer(path, layer, kind, width, space=space, color=color)


def _wanted(graph: Graph, inputs: Mapping[str, str]) -> Iterator[What]:
    needed = graph.upstream(OUTPUTS) | {OUTPUTS}
    links = ((target, source) for target, source in graph.links.items() if source.node == INPUTS)
    linked = {source.socket for target, source in links if target.node in needed}
    replaced = {graph.inputs[name].file for name in inputs}
    for name, socket in graph.inputs.items():
        if name not in linked or socket.socket().single or (name not in inputs and socket.file in replaced):
            continue
        path, layer = _file(graph, socket, inputs.get(name))
        if path and not is_video(path) and Pattern.parse(path) is None and Path(path).is_file():
            yield path, layer, socket.kind, socket.socket().channels, socket.color_space, color_settings(graph)


def _file(graph: Graph, socket: Input, bound: str | None) -> tuple[str, str]:
    """The file of an input and the layer of it; "" without one."""
    if bound is None:
        return (str(PurePath(graph.folder, socket.file)), socket.layer) if socket.file else ("", "")
    path, layer = split_layer(bound)
    try:
        return path, layer or (choose_layer(read_info(path), socket) if Path(path).is_file() else "")
    except HalationError:
        return "", ""
