"""Writes the program of a pass that draws meshes."""

from __future__ import annotations

from halation.nodes import CameraModel, Uniform

from ..areas import Region
from ..fusion.fuse import PassGroup
from ..ir import LoweredProgram, Raster
from ..library import Library
from ..plan import Shader
from ..raster import CHANNELS, write_fragment_lines, write_vertex_text


def write_raster(
    program: LoweredProgram, root: Raster, group: PassGroup, library: Library
) -> tuple[Shader, tuple[tuple[str, Uniform], ...]]:
    """The vertex and fragment shader that write the channels that are read, and the values of their uniforms."""
    text = library.closure(root.files, root.owner)[0]
    channels = [tuple(CHANNELS)[ref.output] for ref in group.writes]
    lines = write_fragment_lines(text.body, channels)
    window, (width, height) = program.window(group.writes[0]) or Region.whole(root.size), root.size
    shader = Shader("\n".join(lines) + "\n", "fragment", ("generated",), False, write_vertex_text(text.body))
    return shader, (
        ("cameras", root.cameras),
        ("motions", root.motions),
        ("near", root.near),
        ("eye", CameraModel(root.cameras[:12]).eye),
        ("window", (width / window.width, height / window.height, window.x / window.width, window.y / window.height)),
        ("grid", root.size),
        ("proxy", program.scale),
    )
