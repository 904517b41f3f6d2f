"""An output of a graph, and a reference file, as light that can be compared: linear Rec.709 over black.

A file for people (PNG, JPEG) shows a picture through a view, and a graph is compared with it as `halation render` would
write it to such a file. A file of light (EXR, HDR) is compared as light.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from halation.nodes import Kind, Socket
from msgspec import structs

from ..color.encoding import Encoding
from ..color.management import LINEAR_REC709, get_color_manager
from ..color.transforms import decode_srgb, to_three_channels
from ..errors import InputError, UsageError
from ..graph import OUTPUTS, Graph, Port, color_settings
from ..inputs.default_view import choose_default_view
from ..media import read_layer
from ..media.comparison.metrics import Array
from ..media.pictures.stored import read_stored_parts
from ..renderer import FrameRenderer, Renderer, RenderRequest
from ..resources.sandbox import Sandbox

_LARGEST = 65504.0
"""The largest half float, which stands for infinity as in passes."""


class ShownOutput:
    """Renders one output as a file for people shows it, or as light. `is_light` says which."""

    def __init__(
        self, renderer: Renderer, graph: Graph, request: RenderRequest, output: str, view: str, is_light: bool
    ) -> None:
        self._renderer, self._request, self._output, self._is_light = renderer, request, output, is_light
        port = request.targets.get(output, Port(OUTPUTS, output))
        socket = graph.target(port) if port.node == OUTPUTS else graph.source(port)
        if not isinstance(socket, Socket) or not socket.kind.is_color:
            raise UsageError(f"'{output}' is data, and only colors are fitted: choose another output with --show")
        manager = get_color_manager(color_settings(graph), renderer.sandbox)
        if is_light:
            self._encoding = Encoding(space=LINEAR_REC709, manager=manager)
        else:
            own_view = graph.outputs[output].view if port.node == OUTPUTS else ""
            self._encoding = Encoding(view or own_view or self._choose_view(graph), manager=manager)
        self._encoding.check_names()

    def render(self, graph: Graph, scale: float) -> Array:
        """The picture of a graph as [h, w, 3] of float32, at a fraction of its size. Raises the errors of rendering."""
        frames = FrameRenderer(self._renderer, graph, structs.replace(self._request, scale=scale))
        try:
            pixels = frames.render_frame(self._request.frame)[self._output]
        finally:
            frames.close()
        return self.to_light(pixels)

    def to_light(self, pixels: Array) -> Array:
        """Pixels [h, w, channels] of the working space as light that can be compared."""
        encoded = self._encoding.to_encoded(pixels if pixels.shape[2] > 2 else to_three_channels(pixels))
        light = encoded[..., :3] if self._is_light else decode_srgb(np.clip(encoded[..., :3], 0.0, 1.0))
        return cover_with_alpha(light, encoded)

    def read_reference(self, path: Path, sandbox: Sandbox) -> Array:
        """The picture of a file as light, [h, w, 3] of float32. Raises InputError."""
        if self._is_light:
            return self.to_light(
                read_layer(path, "", Kind.IMAGE, manager=self._encoding.manager, sandbox=sandbox).array
            )
        part = next(iter(read_stored_parts(path, sandbox).values()))
        codes = part.array if part.array.shape[2] > 2 else to_three_channels(part.array[..., :1])
        return cover_with_alpha(decode_srgb(np.clip(codes[..., :3], 0.0, 1.0)), codes)

    def _choose_view(self, graph: Graph) -> str:
        plan = self._renderer.compile(graph, self._request)
        return choose_default_view(plan, plan.outputs[self._output], self._renderer.pictures)


def holds_light(path: Path, sandbox: Sandbox) -> bool:
    """True for a reference of scene-linear light. Raises InputError for one that cannot be read, or that is data."""
    part = next(iter(read_stored_parts(path, sandbox).values()))
    if part.is_data:
        raise InputError(f"{path}: this picture is data, not color; give one that has the channels R, G and B")
    return not part.is_encoded


def cover_with_alpha(light: Array, pixels: Array) -> Array:
    """Light as far as the alpha of straight `pixels` covers it, over black, as float32."""
    covered = light * np.clip(pixels[..., 3:4], 0.0, 1.0) if pixels.shape[2] == 4 else light
    return np.nan_to_num(covered, nan=0.0, posinf=_LARGEST, neginf=-_LARGEST).astype(np.float32)
