"""Writes a program in ReShade FX, a dialect of HLSL.

Its first versions had no lists of initial values for structures, no transposed sizes of matrices and few functions of
bits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from types import MappingProxyType

import msgspec

from ..slang.hlsl import HlslProgram, write_hlsl

_STRUCT = re.compile(r"^struct (?P<name>\w+)\n\{\n(?P<members>.*?)^\};", re.MULTILINE | re.DOTALL)
_FILLED = re.compile(r"^(?P<indent> +)(?P<type>\w+) (?P<name>\w+) = \{ (?P<values>.*) \};$", re.MULTILINE)
_FIELD = re.compile(r"(\w+)(?: : \w+)?;")
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
"""Names that Slang writes, and those that all versions of ReShade FX know instead."""


def write_fx(text: str) -> HlslProgram:
    """A fragment shader of the compiler, GLSL 4.10, in ReShade FX: `draw` is its last function.

    Raises UsageError, ValueError.
    """
    program = write_hlsl(text)
    _refuse_unknown(program.text)
    spelled = _fill_structures(program.text)
    for word, other in _OTHER_WORDS.items():
        spelled = re.sub(rf"\b{re.escape(word)}", other, spelled)
    spelled = _square_matrices(spelled)
    if _OBLONG.search(spelled):
        raise ValueError("it has matrices that are not square")
    return msgspec.structs.replace(program, text=spelled)


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


def _split(text: str) -> Iterator[str]:
    """Parts between commas that stand in no brackets."""
    depth = start = 0
    for at, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            yield text[start:at].strip()
            start = at + 1
    yield text[start:].strip()
