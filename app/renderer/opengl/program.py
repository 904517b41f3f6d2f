"""Compiled programs on OpenGL."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import moderngl
import numpy as np
from msgspec import Struct, field

from ...errors import DeviceError
from ..device import WEIGHTS_BLOCK

_INTERRUPTS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))

# One triangle that covers everything.
_COVERING_VERTEX = """#version 410 core
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
"""


class OpenGLProgram(Struct, eq=False):
    """A compiled program and the values its uniforms have now."""

    context: moderngl.Context
    handle: moderngl.Program | moderngl.ComputeShader
    covers_all: bool = True
    """One triangle covers all pixels; else the vertex shader gets a strip of four vertices."""
    _vertices: moderngl.VertexArray | None = None
    _values: dict[str, object] = field(default_factory=dict[str, object])

    def draw(self) -> None:
        """Draw into the bound framebuffer. Vertices have no attributes: the shader goes by their numbers."""
        if self._vertices is None:
            assert isinstance(self.handle, moderngl.Program)
            self._vertices = self.context.vertex_array(self.handle, [])
        if self.covers_all:
            self._vertices.render(moderngl.TRIANGLES, vertices=3)
        else:
            self._vertices.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def set(self, name: str, value: object) -> None:
        if self._values.get(name) != value and name in self.handle:
            member = self.handle[name]
            if isinstance(member, moderngl.Uniform) and member.array_length > 1:
                # Drivers cut off the end of an array that nothing reads.
                member.write(np.asarray(value, np.float32)[: member.array_length * member.dimension].tobytes())
            else:
                self.handle[name] = value
            self._values[name] = value

    def release(self) -> None:
        if self._vertices is not None:
            self._vertices.release()
        self.handle.release()


def create_program(context: moderngl.Context, fragment: str, vertex: str) -> OpenGLProgram:
    """Compile a fragment shader, by default with a vertex shader that covers everything. Raises DeviceError."""
    with _postpone_interrupts():
        try:
            handle = context.program(vertex_shader=vertex or _COVERING_VERTEX, fragment_shader=fragment)
        except moderngl.Error as fault:
            raise DeviceError(str(fault)) from None
        return _bind_weights(OpenGLProgram(context, handle, covers_all=not vertex))


def create_compute_program(context: moderngl.Context, source: str) -> OpenGLProgram:
    """Compile a compute shader. Raises DeviceError."""
    with _postpone_interrupts():
        try:
            handle = context.compute_shader(source)
        except moderngl.Error as fault:
            raise DeviceError(str(fault)) from None
        return _bind_weights(OpenGLProgram(context, handle))


def _bind_weights(program: OpenGLProgram) -> OpenGLProgram:
    block = program.handle.get(WEIGHTS_BLOCK, None)
    if isinstance(block, moderngl.UniformBlock):
        block.binding = 0
    return program


@contextmanager
def _postpone_interrupts() -> Iterator[None]:
    """An interrupt is raised after this block: moderngl calls Python while it links, and crashes if that raises."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    pending: list[int] = []
    numbers = [number for number in _INTERRUPTS if callable(signal.getsignal(number))]
    before = {number: signal.signal(number, lambda number, _: pending.append(number)) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    if pending:
        signal.raise_signal(pending[0])
