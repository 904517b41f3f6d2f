"""Corners of triangles where every device can place them, so that pictures of several devices have the same edges.

Devices round the corners to parts of a pixel, OpenGL's SUBPIXEL_BITS: Mesa's llvmpipe to 256ths, SwiftShader to
sixteenths, as OpenGL asks for, and softpipe not at all. So along edges they cover other pixels, which says nothing
about what is compared.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from unittest.mock import patch

from halation.compiler.areas import Region
from halation.compiler.codegen import emit, rasterize
from halation.compiler.fusion.fuse import PassGroup
from halation.compiler.ir import LoweredProgram, Raster
from halation.compiler.library import Library


def place_corners(write_exactly: Callable[[str], str], size: tuple[int, int], parts: int) -> Callable[[str], str]:
    """`write_vertex_text` with corners at parts of a pixel of pictures of this size."""
    width, height = size

    def write_rounded(library: str) -> str:
        body, end, _ = write_exactly(library).rpartition("}")
        return f"""{body}
            if (gl_Position.w > 0.0) {{
                const vec2 room = vec2({width}.0, {height}.0) * 0.5;
                vec2 at = (gl_Position.xy / gl_Position.w + 1.0) * room;
                gl_Position.xy = (floor(at * {parts}.0 + 0.5) / {parts}.0 / room - 1.0) * gl_Position.w;
            }}
        {end}"""

    return write_rounded


@contextmanager
def place_all_corners(parts: int) -> Iterator[None]:
    """All meshes that are drawn inside this context have their corners at parts of a pixel, at any size."""
    write_exactly, write_pass = rasterize.write_vertex_text, rasterize.write_raster

    def write_placed(program: LoweredProgram, root: Raster, group: PassGroup, library: Library):
        window = program.window(group.writes[0]) or Region.whole(root.size)
        placed = place_corners(write_exactly, (window.width, window.height), parts)
        with patch.object(rasterize, "write_vertex_text", placed):
            return write_pass(program, root, group, library)

    with patch.object(emit, "write_raster", write_placed):
        yield
