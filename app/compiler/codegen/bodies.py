"""Writes the GLSL of passes that read more than their own pixel: accessors, convolutions, reductions."""

from __future__ import annotations

from collections.abc import Set

from halation.nodes import glsl_type

from ..ir import BLOCK, MAX_WEIGHTS, Accessor, Convolve, Gather, Reduce, Ref
from .names import ShaderNames

LONG_STRIP = 8
"""Pixels that one invocation of a long convolution makes; each texel is loaded once for all of them. Eight RGBA sums
and their weights take 40 registers. More would exceed those of a processor, and fewer load texels more often."""

SHORT_STRIP = 4
"""The same for a short convolution, whose taps are written out. Eight are hardly faster, and the text, which the driver
must compile, is twice as long."""

UNROLLED_TAPS = (9, 17, 25, 33)
"""Lengths of convolutions that are written out without a loop; a shorter one is padded with zeros to the next of these,
so that a slider for sigma compiles four programs at most. Longer ones take the driver too long to compile."""

SMALL_PIXELS = 2**18
"""Pictures up to so many pixels, 512x512, have passes that compile fast: convolutions in loops, one pixel for each
invocation of others. Compiling more takes longer than it saves on them. Chosen by judgement."""


def write_accessor(
    names: ShaderNames, reader: Convolve | Gather, item: Accessor, used_words: Set[str] = frozenset()
) -> list[str]:
    """`<name>_size`, `<name>_raw`, `<name>_at` and `<name>_near` for one picture; `<name>_has` if that word is used.

    Places are limited to 2^24, up to which floats count single pixels: GLSL leaves open what a larger float is as an
    int. Means take no number that is too large to be added up, so that what reads them needs no test for holes.
    """
    name, glsl, edge, has, has_no_holes = item.name, item.glsl, reader.edge, "true", False
    if isinstance(item.operand, Ref):
        has_no_holes = names.program.has_no_holes(reader, item.operand, names.by_image)
        names.uniform("ivec2", names.program.shape(item.operand).size, f"{name}_size")
        extent, has = names.program.extents.get(item.operand), f"inside(p, {name}_size)"
        if extent and edge in ("clamp", "black"):
            first = names.uniform("ivec2", extent.start, f"{name}_first")
            room = names.uniform("ivec2", extent.size, f"{name}_room")
            value = names.load_as(item.operand, f"edge_clamp(p - {first}, {room}) + {first}", glsl)
            has = f"inside(p - {first}, {room})"
            value = f"{has} ? {value} : {glsl}(0.0)" if edge == "black" else value
        elif edge == "black":
            value = names.load_as(item.operand, f"edge_clamp(p, {name}_size)", glsl)
            value = f"inside(p, {name}_size) ? {value} : {glsl}(0.0)"
        else:
            value = names.load_as(item.operand, f"edge_{edge}(p, {name}_size)", glsl)
    else:
        names.uniform("ivec2", (1, 1), f"{name}_size")
        value = names.constant(item.operand, glsl)
    test = "is_too_large" if reader.averages else "is_hole"
    return [
        *([f"bool {name}_has(ivec2 p) {{ return {has}; }}"] if f"{name}_has" in used_words else []),
        f"{glsl} {name}_raw(ivec2 p) {{ return {value}; }}",
        f"{glsl} {name}_at(ivec2 p) {{ return {name}_raw(p); }}"
        if has_no_holes
        else f"{glsl} {name}_at(ivec2 p) {{ {glsl} c = {name}_raw(p); return {test}(c) ? {glsl}(0.0) : c; }}",
        f"{glsl} {name}_near(vec2 p) {{",
        "    p = clamp(p, -16777216.0, 16777216.0) - 0.5;",
        "    vec2 corner = floor(p), t = p - corner;",
        "    ivec2 q = ivec2(corner);",
        f"    {glsl} above = mix({name}_at(q), {name}_at(q + ivec2(1, 0)), t.x);",
        f"    {glsl} below = mix({name}_at(q + ivec2(0, 1)), {name}_at(q + ivec2(1, 1)), t.x);",
        "    return mix(above, below, t.y);",
        "}",
    ]


def write_convolution_accessor(names: ShaderNames, op: Convolve, is_strip: bool) -> list[str]:
    """Declare the accessor, the weights and the uniforms that all forms of a convolution share."""
    names.uniform("ivec2", (1, 0) if op.axis == 0 else (0, 1), "along")
    names.uniform("int", op.origin, "origin")
    if not (is_strip and is_unrolled(op)):
        names.uniform("int", len(op.weights), "taps")
    glsl = glsl_type(names.program.shape(op.image).channels)
    block = f"layout(std140) uniform Weights {{ vec4 weights[{MAX_WEIGHTS // 4}]; }};"
    return [block, *write_accessor(names, op, Accessor("image", glsl, op.image))]


def write_convolution(names: ShaderNames, op: Convolve) -> list[str]:
    """`convolution`, one pixel of it, for fragment passes."""
    loop = ["    for (int j = 0; j < taps; ++j, p += along) sum += weights[j >> 2][j & 3] * image_at(p);"]
    return _write_sum_of_taps(names, op, loop)


