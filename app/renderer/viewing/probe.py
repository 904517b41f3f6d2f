"""Reads pixels back: the one under the pointer, a region, a small copy for scopes, the first that is not finite."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from ...compiler import load_library
from ...errors import UsageError
from ...graph import INPUTS, Graph, Port
from ..device import Bindings, Device, DeviceProgram, DeviceTexture, PixelRect
from ..engine import Renderer, RenderRequest
from ..execution.decoding import Array


class PixelProbe:
    """Reads textures of one device. Channels are those of the texture: a vector of three is stored as four."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._decimation: DeviceProgram | None = None

    def read_pixel(self, texture: DeviceTexture, x: int, y: int) -> tuple[float, ...]:
        """The channels of one pixel. Raises UsageError outside of the picture."""
        return tuple(float(part) for part in self.read_region(texture, (x, y, 1, 1))[0, 0])

    def read_region(self, texture: DeviceTexture, rect: PixelRect) -> Array:
        """Pixels as [height, width, channels] of float32. Raises UsageError outside of the picture."""
        x, y, width, height = rect
        across, down = texture.size
        if min(x, y) < 0 or min(width, height) < 1 or x + width > across or y + height > down:
            raise UsageError(f"{width}x{height} pixels at {x},{y} are not inside a picture of {across}x{down}")
        with self._device.make_current():
            return self._device.read_region(texture, rect)

    def read_small(self, texture: DeviceTexture, max_width: int, part: PixelRect | None = None) -> Array:
        """A picture of at most that width, of pixels taken at even distances: [height, width, channels] of float32.

        It shows a `part` of the texture, or all of it.
        """
        left, top, across, down = part or (0, 0, *texture.size)
        width = min(max_width, across)
        height = max(1, round(down * width / across))
        with self._device.save_draw_target():
            if self._decimation is None:
                text = "".join(part.body for part in load_library().closure(("viewer/decimate",), "viewer"))
                self._decimation = self._device.create_program(f"#version 410 core\n{text}")
            self._decimation.set("first", (float(left), float(top)))
            self._decimation.set("texels", (across / width, down / height))
            target = self._device.create_texture((width, height), texture.components, "f4")
            try:
                self._device.draw(self._decimation, [target], Bindings([texture]))
                return self._device.read_region(target, (0, 0, width, height))
            finally:
                target.release()

    def close(self) -> None:
        """Give everything back."""
        if self._decimation is not None:
            with self._device.make_current():
                self._decimation.release()
        self._decimation = None


class NonfinitePixel(Struct, frozen=True):
    """A pixel (x, y; row 0 on top) that is NaN or infinite, and the first node, in order, that has one."""

    path: str
    """Of the node, such as `glow/bloom`, or of the input: `inputs.beauty`."""
    port: Port
    pixel: tuple[int, int]
    value: tuple[float, ...]


def find_first_nonfinite(
    renderer: Renderer, graph: Graph, request: RenderRequest, port: Port
) -> Iterator[NonfinitePixel | None]:
    """Search the pixels of `port` and of everything upstream of it, in order and without fusion.

    Yields None after every step, so that a caller can stop in between, then the pixel if there is one. Raises the
    errors of `app.errors`.
    """
    plan = renderer.compile(graph, replace(request, targets={"": port}), fusion=False)
    firsts: dict[int, Port] = {}
    for result_port, number in plan.results.items():
        firsts.setdefault(number, result_port)
    firsts.setdefault(plan.outputs[""], port)
    for number, port_searched in firsts.items():
        pixels = yield from _render_pixels(renderer, graph, replace(request, targets={"": port_searched}))
        broken = np.argwhere(~np.isfinite(pixels[..., : plan.surfaces[number].channels]).all(axis=2))
        if len(broken):
            row, column = (int(part) for part in broken[0])
            path = f"{port_searched}" if port_searched.node.rpartition("/")[2] == INPUTS else port_searched.node
            yield NonfinitePixel(path, port_searched, (column, row), tuple(float(part) for part in pixels[row, column]))
            return
        yield None


def _render_pixels(renderer: Renderer, graph: Graph, request: RenderRequest) -> Generator[None, None, Array]:
    plan = renderer.compile(graph, request, fusion=False)
    lease = renderer.runner.create_lease()
    try:
        with renderer.runner.start_run(plan, lease) as run:
            for _ in run:
                yield None
        return renderer.runner.download(plan)[""]
    finally:
        lease.close()
