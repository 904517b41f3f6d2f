"""Writes the programs of a package in other versions of GLSL. The compiler writes them in GLSL 4.10."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType

from .exact_functions import use_exact_functions

COVERING_VERTEX = """#version 410 core
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
"""
"""The vertex shader of a pass without meshes: one triangle that covers the picture."""

_HEAD = re.compile(r"\A#version 410 core\n(?:#extension[^\n]*\n)*")
_LINE = re.compile(r"^#line \d+\n", re.MULTILINE)
_PRECISE = re.compile(r"\bprecise\s+")
_UNIFORM = re.compile(r"^uniform (?P<type>\w+)(?P<array>\[\w+\])? (?P<name>\w+);\n", re.MULTILINE)
_WEIGHTS = "layout(std140) uniform Weights"
_VARYING = re.compile(r"^(?P<flat>flat )?(?P<way>in|out) (?P<rest>\w+ \w+;)$", re.MULTILINE)

_ES_HEAD = """#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
"""


_LATER: Mapping[str, str] = MappingProxyType(
    {
        "findLSB": "int findLSB(int x) { return x == 0 ? -1 : findMSB(x & -x); }\n"
        "int findLSB(uint x) { return x == 0u ? -1 : findMSB(x & (~x + 1u)); }",
        "findMSB": "int findMSB(uint x) {\n    int at = -1;\n    while (x != 0u) { x >>= 1u; ++at; }\n"
        "    return at;\n}\n"
        "int findMSB(int x) { return findMSB(uint(x < 0 ? ~x : x)); }",
        "bitCount": "int bitCount(uint x) {\n    int count = 0;\n    for (; x != 0u; x &= x - 1u) ++count;\n"
        "    return count;\n}\nint bitCount(int x) { return bitCount(uint(x)); }",
    }
)
"""Functions of GLSL 4.00 that older versions lack, last used first."""


def _write_older(text: str, head: str) -> str:
    """The text for a version below 4.00."""
    needed = [name for name in _LATER if re.search(rf"\b{name}\b", text)]
    if "findLSB" in needed and "findMSB" not in needed:
        needed.append("findMSB")
    functions = "".join(f"{_LATER[name]}\n" for name in reversed(needed))
    return _HEAD.sub(lambda _: head + functions, remove_precise(_LINE.sub("", text)))


def write_330(text: str) -> str:
    """For OpenGL 3.3."""
    return _write_older(text, "#version 330 core\n")


def write_410(text: str) -> str:
    """For OpenGL 4.1, which macOS has."""
    return _HEAD.sub("#version 410 core\n", _LINE.sub("", text))


def write_es300(text: str) -> str:
    """For OpenGL ES 3.0 and WebGL 2."""
    text, functions = use_exact_functions(text)
    return _write_older(text, _ES_HEAD + functions)


def remove_head(text: str) -> str:
    """The text without its version, extensions and numbers of lines."""
    return _HEAD.sub("", _LINE.sub("", text))


def remove_precise(text: str) -> str:
    """The text without a word that older and other languages lack."""
    return _PRECISE.sub("", text)


def place_varyings(text: str) -> str:
    """The text with the place of each input and each output, in the order in which they are declared."""
    places: dict[str, int] = {"in": 0, "out": 0}

    def place(match: re.Match[str]) -> str:
        places[match["way"]] += 1
        flat = match["flat"] or ""
        return f"layout(location = {places[match['way']] - 1}) {flat}{match['way']} {match['rest']}"

    return _VARYING.sub(place, text)


def write_vulkan(text: str) -> str:
    """For Vulkan: numbers in one block at binding 0, weights at 1, pictures from 2 on, all of set 0."""
    text = remove_head(text).replace("gl_VertexID", "gl_VertexIndex")
    numbers: list[str] = []
    bindings = 2
    samplers: list[str] = []
    for match in _UNIFORM.finditer(text):
        if match["type"].startswith("sampler"):
            samplers.append(f"layout(set = 0, binding = {bindings}) {match[0].rstrip()}")
            bindings += 1
        else:
            numbers.append(f"    {match['type']} {match['name']}{match['array'] or ''};")
    text = _UNIFORM.sub("", text).replace(_WEIGHTS, "layout(std140, set = 0, binding = 1) uniform Weights")
    block = ["layout(std140, set = 0, binding = 0) uniform Numbers {", *numbers, "};"] if numbers else []
    return "\n".join(["#version 450", *block, *samplers, place_varyings(text)])


DIALECTS: Mapping[str, Callable[[str], str]] = MappingProxyType(
    {"glsl330": write_330, "glsl410": write_410, "es300": write_es300, "vulkan450": write_vulkan}
)
"""How a program is written for each version, by the name of its folder."""
