"""Compiled programs by source. A value never changes a source, so dragging a slider compiles nothing."""

from __future__ import annotations

import re
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import moderngl
import numpy as np
from msgspec import Struct, field

from ...compiler import FIRST_TABLE, Pass, Shader
from ...custom_nodes import unprefixed
from ...errors import ShaderError

# Mesa: "2:14(5): error: ...", NVIDIA: "2(14) : error ...", Apple and AMD: "ERROR: 2:14: ..."
_FAULT = re.compile(r"(?:ERROR:\s*)?(\d+)(?::(\d+)(?:\(\d+\))?|\((\d+)\))\s*:\s*(.*)")

MAX_PROGRAMS = 512
"""Programs kept: more than any graph needs, and an end to hours of editing."""


class Program(Struct):
    """One compiled program and the values its uniforms have now."""

    handle: moderngl.Program | moderngl.ComputeShader
    vertices: moderngl.VertexArray | None
    values: dict[str, object] = field(default_factory=dict[str, object])

    def set(self, name: str, value: object) -> None:
        """Set a uniform, unless it has that value or the driver found it unused."""
        if self.values.get(name) != value and name in self.handle:
            member = self.handle[name]
            if isinstance(member, moderngl.Uniform) and member.array_length > 1:
                # Drivers cut off the end of an array that nothing reads.
                member.write(np.asarray(value, np.float32)[: member.array_length * member.dimension].tobytes())
            else:
                self.handle[name] = value
            self.values[name] = value

    def release(self) -> None:
        """Give it back to the driver."""
        if self.vertices is not None:
            self.vertices.release()
        self.handle.release()


class Programs:
    """Compiles on first use and keeps those used last. `compiled` counts."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._known: dict[Shader, Program] = {}
        self.compiled = 0

    def get(self, one: Pass) -> Program:
        """The program of a pass. Raises ShaderError with node, file and line where the driver refuses it."""
        known = self._known.pop(one.shader, None)
        if known is None:
            with undisturbed():
                known = self._known[one.shader] = self._compile(one)
                self.compiled += 1
        self._known[one.shader] = known
        if len(self._known) > MAX_PROGRAMS:
            self._known.pop(next(iter(self._known))).release()
        return known

    def clear(self) -> None:
        """Give everything back to the driver."""
        for program in self._known.values():
            program.release()
        self._known.clear()

    def _compile(self, one: Pass) -> Program:
        try:
            if one.shader.form == "compute":
                program = Program(self._context.compute_shader(one.shader.source), None)
            else:
                vertex = one.shader.vertex
                handle = self._context.program(vertex_shader=vertex or VERTEX, fragment_shader=one.shader.source)
                program = Program(handle, None if one.mesh else self._context.vertex_array(handle, []))
        except moderngl.Error as fault:
            raise _located(one, str(fault)) from None
        weights = program.handle.get("Weights", None)
        if isinstance(weights, moderngl.UniformBlock):
            weights.binding = 0
        for unit, table in enumerate(one.tables, FIRST_TABLE):
            program.set(table.sampler, unit)
        if one.shader.form == "fragment" and not one.shader.foreign:
            for number in range(len(one.textures)):
                program.set(f"t{number}", number)
        return program


@contextmanager
def undisturbed() -> Iterator[None]:
    """An interrupt is heard after this block: moderngl calls Python while it links, and crashes if that raises."""
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or before is None:
        yield
        return
    heard: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: heard.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if heard:
        signal.raise_signal(signal.SIGINT)


# One triangle that covers everything.
VERTEX = """#version 410 core
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
"""


def _located(one: Pass, log: str) -> ShaderError:
    """The first fault in a driver's log, in terms of the user's files."""
    for line in log.splitlines():
        match = _FAULT.match(line.strip())
        if match and not match[4].lower().startswith("warning"):
            name, row = one.shader.locate(int(match[2] or match[3]))
            said = unprefixed(match[4].strip())
            return ShaderError(one.writers.get(name, ", ".join(one.nodes)), name, row, said)
    first = next((line.strip() for line in log.splitlines() if "error" in line.lower()), log.strip())
    return ShaderError(", ".join(one.nodes), one.shader.files[-1], 1, first)
