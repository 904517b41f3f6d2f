"""Triangles on OpenGL."""

from __future__ import annotations

import moderngl
import numpy as np
from msgspec import Struct

from ...resources.mesh import ATTRIBUTES, Mesh


class OpenGLMesh(Struct, frozen=True, eq=False):
    """The buffers of a mesh."""

    context: moderngl.Context
    vertices: moderngl.Buffer
    indices: moderngl.Buffer

    def draw(self, program: moderngl.Program) -> None:
        """Draw its triangles into the bound framebuffer."""
        # What the program does not read is skipped, four bytes a float.
        layout = " ".join(f"{count}f" if name in program else f"{4 * count}x" for name, count in ATTRIBUTES.items())
        names = [name for name in ATTRIBUTES if name in program]
        vertices = self.context.vertex_array(program, [(self.vertices, layout, *names)], self.indices)
        vertices.render(moderngl.TRIANGLES)
        vertices.release()

    def release(self) -> None:
        self.vertices.release()
        self.indices.release()


def create_mesh(context: moderngl.Context, mesh: Mesh) -> OpenGLMesh:
    """Upload a mesh."""
    return OpenGLMesh(
        context,
        context.buffer(np.ascontiguousarray(mesh.vertices, np.float32)),
        context.buffer(np.ascontiguousarray(mesh.indices, np.uint32)),
    )
