"""Writes programs as Godot reads them, and says where they read their numbers and pictures.

Godot compiles GLSL for Vulkan: a file has a part for each stage.
"""

from __future__ import annotations

import re

from msgspec import Struct

from ..game import DEPTH, NORMAL, PICTURE
from ..package.blocks import Place, lay_out_block
from ..package.dialects import COVERING_VERTEX, write_vulkan


class ProgramInterface(Struct, frozen=True):
    """Where a program reads what it is given, in set 0: numbers at binding 0, weights at 1, pictures from 2 on."""

    numbers: dict[str, Place]
    """Where each uniform stands in the block."""
    size: int
    """Bytes of the block; 0 for none."""
    pictures: dict[str, int]
    """Bindings of pictures and of tables of colors."""


_BLOCK = re.compile(r"^layout\(std140, set = 0, binding = 0\) uniform Numbers \{\n(?P<members>.*?)^\};", re.M | re.S)
_MEMBER = re.compile(r"^ +(?P<type>\w+) (?P<name>\w+)(?:\[(?P<length>\d+)\])?;$", re.MULTILINE)
_PICTURE = re.compile(
    r"^layout\(set = 0, binding = (?P<binding>\d+)\) uniform sampler[23]D (?P<name>\w+);", re.MULTILINE
)


def write_shader(fragment: str) -> tuple[str, ProgramInterface]:
    """The file of a program that covers its picture, and its interface. `fragment` is GLSL 4.10 of the compiler."""
    text = write_vulkan(fragment)
    block = _BLOCK.search(text)
    members = _MEMBER.finditer(block["members"]) if block else ()
    places, size = lay_out_block((each["type"], each["name"], int(each["length"] or 0)) for each in members)
    pictures = {each["name"]: int(each["binding"]) for each in _PICTURE.finditer(text)}
    return _join_stages(text), ProgramInterface(places, size, pictures)


def write_takers() -> dict[str, str]:
    """The programs that take what the game gives, and the one that shows the look: files by their names."""
    return {name: _join_stages(_OWN.replace("/*VALUE*/", value)) for name, value in _VALUES.items()}


def _join_stages(fragment: str) -> str:
    return f"#[vertex]\n\n{write_vulkan(COVERING_VERTEX)}\n#[fragment]\n\n{fragment}"


_OWN = """#version 450
layout(std140, set = 0, binding = 0) uniform Numbers { vec4 numbers; };  // width, height; then what the program needs
layout(set = 0, binding = 2) uniform sampler2D t0;
layout(location = 0) out vec4 result;
void main() {
    vec2 uv = gl_FragCoord.xy / numbers.xy;
    vec4 given = textureLod(t0, uv, 0.0);
    result = /*VALUE*/;
}
"""
_VALUES = {
    f"take_{PICTURE}": "vec4(given.rgb, 1.0)",
    # Godot stores near / distance, mapped so that the far end is 0: digits are where they are needed.
    f"take_{DEPTH}": "vec4(given.x > 0.0 ? numbers.z * numbers.w / mix(numbers.z, numbers.w, given.x) : 1e10, 0, 0, 1)",
    f"take_flat_{DEPTH}": "vec4(given.x > 0.0 ? mix(numbers.w, numbers.z, given.x) : 1e10, 0.0, 0.0, 1.0)",
    f"take_{NORMAL}": "vec4(given.xyz == vec3(0.0) ? vec3(0.0) : normalize(given.xyz * 2.0 - 1.0), 1.0)",
    "show_picture": "vec4(numbers.z > 0.0 ? given.rrr : given.rgb, 1.0)",
}
