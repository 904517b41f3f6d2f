"""Reads numbers back: a pixel under the pointer, a region, a small copy for scopes, the first that is not finite."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import moderngl
import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from ...compiler import installed
from ...errors import UsageError
from ...graph import INPUTS, Graph, Port
from ..engine import Renderer, RenderRequest
from ..execution.decoding import Array
from ..opengl.device import Device
from ..opengl.programs import VERTEX, undisturbed

Rect = tuple[int, int, int, int]
"""x, y, width, height in pixels of the texture, row 0 on top."""


class Probe:
    """Reads textures of one device. Channels are those of the texture: a vector of three is stored as four."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._program: moderngl.Program | None = None
        self._vertices: moderngl.VertexArray | None = None

    def pixel(self, texture: moderngl.Texture, x: int, y: int) -> tuple[float, ...]:
        """The channels of one pixel. Raises UsageError outside of the picture."""
        return tuple(float(part) for part in self.region(texture, (x, y, 1, 1))[0, 0])

    def region(self, texture: moderngl.Texture, rect: Rect) -> Array:
        """Pixels as [height, width, channels] of float32. Raises UsageError outside of the picture."""
        x, y, width, height = rect
        if min(x, y) < 0 or min(width, height) < 1 or x + width > texture.width or y + height > texture.height:
            size = f"{texture.width}x{texture.height}"
            raise UsageError(f"{width}x{height} pixels at {x},{y} are not inside a picture of {size}")
        with self._device.current():
            framebuffer = self._device.context.framebuffer([texture])
            try:
                return _read(framebuffer, rect, texture.components)
            finally:
                framebuffer.release()

    def small(self, texture: moderngl.Texture, max_width: int) -> Array:
        """A picture of at most that width, of pixels taken at even distances: [height, width, channels] of float32."""
        width = min(max_width, texture.width)
        height = max(1, round(texture.height * width / texture.width))
        with self._device.drawing() as context:
            program, vertices = self._decimation(context)
            target = context.texture((width, height), texture.components, dtype="f4")
            framebuffer = context.framebuffer([target])
            try:
                framebuffer.use()
                texture.use(0)
                program["texels"] = (texture.width / width, texture.height / height)
                vertices.render(moderngl.TRIANGLES, vertices=3)
                return _read(framebuffer, (0, 0, width, height), texture.components)
            finally:
                framebuffer.release()
                target.release()

    def close(self) -> None:
        """Give everything back."""
        with self._device.current():
            for item in (self._vertices, self._program):
                if item is not None:
                    item.release()
        self._vertices = self._program = None

    def _decimation(self, context: moderngl.Context) -> tuple[moderngl.Program, moderngl.VertexArray]:
        if self._program is None or self._vertices is None:
            text = "".join(part.body for part in installed().closure(("viewer/decimate",), "viewer"))
            with undisturbed():
                self._program = context.program(vertex_shader=VERTEX, fragment_shader=f"#version 410 core\n{text}")
                self._vertices = context.vertex_array(self._program, [])
        return self._program, self._vertices


def _read(framebuffer: moderngl.Framebuffer, rect: Rect, components: int) -> Array:
    pixels = np.empty((rect[3], rect[2], components), np.float32)
    framebuffer.read_into(pixels, viewport=rect, components=components, dtype="f4", alignment=1)
    return pixels


class Nonfinite(Struct, frozen=True):
    """A pixel (x, y; row 0 on top) that is NaN or infinite, and the first node, in order, that has one."""

    path: str
    """Of the node, such as `glow/bloom`, or of the input: `inputs.beauty`."""
    port: Port
    pixel: tuple[int, int]
    value: tuple[float, ...]


def first_nonfinite(renderer: Renderer, graph: Graph, wanted: RenderRequest, port: Port) -> Iterator[Nonfinite | None]:
    """Search what `port` shows and everything upstream of it, in order and without fusion.

    Yields None after every step, so that a caller can stop in between; what is found comes last. Raises the errors of
    `app.errors`.
    """
    plan = renderer.compile(graph, replace(wanted, targets={"": port}), fusion=False)
    firsts: dict[int, Port] = {}
    for known, number in plan.results.items():
        firsts.setdefault(number, known)
    firsts.setdefault(plan.outputs[""], port)
    for number, one in firsts.items():
        pixels = yield from _pixels(renderer, graph, replace(wanted, targets={"": one}))
        broken = np.argwhere(~np.isfinite(pixels[..., : plan.surfaces[number].channels]).all(axis=2))
        if len(broken):
            row, column = (int(part) for part in broken[0])
            path = f"{one}" if one.node.rpartition("/")[2] == INPUTS else one.node
            yield Nonfinite(path, one, (column, row), tuple(float(part) for part in pixels[row, column]))
            return
        yield None


def _pixels(renderer: Renderer, graph: Graph, wanted: RenderRequest) -> Generator[None, None, Array]:
    plan = renderer.compile(graph, wanted, fusion=False)
    kept = renderer.runner.lease()
    try:
        with renderer.runner.steps(plan, kept) as steps:
            for _ in steps:
                yield None
        return renderer.runner.download(plan)[""]
    finally:
        kept.close()
