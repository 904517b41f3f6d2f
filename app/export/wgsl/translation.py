"""Writes a program in WGSL, and says where it reads its numbers and pictures.

WGSL has no uniforms that are set one by one and no samplers that hold their pictures: a program has one block of
numbers, and each picture a binding of its own.
"""

from __future__ import annotations

import re

from msgspec import Struct

from ..package.blocks import Place, lay_out_block
from ..slang.compiler import translate_by_slang
from ..slang.source import COLUMNS, write_slang


class ShaderInterface(Struct, frozen=True):
    """Where a program reads what it is given: a fragment shader in group 0, a vertex shader in group 1."""

    numbers: int | None
    """The binding of the block of numbers."""
    size: int
    """Bytes of the block."""
    uniforms: dict[str, Place]
    """Where each uniform stands in the block."""
    textures: dict[str, int]
    samplers: dict[str, int]
    """Bindings of pictures and tables, and of the samplers of tables."""


class WgslProgram(Struct, frozen=True):
    """A fragment or vertex shader in WGSL; its function is `main`."""

    text: str
    interface: ShaderInterface


_UNIFORM = re.compile(
    r"^uniform (?P<type>float|int|uint|bool|[iub]?vec[234])(?:\[(?P<inner>\d+)\])? (?P<name>\w+)"
    r"(?:\[(?P<outer>\d+)\])?;",
    re.MULTILINE,
)
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


def _lay_out(text: str) -> tuple[dict[str, Place], int]:
    """Where uniforms stand in the block, and its bytes. Slang reads a matrix as a list of columns of three numbers."""
    matches = [*_UNIFORM.finditer(text)]
    uniforms = [(match["type"], match["name"], int(match["inner"] or match["outer"] or 0)) for match in matches]
    places, size = lay_out_block(uniforms)
    whole: dict[str, Place] = {}
    for name, (start, kind, width) in places.items():
        whole[name.removesuffix(COLUMNS)] = start, kind, 3 if name.endswith(COLUMNS) else width
    return whole, size
