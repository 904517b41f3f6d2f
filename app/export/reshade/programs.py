"""Writes a pass of a package as functions of an effect: its numbers, its pictures and its program."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ..engine_text import write_float
from ..package.curves import Record
from ..slang.hlsl import HlslProgram, HlslUniform
from .numbers import Array, NumberPicture
from .pictures import PackedPictures

_CHANNELS = "xyzw"


def write_pass(
    program: HlslProgram, record: Record, samplers: list[str], numbers: NumberPicture, tables: Mapping[str, str]
) -> list[str]:
    """The functions of one pass; `draw` is the one of the pixels.

    `samplers` are the names for `t0`, `t1`, ...; `tables` gives the function that samples a table.
    """
    lines: list[str] = []
    for uniform in program.uniforms:
        name = uniform.own_name
        slot = record["weights"] if name == "weights" and "weights" in record else record["uniforms"].get(name)
        lines += _write_uniform(uniform, slot, numbers)
    for name in program.pictures:
        if name in tables:
            lines.append(f"float4 fetch_{name}(int3 place) {{ return {tables[name]}_at(place.xy); }}")
        else:
            sampler = samplers[int(name.removeprefix("t"))]
            lines.append(f"float4 fetch_{name}(int3 place) {{ return FETCH({sampler}, place.x, place.y); }}")
    lines += [line for name in program.tables for line in _write_table_call(name, tables[name])]
    return [*lines, program.text]


def write_table(record: Record, values: Array, pictures: PackedPictures, number: int) -> tuple[str, list[str]]:
    """The name of a function that samples a table of a color library as a texture unit does, and its lines."""
    *depths, height, width, channels = record["shape"]
    depth = depths[0] if depths else 1
    stored = pictures.add(values.reshape(depth * height, width, channels))
    name, is_linear = f"table_{number}", record["linear"]
    texture = f"Table{number}"
    lines = [
        f"texture2D {texture} {{ Width = {width}; Height = {depth * height}; Format = RGBA32F; }};",
        f"sampler2D {texture}Sampler {{ Texture = {texture}; MinFilter = POINT; MagFilter = POINT; "
        "MipFilter = POINT; };",
        f"float4 draw_{name}(float4 position : SV_Position) : SV_Target {{ return {stored}(int2(position.xy)); }}",
        f"float4 {name}_at(int2 place) {{ return FETCH({texture}Sampler, place.x, place.y); }}",
    ]
    size = f"float3({width}.0, {height}.0, {depth}.0)"
    lines.append(f"float4 {name}(float3 place) {{")
    if is_linear:
        lines += [
            f"    float3 at = clamp(place * {size} - 0.5, 0.0, {size} - 1.0), low = floor(at), part = at - low;",
            f"    int3 a = int3(low), b = min(a + 1, int3({width - 1}, {height - 1}, {depth - 1}));",
            *(_write_layer(name, z, height) for z in "ab"),
            "    return lerp(layer_a, layer_b, part.z);",
        ]
    else:
        lines += [
            f"    int3 a = int3(clamp(floor(place * {size}), 0.0, {size} - 1.0));",
            f"    return {name}_at(int2(a.x, a.z * {height} + a.y));",
        ]
    return name, [*lines, "}"]


def _write_layer(name: str, z: str, height: int) -> str:
    corner = f"{name}_at(int2({{}}.x, {z}.z * {height} + {{}}.y))"
    rows = [f"lerp({corner.format('a', y)}, {corner.format('b', y)}, part.x)" for y in "ab"]
    return f"    float4 layer_{z} = lerp({rows[0]}, {rows[1]}, part.y);"


def _write_table_call(name: str, table: str) -> list[str]:
    return [
        f"float4 sample_{name}(float3 place, float level) {{ return {table}(place); }}",
        f"float4 sample_{name}(float2 place, float level) {{ return {table}(float3(place, 0.5)); }}",
    ]


def _write_uniform(uniform: HlslUniform, slot: int | None, numbers: NumberPicture) -> list[str]:
    name, type_ = f"given_{uniform.name}", uniform.type
    group = uniform.group
    if slot is not None and numbers.changes(slot):
        first = numbers.add_slot(slot, group)
        place, head = (f"{first} + at", "int at") if uniform.count else (str(first), "")
        channels = _CHANNELS[: uniform.width] if uniform.width < 4 else ""
        read = f"number({place}){'.' if channels else ''}{channels}"
        value = read if uniform.base == "float" else f"{type_}({read})"
        return [f"{type_} {name}({head}) {{ return {value}; }}"]
    known = numbers.find_numbers(slot) if slot is not None else np.zeros(uniform.width)
    if not uniform.count:
        return [f"{type_} {name}() {{ return {_write_value(uniform, known)}; }}"]
    count = max(min(math.ceil(len(known) / group), uniform.count), 1)
    rows = [_write_value(uniform, known[at * group : (at + 1) * group]) for at in range(count)]
    return [
        f"static const {type_} list_{uniform.name}[{count}] = {{ {', '.join(rows)} }};",
        f"{type_} {name}(int at) {{ return list_{uniform.name}[at]; }}",
    ]


def _write_value(uniform: HlslUniform, numbers: Array) -> str:
    padded = np.pad(numbers[: uniform.width], (0, max(uniform.width - len(numbers), 0)))
    end = "u" if uniform.base == "uint" else ""
    parts = [write_float(number) if uniform.base == "float" else f"{round(number)}{end}" for number in padded.tolist()]
    return f"{uniform.type}({', '.join(parts)})" if uniform.width > 1 else parts[0]
