"""Spells a program of the compiler, which is GLSL 4.10, so that Slang reads it: pictures apart from their samplers."""

from __future__ import annotations

import re

from ..package.dialects import place_varyings, remove_head, remove_precise
from ..shipped_files import read_shipped_text

_WEIGHTS = re.compile(r"^layout\(std140\) uniform Weights \{ (?P<member>[^}]*) \};", re.MULTILINE)
_SAMPLER = re.compile(r"^uniform sampler(?P<kind>2D|3D) (?P<name>\w+);$", re.MULTILINE)
_MATRIX = re.compile(r"^uniform mat3 (?P<name>\w+);", re.MULTILINE)
COLUMNS = "_columns"
"""How the name of a matrix ends that is stored as a list of its columns."""
_FLIPPED_MAIN = """
void main() {
    place_vertex();
    gl_Position = vec4(gl_Position.x, -gl_Position.y, 0.5 * (gl_Position.z + gl_Position.w), gl_Position.w);
}
"""
"""Row 0 is the first one above in WebGPU, and depth lies from 0 to 1."""


def write_slang(text: str, stage: str) -> str:
    """The text as Slang reads it: pictures apart from samplers, places of varyings in order, weights as a uniform."""
    text = remove_precise(remove_head(text)).replace("gl_VertexID", "gl_VertexIndex")
    text = _WEIGHTS.sub(lambda match: f"uniform {match['member']}", text)
    text = _MATRIX.sub(_write_columns, text)
    if stage == "vertex":
        text = text.replace("void main()", "void place_vertex()") + _FLIPPED_MAIN
    tables = set(re.findall(r"\btexture\((\w+),", text))

    def separate(match: re.Match[str]) -> str:
        sampler = f"\nSamplerState {match['name']}_sampler;" if match["name"] in tables else ""
        return f"Texture{match['kind']}<float4> {match['name']};{sampler}"

    text = place_varyings(_SAMPLER.sub(separate, text))
    return f"#version 450\n{read_shipped_text('glsl.slang')}\n#line 1\n{text}"


def _write_columns(match: re.Match[str]) -> str:
    """A matrix as a list of columns, each in a row of the block: no choice between storing rows and columns is left."""
    columns = [f"{match['name']}{COLUMNS}[{i}].xyz" for i in range(3)]
    return f"uniform vec4 {match['name']}{COLUMNS}[3];\n#define {match['name']} mat3({', '.join(columns)})"
