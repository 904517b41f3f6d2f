"""Writes programs as passes of a shader of Unity, and says where they read their numbers and pictures.

Unity gives a shader lists of vectors: each program has one, `_Numbers`, with a row for each uniform and for each place
of a list. Whole numbers are floats there, which are exact up to 2^24.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from msgspec import Struct

from ..game import DEPTH, NORMAL, PICTURE
from ..shipped_files import read_shipped_text
from ..slang.hlsl import HlslProgram, HlslUniform

MAX_ROWS = 1023
"""Rows of a list of vectors that Unity gives to a shader (Unity's manual of MaterialPropertyBlock.SetVectorArray)."""

OWN_PASSES = (f"take_{PICTURE}", f"take_{DEPTH}", f"take_{NORMAL}", "show", "copy")
"""The passes before those of the look: they take what Unity gives, and show the look. The script has their numbers."""

_CHANNELS = "xyzw"


class ShaderPass(Struct, frozen=True):
    """A pass of the shader, with where its program reads what it is given."""

    text: str
    rows: Mapping[str, int]
    """The first row of each uniform, by the name that it has in the package."""
    groups: Mapping[str, int]
    """The numbers of a uniform in each of its rows."""
    count: int
    """The number of rows of all uniforms together."""
    pictures: Mapping[str, str]
    """The property of each picture and table, by the name that it has in the package."""


def write_program(program: HlslProgram, lengths: Mapping[str, int]) -> ShaderPass:
    """The pass of a program. `lengths` are the numbers that lists are given at most, by name. Raises ValueError."""
    rows: dict[str, int] = {}
    groups: dict[str, int] = {}
    lines: list[str] = []
    count = 0
    for uniform in program.uniforms:
        rows[uniform.own_name], groups[uniform.own_name] = count, uniform.group
        lines.append(_write_uniform(uniform, count))
        given = -(-lengths.get(uniform.own_name, 0) // uniform.group)
        count += max(min(given, uniform.count), 1) if uniform.count else 1
    if count > MAX_ROWS:
        raise ValueError(f"it is given {count} vectors, and Unity gives {MAX_ROWS} at most")
    pictures = {name: f"_{name[0].upper()}{name[1:]}" for name in program.dimensions}
    declared = [f"float4 _Numbers[{count}];"] if count else []
    declared += [line for name in program.dimensions for line in _write_picture(program, name, pictures[name])]
    text = "\n".join([*declared, *lines, program.text.replace("main(", "Draw(")])
    return ShaderPass(text, rows, groups, count, pictures)


def write_shader(name: str, passes: Sequence[ShaderPass], head: str) -> str:
    """The file of the shader: first the passes that take and show pictures, then the programs of the look."""
    texts = [(mark, read_shipped_text(f"unity_{'show' if mark in _SAMPLED else mark}.hlsl")) for mark in OWN_PASSES]
    texts += [(f"program {number}", each.text) for number, each in enumerate(passes)]
    lines = [
        head,
        f'Shader "Hidden/Halation/{name}"',
        "{",
        "SubShader",
        "{",
        'Tags { "RenderPipeline" = "UniversalPipeline" }',
        "Cull Off ZTest Always ZWrite Off Blend Off",
        "HLSLINCLUDE",
        read_shipped_text("unity_cover.hlsl").rstrip(),
        "ENDHLSL",
    ]
    for mark, text in texts:
        lines += [f'Pass {{ Name "{mark}"', "HLSLPROGRAM", text.rstrip(), "ENDHLSL", "}"]
    return "\n".join([*lines, "}", "}", ""])


_SAMPLED = (f"take_{PICTURE}", "show")
"""Both sample a picture upside down: Unity's first row is the lowest one, ours the highest."""


def _write_uniform(uniform: HlslUniform, row: int) -> str:
    """The function that reads a uniform."""
    place, head = (f"{row} + at", "int at") if uniform.count else (str(row), "")
    value = f"_Numbers[{place}].{_CHANNELS[: uniform.width]}"
    value = value if uniform.base == "float" else f"{uniform.type}(round({value}))"
    return f"{uniform.type} given_{uniform.name}({head}) {{ return {value}; }}"


def _write_picture(program: HlslProgram, name: str, own: str) -> list[str]:
    """The declarations of a picture or a table, and the functions that read it. Tables bring their ways of sampling."""
    size = program.dimensions[name]
    lines = [f"Texture{size}D<float4> {own};"]
    if name in program.pictures:
        place = f"int{size + 1}"
        lines.append(f"float4 fetch_{name}({place} place) {{ return {own}.Load(place); }}")
    if name in program.tables:
        lines.append(f"SamplerState sampler{own};")
        lines.append(
            f"float4 sample_{name}(float{size} place, float level) "
            f"{{ return {own}.SampleLevel(sampler{own}, place, level); }}"
        )
    return lines
