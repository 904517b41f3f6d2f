"""Writes a program in ReShade FX, by way of the HLSL that Slang makes of it.

ReShade FX has no blocks of numbers and no pictures apart from samplers, and its first versions had no lists of initial
values for structures, no transposed sizes of matrices and few functions of bits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from types import MappingProxyType

from msgspec import Struct

from ..slang.compiler import translate_by_slang
from ..slang.source import write_slang


class FxUniform(Struct, frozen=True):
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


class FxProgram(Struct, frozen=True):
    """The functions of a fragment shader; the last one is `draw`.

    It reads `given_NAME` for each uniform, or calls it with a place in a list; `fetch_NAME(int3)` for each picture;
    `sample_NAME` for each table.
    """

    text: str
    uniforms: tuple[FxUniform, ...]
    pictures: tuple[str, ...]
    tables: tuple[str, ...]


_DIRECTIVE = re.compile(r"^#.*\n", re.MULTILINE)
_COMMENT = re.compile(r"^//.*\n", re.MULTILINE)
_BLOCK = re.compile(r"^struct GlobalParams_0\n\{\n(?P<members>.*?)^\};\n", re.MULTILINE | re.DOTALL)
_BUFFER = re.compile(r"^cbuffer globalParams_0 .*?^\}\n", re.MULTILINE | re.DOTALL)
_MEMBER = re.compile(
    r"^\s+(?P<base>float|int|uint)(?P<width>[234])? +(?P<name>\w+)_0(?:\[int\((?P<count>\d+)\)\])?;", re.M
)
_PICTURE = re.compile(r"^Texture[23]D<float4 > (?P<name>\w+)_0 : register\(t\d+\);\n", re.MULTILINE)
_SAMPLER = re.compile(r"^SamplerState \w+ : register\(s\d+\);\n", re.MULTILINE)
_SAMPLED = re.compile(
    r"\b(?P<name>\w+)_0\.SampleLevel\(\((?P=name)_sampler_0\), |\b(\w+)_0\.SampleLevel\(\2_sampler_0, "
)
_STRUCT = re.compile(r"^struct (?P<name>\w+)\n\{\n(?P<members>.*?)^\};", re.MULTILINE | re.DOTALL)
_FILLED = re.compile(r"^(?P<indent> +)(?P<type>\w+) (?P<name>\w+) = \{ (?P<values>.*) \};$", re.MULTILINE)
_FIELD = re.compile(r"(\w+)(?: : \w+)?;")
_GIVEN = "globalParams_0."
_WIDE = re.compile(r"\bfloat2x3\((?P<values>[^()]*)\)")
_WIDE_PRODUCT = re.compile(
    r"^(?P<head>float2 \w+\(float3 (?P<v>\w+), float2x3 (?P<m>\w+)\)\n\{\n) +return [^;]*;", re.MULTILINE
)
_OBLONG = re.compile(r"\bfloat([234])x(?!\1)[234]\b")
_OTHER_WORDS = MappingProxyType(
    {
        "for(;;)": "while(true)",
        "firstbitlow(": "lowest_bit(",
        "firstbithigh(": "highest_bit(",
        "countbits(": "count_bits(",
        "main(": "draw(",
    }
)
"""What Slang writes, and what all versions of ReShade FX know."""


def write_fx(text: str) -> FxProgram:
    """A fragment shader of the compiler, GLSL 4.10, in ReShade FX. Raises UsageError, ValueError."""
    hlsl = translate_by_slang(write_slang(text, "fragment"), "fragment", "hlsl")
    hlsl = _COMMENT.sub("", _DIRECTIVE.sub("", hlsl))
    block = _BLOCK.search(hlsl)
    uniforms = tuple(
        FxUniform(match["name"], match["base"], int(match["width"] or 1), int(match["count"] or 0))
        for match in _MEMBER.finditer(block["members"] if block else "")
    )
    hlsl = _BUFFER.sub("", _BLOCK.sub("", hlsl))
    names = [match["name"] for match in _PICTURE.finditer(hlsl)]
    hlsl = _SAMPLER.sub("", _PICTURE.sub("", hlsl))
    tables = tuple(name for name in names if f"{name}_0.SampleLevel(" in hlsl)
    hlsl = _SAMPLED.sub(lambda match: f"sample_{match['name'] or match[2]}(", hlsl)
    for name in names:
        hlsl = hlsl.replace(f"{name}_0.Load(", f"fetch_{name}(")
    _refuse_unknown(hlsl)
    hlsl = _fill_structures(hlsl)
    for uniform in uniforms:
        hlsl = _read_uniform(hlsl, uniform)
    for word, other in _OTHER_WORDS.items():
        hlsl = re.sub(rf"\b{re.escape(word)}", other, hlsl)
    hlsl = _square_matrices(hlsl)
    if _OBLONG.search(hlsl):
        raise ValueError("it has matrices that are not square")
    pictures = tuple(name for name in names if f"fetch_{name}(" in hlsl)
    return FxProgram(hlsl, uniforms, pictures, tables)


def _read_uniform(text: str, uniform: FxUniform) -> str:
    """The text with `given_NAME` in place of a member of the block; a list is called with the place in it."""
    if not uniform.count:
        return re.sub(rf"\bglobalParams_0\.{uniform.name}_0\b", f"given_{uniform.name}", text)
    start = f"{_GIVEN}{uniform.name}_0["
    while (at := text.find(start)) >= 0:
        begin = at + len(start)
        end = _find_closing(text, begin, "[", "]")
        text = f"{text[:at]}given_{uniform.name}({text[begin:end]}){text[end + 1 :]}"
    return text


def _refuse_unknown(text: str) -> None:
    """Raise ValueError for what no spelling helps with."""
    names = "|".join(match["name"] for match in _STRUCT.finditer(text))
    if any(names and re.search(rf"^\s+(?:{names}) ", m["members"], re.MULTILINE) for m in _STRUCT.finditer(text)):
        raise ValueError("it has structures within structures")


def _fill_structures(text: str) -> str:
    """The text with each member of a structure set on its own, in place of a list of initial values."""
    fields = {match["name"]: _FIELD.findall(match["members"]) for match in _STRUCT.finditer(text)}

    def fill(match: re.Match[str]) -> str:
        if match["type"] not in fields:
            return match[0]
        indent, name = match["indent"], match["name"]
        values = _split(match["values"])
        lines = [
            f"{indent}{name}.{field} = {value};" for field, value in zip(fields[match["type"]], values, strict=True)
        ]
        return "\n".join([f"{indent}{match['type']} {name};", *lines])

    return _FILLED.sub(fill, text)


def _square_matrices(text: str) -> str:
    """The text with a third row in matrices of two rows, which multiply vectors of three: early versions have none."""
    text = _WIDE_PRODUCT.sub(
        lambda m: f"{m['head']}    return float2(dot({m['m']}[0], {m['v']}), dot({m['m']}[1], {m['v']}));", text
    )
    return _WIDE.sub(lambda m: f"float3x3({m['values']}, 0.0, 0.0, 0.0)", text).replace("float2x3", "float3x3")


def _find_closing(text: str, begin: int, opening: str, closing: str) -> int:
    """Where the bracket closes that was opened just before `begin`."""
    depth = 1
    for at in range(begin, len(text)):
        depth += (text[at] == opening) - (text[at] == closing)
        if depth == 0:
            return at
    raise ValueError("a bracket is not closed")


def _split(text: str) -> Iterator[str]:
    """Parts between commas that stand in no brackets."""
    depth = start = 0
    for at, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            yield text[start:at].strip()
            start = at + 1
    yield text[start:].strip()
