"""Graphs to arrays: the engine's one door for the command line, the editor and Python."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import numpy as np

from .. import media
from ..compiler import Library, Picture, Plan, Precision, Probed, Request, compile_graph
from ..errors import UsageError
from ..graph import Graph, Port
from ...nodes import Kind, Size
from .device import Device, open_device
from .runner import Array, Runner

Binding = str | Path | Array
"""What fills a graph input: a path, `path:layer`, or an array [h, w] or [h, w, c]."""

DEFAULT_BUDGET = 512 * 2**20


class Renderer:
    """Renders graphs on one device, keeping programs, textures and results for the next time.

    `budget` is how many bytes of results may stay on the device.
    """

    def __init__(
        self, device: Device | None = None, *, budget: int = DEFAULT_BUDGET, library: Library | None = None,
        fusion: bool = True,
    ) -> None:
        self.device = device or open_device()
        self.runner = Runner(self.device, self._load, budget)
        self.repaired: dict[str, int] = {}
        self._library, self._fusion = library, fusion
        self._arrays: dict[str, Array] = {}
        self._stamps = 0

    def compile(
        self, graph: Graph, inputs: Mapping[str, Binding] = MappingProxyType({}), *, size: Size | None = None,
        scale: float = 1.0, frame: int = 1, targets: Mapping[str, Port] = MappingProxyType({}),
        precision: Precision | None = None,
    ) -> Plan:
        """Plan the rendering of `targets` (default: every output of the graph). See `render`."""
        for name in inputs:
            if name not in graph.inputs:
                known = ", ".join(graph.inputs) or "none"
                raise UsageError(f"the graph has no input '{name}'; its inputs are: {known}")
        self._arrays.clear()
        bindings = {name: self._bind(name, item) for name, item in inputs.items()}
        request = Request(targets, bindings, size, scale, frame)
        return compile_graph(
            graph, request, self._probe, target=self.device.target, precision=precision, library=self._library,
            fusion=self._fusion,
        )

    def render(
        self, graph: Graph, inputs: Mapping[str, Binding] = MappingProxyType({}), *, size: Size | None = None,
        scale: float = 1.0, frame: int = 1, targets: Mapping[str, Port] = MappingProxyType({}),
        precision: Precision | None = None,
    ) -> dict[str, Array]:
        """Every wanted output by name as [height, width, channels], scene-linear.

        `inputs` are bound to graph inputs by name. `size` replaces the size of canvas and pictures; `scale` renders a
        proxy. Raises the errors of `app.errors`.
        """
        return self.runner.run(
            self.compile(
                graph, inputs, size=size, scale=scale, frame=frame, targets=targets, precision=precision
            )
        )

    def close(self) -> None:
        """Give back textures and threads."""
        self.runner.close()

    # --- pictures from outside -----------------------------------------------------------------------------------------

    def _bind(self, name: str, item: Binding) -> Picture:
        """Kind and width are filled in by the graph input that it is bound to."""
        if isinstance(item, np.ndarray):
            self._arrays[name] = item
            return Picture(name, "", Kind.IMAGE, 4, in_memory=True)
        path, layer = media.split_layer(str(item))
        return Picture(path, layer, Kind.IMAGE, 4)

    def _probe(self, picture: Picture) -> Probed:
        if picture.in_memory:
            array = self._arrays[picture.path]
            self._stamps += 1
            return Probed(
                (array.shape[1], array.shape[0]), array.dtype == np.float16, f"array {picture.path} {self._stamps}"
            )
        header = media.info(picture.path)
        layer = media.find_layer(header, picture.layer)
        return Probed(header.size, layer.half, header.fingerprint)

    def _load(self, picture: Picture) -> Array:
        if picture.in_memory:
            return _as_picture(self._arrays[picture.path], picture)
        pixels = media.read(picture.path, picture.layer, picture.kind, picture.width)
        if pixels.repaired:
            self.repaired[picture.path] = pixels.repaired
        return pixels.array


def _as_picture(array: Array, picture: Picture) -> Array:
    """An array of any channel count as `picture` wants it: missing alpha is 1, other missing channels are 0."""
    if array.ndim == 2:
        array = array[..., None]
    have, want = array.shape[2], picture.width
    if have >= want:
        return array[..., :want]
    fill = np.zeros((*array.shape[:2], want - have), array.dtype)
    if picture.kind is Kind.IMAGE:
        if have == 1:
            array, fill = np.repeat(array, 3, axis=2), fill[..., :1]
        fill[..., -1] = 1.0
    return np.concatenate([array, fill], axis=2)