def write_small_decimation(names: ShaderNames, op: Convolve) -> list[str]:
    """`convolution`, one pixel of it, for compute passes: four taps at a time share a read of weights."""
    loop = [
        "    for (int j = 0; j < taps; j += 4) {",
        "        vec4 four = weights[j >> 2];",
        *(f"        sum += four.{component} * image_at(p); p += along;" for component in "xyzw"),
        "    }",
    ]
    return _write_sum_of_taps(names, op, loop)


def _write_sum_of_taps(names: ShaderNames, op: Convolve, loop: list[str]) -> list[str]:
    """`convolution` around a loop that adds to `sum` and moves `p` along."""
    glsl = glsl_type(names.program.shape(op.image).channels)
    stride = names.uniform("int", op.stride, "stride")
    return [
        f"{glsl} convolution() {{",
        f"    ivec2 p = pixel + along * (pixel * ({stride} - 1) + origin);",
        f"    {glsl} sum = {glsl}(0.0);",
        *loop,
        "    return sum;",
        "}",
    ]


def is_unrolled(op: Convolve) -> bool:
    """Whether all taps are written out."""
    width, height = op.size
    return op.stride > 1 or (len(op.weights) <= UNROLLED_TAPS[-1] and width * height > SMALL_PIXELS)


def count_pixels(op: Convolve) -> int:
    """How many pixels one invocation makes. Neighbors of a decimation by four share few texels, so fewer there."""
    return LONG_STRIP if len(op.weights) > UNROLLED_TAPS[-1] else max(2 * SHORT_STRIP // max(op.stride, 2), 1)


def write_strip(names: ShaderNames, op: Convolve, count: int) -> list[str]:
    """Statements that make `s0`, `s1`..., the convolution at `count` pixels from `first` on.

    Every pixel is read once. Terms are added in the order of a plain loop, so all forms give the same bits.
    """
    glsl = glsl_type(names.program.shape(op.image).channels)
    lines = [
        f"ivec2 p = first + along * (first * {op.stride - 1} + origin);",
        f"{glsl} t, {', '.join(f's{k} = {glsl}(0.0)' for k in range(count))};",
    ]
    return lines + (_write_unrolled(op, count) if is_unrolled(op) else _write_sliding(count))


def _write_unrolled(op: Convolve, count: int) -> list[str]:
    """A convolution without a loop, with every weight in its place."""
    taps, lines = _count_unrolled_taps(op), list[str]()
    for tap in range((count - 1) * op.stride + taps):
        sums = [
            f"s{k} += weights[{number // 4}].{'xyzw'[number % 4]} * t;"
            for k in range(count)
            if 0 <= (number := tap - k * op.stride) < taps
        ]
        lines.append(f"t = image_at(p); p += along; {' '.join(sums)}")
    return lines


def _write_sliding(count: int) -> list[str]:
    """A convolution as a loop: texel j is added to pixel k with weight j - k. The last weights stay in registers."""
    lines = [
        f"float {', '.join(f'w{k} = 0.0' for k in range(count))};",
        "vec4 four;",
        f"for (int j = 0; j < taps + {count - 1}; j += {count}) {{",
    ]
    for tap in range(count):
        if tap % 4 == 0:
            lines.append(f"    four = weights[(j >> 2) + {tap // 4}];")
        lines.append(f"    w{tap} = four.{'xyzw'[tap % 4]}; t = image_at(p); p += along;")
        lines.append("    " + " ".join(f"s{k} += w{(tap - k) % count} * t;" for k in range(count)))
    return [*lines, "}"]


def _count_unrolled_taps(op: Convolve) -> int:
    """How many taps are written out: see `UNROLLED_TAPS`."""
    if op.stride > 1:
        return len(op.weights)
    return next(size for size in UNROLLED_TAPS if size >= len(op.weights))


def pad_weights(op: Convolve, form: str) -> tuple[float, ...]:
    """The contents of the uniform block, with zeros after the last weight, where strips read on."""
    count = len(op.weights)
    if form == "compute":
        count = _count_unrolled_taps(op) if is_unrolled(op) else -(-(count + LONG_STRIP - 1) // LONG_STRIP) * LONG_STRIP
    return op.weights + (0.0,) * (-(-count // 4) * 4 - len(op.weights))


def write_source(names: ShaderNames, root: Reduce, body: list[str], value: str) -> list[str]:
    """Write `source_at`: a pixel of the reduced picture, computed here if its producers joined the pass."""
    shape = names.program.shape(root.image)
    names.uniform("ivec2", shape.size, "source_size")
    return [
        f"{glsl_type(shape.channels)} source_at(ivec2 p) {{",
        "pixel = p; extent = source_size;",
        *body,
        f"return {value};",
        "}",
    ]


def write_reduction(names: ShaderNames, root: Reduce) -> list[str]:
    """Write the loop in which every invocation folds one block; blocks at the far edges are smaller."""
    glsl = glsl_type(names.program.shape(root.image).channels)
    fold = "result + c" if root.operation == "sum" else "max(result, c)"
    return [
        f"{glsl} reduced(ivec2 block) {{",
        f"    ivec2 first = block * {BLOCK}, end = min(first + {BLOCK}, source_size);",
        f"    {glsl} result = source_at(first);",
        "    for (int y = first.y; y < end.y; ++y)",
        "        for (int x = first.x; x < end.x; ++x) {",
        "            if (x == first.x && y == first.y) continue;",
        f"            {glsl} c = source_at(ivec2(x, y));",
        f"            result = {fold};",
        "        }",
        "    pixel = block; extent = grid;",
        "    return result;",
        "}",
    ]
