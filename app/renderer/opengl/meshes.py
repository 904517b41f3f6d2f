"""Triangles on the device."""

from __future__ import annotations

import moderngl
import numpy as np
from msgspec import Struct

from ...resources.mesh import ATTRIBUTES, Mesh

MAX_MESHES = 16


class _Buffers(Struct, frozen=True):
    vertices: moderngl.Buffer
    indices: moderngl.Buffer

    def release(self) -> None:
        self.vertices.release()
        self.indices.release()


class MeshBuffers:
    """The meshes of passes, each uploaded once."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._known: dict[Mesh, _Buffers] = {}

    def draw(self, mesh: Mesh, program: moderngl.Program) -> None:
        """Draw a mesh into what is bound."""
        buffers = self._known.pop(mesh, None)
        if buffers is None:
            if len(self._known) >= MAX_MESHES:
                self._known.pop(next(iter(self._known))).release()
            buffers = _Buffers(
                self._context.buffer(np.ascontiguousarray(mesh.vertices, np.float32)),
                self._context.buffer(np.ascontiguousarray(mesh.indices, np.uint32)),
            )
        self._known[mesh] = buffers
        # What the program does not read is skipped, four bytes a float.
        layout = " ".join(f"{count}f" if name in program else f"{4 * count}x" for name, count in ATTRIBUTES.items())
        names = [name for name in ATTRIBUTES if name in program]
        drawn = self._context.vertex_array(program, [(buffers.vertices, layout, *names)], buffers.indices)
        drawn.render(moderngl.TRIANGLES)
        drawn.release()

    def clear(self) -> None:
        """Give everything back to the driver."""
        for buffers in self._known.values():
            buffers.release()
        self._known.clear()
