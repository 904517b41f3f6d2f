"""Writes a program of the compiler in HLSL, by Slang, without the numbers and pictures that Slang declares.

Effects for games have their own ways to give numbers and pictures. So a program calls functions for them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from msgspec import Struct

from .compiler import translate_by_slang
from .source import COLUMNS, write_slang


class HlslUniform(Struct, frozen=True):
    """A number or vector that a program is given, or a list of them: `count` is 0 for a single one."""

    name: str
    base: str
    """float, int or uint."""
    width: int
    count: int

    @property
    def type(self) -> str:
        """The type of one, such as `float3`."""
        return self.base + (str(self.width) if self.width > 1 else "")

    @property
    def own_name(self) -> str:
        """The name that the uniform has in the package: Slang reads a matrix as a list of columns."""
        return self.name.removesuffix(COLUMNS)

    @property
    def group(self) -> int:
        """Numbers of the package in each vector: three in a column of a matrix."""
        return 3 if self.name.endswith(COLUMNS) else self.width


class HlslProgram(Struct, frozen=True):
    """The functions of a fragment shader; the last one is `main`.

    It calls `given_NAME()` for each uniform, `given_NAME(int)` for a place in a list; `fetch_NAME(int3)` for each
    picture; `sample_NAME(place, level)` for each table.
    """

    text: str
    uniforms: tuple[HlslUniform, ...]
    pictures: tuple[str, ...]
    tables: tuple[str, ...]
    dimensions: Mapping[str, int]
    """2 or 3 for each picture and table."""


_DIRECTIVE = re.compile(r"^#.*\n", re.MULTILINE)
_COMMENT = re.compile(r"^//.*\n", re.MULTILINE)
_BLOCK = re.compile(r"^struct GlobalParams_0\n\{\n(?P<members>.*?)^\};\n", re.MULTILINE | re.DOTALL)
_BUFFER = re.compile(r"^cbuffer globalParams_0 .*?^\}\n", re.MULTILINE | re.DOTALL)
_MEMBER = re.compile(
    r"^\s+(?P<base>float|int|uint)(?P<width>[234])? +(?P<name>\w+)_0(?:\[int\((?P<count>\d+)\)\])?;", re.M
)
_PICTURE = re.compile(r"^Texture(?P<kind>[23])D<float4 > (?P<name>\w+)_0 : register\(t\d+\);\n", re.MULTILINE)
_SAMPLER = re.compile(r"^SamplerState \w+ : register\(s\d+\);\n", re.MULTILINE)
_SAMPLED = re.compile(
    r"\b(?P<name>\w+)_0\.SampleLevel\(\((?P=name)_sampler_0\), |\b(\w+)_0\.SampleLevel\(\2_sampler_0, "
)
_GIVEN = "globalParams_0."


def write_hlsl(text: str) -> HlslProgram:
    """A fragment shader of the compiler, GLSL 4.10, in HLSL. Raises UsageError, ValueError."""
    hlsl = translate_by_slang(write_slang(text, "fragment"), "fragment", "hlsl")
    hlsl = _COMMENT.sub("", _DIRECTIVE.sub("", hlsl))
    block = _BLOCK.search(hlsl)
    uniforms = tuple(
        HlslUniform(match["name"], match["base"], int(match["width"] or 1), int(match["count"] or 0))
        for match in _MEMBER.finditer(block["members"] if block else "")
    )
    hlsl = _BUFFER.sub("", _BLOCK.sub("", hlsl))
    dimensions = {match["name"]: int(match["kind"]) for match in _PICTURE.finditer(hlsl)}
    hlsl = _SAMPLER.sub("", _PICTURE.sub("", hlsl))
    tables = tuple(name for name in dimensions if f"{name}_0.SampleLevel(" in hlsl)
    hlsl = _SAMPLED.sub(lambda match: f"sample_{match['name'] or match[2]}(", hlsl)
    for name in dimensions:
        hlsl = hlsl.replace(f"{name}_0.Load(", f"fetch_{name}(")
    for uniform in uniforms:
        hlsl = _read_uniform(hlsl, uniform)
    pictures = tuple(name for name in dimensions if f"fetch_{name}(" in hlsl)
    return HlslProgram(hlsl, uniforms, pictures, tables, dimensions)


def _read_uniform(text: str, uniform: HlslUniform) -> str:
    """The text with `given_NAME()` in place of a member of the block; a list is called with the place in it."""
    if not uniform.count:
        return re.sub(rf"\bglobalParams_0\.{uniform.name}_0\b", f"given_{uniform.name}()", text)
    start = f"{_GIVEN}{uniform.name}_0["
    while (at := text.find(start)) >= 0:
        begin = at + len(start)
        end = _find_closing(text, begin, "[", "]")
        text = f"{text[:at]}given_{uniform.name}({text[begin:end]}){text[end + 1 :]}"
    return text


def _find_closing(text: str, begin: int, opening: str, closing: str) -> int:
    """Where the bracket closes that was opened just before `begin`."""
    depth = 1
    for at in range(begin, len(text)):
        depth += (text[at] == opening) - (text[at] == closing)
        if depth == 0:
            return at
    raise ValueError("a bracket is not closed")
