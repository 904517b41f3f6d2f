"""Writes a program in WGSL, and says where it reads its numbers and pictures.

WGSL has no uniforms that are set one by one and no samplers that hold their pictures: a program has one block of
numbers, and each picture a binding of its own.
"""

from __future__ import annotations

import re

from msgspec import Struct

from ..slang.compiler import translate_by_slang
from ..slang.source import COLUMNS, write_slang


class ShaderInterface(Struct, frozen=True):
    """Where a program reads what it is given: a fragment shader in group 0, a vertex shader in group 1."""

    numbers: int | None
    """The binding of the block of numbers."""
    size: int
    """Bytes of the block."""
    uniforms: dict[str, tuple[int, str, int]]
    """Of each uniform: the byte of the block where it begins, the kind of its numbers (float, int, uint), and for an
    array or a matrix how many of them stand in each row of 16 bytes; else 0."""
    textures: dict[str, int]
    samplers: dict[str, int]
    """Bindings of pictures and tables, and of the samplers of tables."""


class WgslProgram(Struct, frozen=True):
    """A fragment or vertex shader in WGSL; its function is `main`."""

    text: str
    interface: ShaderInterface


_UNIFORM = re.compile(
    r"^uniform (?P<kind>float|int|uint|bool|[iub]?vec)(?P<size>[234])?(?:\[(?P<inner>\d+)\])? (?P<name>\w+)"
    r"(?:\[(?P<outer>\d+)\])?;",
    re.MULTILINE,
)
_KINDS = {"vec": "float", "float": "float", "ivec": "int", "int": "int", "bool": "int", "bvec": "int"} | {
    "uvec": "uint",
    "uint": "uint",
}
_DECLARED = re.compile(r"^layout\(location = (?P<place>\d+)\) (?:flat )?(?:in|out) \w+ (?P<name>\w+);", re.MULTILINE)
_LOCATION = re.compile(r"@location\(\d+\) (?P<name>\w+)_0 :")
_BINDING = re.compile(r"@binding\((\d+)\) @group\(\d\) var(?:<uniform>)? (\w+)_0\b")
_COMPARISON = re.compile(r"\b([A-Za-z_][\w.]*) < ")
"""A name before `<` begins a list of types in WGSL, if a `>` follows anywhere in the same brackets."""


def write_wgsl(text: str, stage: str) -> WgslProgram:
    """A program of the compiler, which is GLSL 4.10, in WGSL. Raises UsageError, ValueError."""
    slang = write_slang(text, stage)
    wgsl = _COMPARISON.sub(r"(\1) < ", _restore_places(translate_by_slang(slang, stage, "wgsl"), slang))
    if stage == "vertex":
        wgsl = wgsl.replace("@group(0)", "@group(1)")  # the fragment shader of the same pass has group 0
    bindings = {name: int(number) for number, name in _BINDING.findall(wgsl)}
    uniforms, size = _lay_out(slang)
    numbers = bindings.pop("globalParams", None)
    samplers = {name.removesuffix("_sampler"): at for name, at in bindings.items() if name.endswith("_sampler")}
    textures = {name: at for name, at in bindings.items() if not name.endswith("_sampler")}
    return WgslProgram(wgsl, ShaderInterface(numbers, size, uniforms, textures, samplers))


def _restore_places(wgsl: str, slang: str) -> str:
    """Gives inputs and outputs the places that they were declared with: Slang numbers those that are used."""
    places = {match["name"]: match["place"] for match in _DECLARED.finditer(slang)}
    return _LOCATION.sub(lambda match: f"@location({places[match['name']]}) {match['name']}_0 :", wgsl)


def _lay_out(text: str) -> tuple[dict[str, tuple[int, str, int]], int]:
    """Where uniforms begin by the rules std140 (GLSL 4.60, section 7.6.2.2), and the bytes of all."""
    places: dict[str, tuple[int, str, int]] = {}
    end = 0
    for match in _UNIFORM.finditer(text):
        size = int(match["size"] or 1)
        rows = int(match["inner"] or match["outer"] or 0)
        align = 16 if rows or size > 2 else 4 * size
        start = -(-end // align) * align
        name, kind = match["name"], _KINDS[match["kind"]]
        places[name.removesuffix(COLUMNS)] = start, kind, _count_in_row(name, size) if rows else 0
        end = start + (16 * rows if rows else 4 * size)
    return places, -(-end // 16) * 16


def _count_in_row(name: str, size: int) -> int:
    return 3 if name.endswith(COLUMNS) else size
