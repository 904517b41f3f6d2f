"""The texts of passes that read more than their own pixel: accessors, convolutions, reductions."""

from __future__ import annotations

from ...nodes import Edge, glsl_type
from .ir import BLOCK, Accessor, Convolve, Reduce, Ref
from .names import Names

OUTPUTS = 8
"""Pixels that one invocation of a sliding convolution makes: each pixel read is used for all of them."""

MAX_WEIGHTS = 4096
"""Floats in the uniform block: GL promises 16 KB."""

MAX_TAPS = MAX_WEIGHTS - 2 * OUTPUTS + 1
"""Weights of a convolution: an odd number that leaves room for the zeros past the last one."""


def accessor(names: Names, item: Accessor, edge: Edge) -> list[str]:
    """`<name>_size`, `<name>_raw`, `<name>_at` and `<name>_near` for one picture."""
    name, glsl = item.name, item.glsl
    if isinstance(item.operand, Ref):
        size = names.shape(item.operand).size
        names.uniform("ivec2", size, f"{name}_size")
        if edge == "black":
            value = names.converted(item.operand, f"edge_clamp(p, {name}_size)", glsl)
            value = f"inside(p, {name}_size) ? {value} : {glsl}(0.0)"
        else:
            value = names.converted(item.operand, f"edge_{edge}(p, {name}_size)", glsl)
    else:
        names.uniform("ivec2", (1, 1), f"{name}_size")
        value = names.constant(item.operand, glsl)
    return [
        f"{glsl} {name}_raw(ivec2 p) {{ return {value}; }}",
        f"{glsl} {name}_at(ivec2 p) {{ {glsl} c = {name}_raw(p); return is_hole(c) ? {glsl}(0.0) : c; }}",
        f"{glsl} {name}_near(vec2 p) {{",
        "    p = clamp(p, -16777216.0, 16777216.0) - 0.5;",
        "    vec2 corner = floor(p), t = p - corner;",
        "    ivec2 q = ivec2(corner);",
        f"    {glsl} above = mix({name}_at(q), {name}_at(q + ivec2(1, 0)), t.x);",
        f"    {glsl} below = mix({name}_at(q + ivec2(0, 1)), {name}_at(q + ivec2(1, 1)), t.x);",
        "    return mix(above, below, t.y);",
        "}",
    ]


def convolved_accessor(names: Names, root: Convolve) -> list[str]:
    """The accessor and the uniforms that both forms of a convolution share."""
    names.uniform("ivec2", (1, 0) if root.axis == 0 else (0, 1), "along")
    names.uniform("int", root.origin, "origin")
    names.uniform("int", len(root.weights), "taps")
    glsl = glsl_type(names.shape(root.image).channels)
    block = f"layout(std140) uniform Weights {{ vec4 weights[{MAX_WEIGHTS // 4}]; }};"
    return [block, *accessor(names, Accessor("image", glsl, root.image), root.edge)]


def convolution(names: Names, root: Convolve) -> list[str]:
    """One pixel per invocation, any stride."""
    glsl = glsl_type(names.shape(root.image).channels)
    stride = names.uniform("int", root.stride, "stride")
    return [
        f"{glsl} convolved() {{",
        f"    ivec2 p = pixel + along * (pixel * ({stride} - 1) + origin);",
        f"    {glsl} sum = {glsl}(0.0);",
        "    for (int j = 0; j < taps; ++j, p += along) sum += weights[j >> 2][j & 3] * image_at(p);",
        "    return sum;",
        "}",
    ]


def sliding(names: Names, root: Convolve, stores: list[str]) -> list[str]:
    """A main that makes OUTPUTS pixels in a row: every pixel is read once and slides past all their weights.

    Tap j adds weight j - k to pixel k; the last OUTPUTS weights stay in registers, used in turn. Terms are added in
    the order of a plain loop, so both forms give the same bits.
    """
    glsl = glsl_type(names.shape(root.image).channels)
    lines = [
        "void main() {",
        "    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);",
        f"    ivec2 first = at.x * along.yx + at.y * {OUTPUTS} * along;",
        "    if (any(greaterThanEqual(first, grid))) return;",
        "    ivec2 p = first + along * origin;",
        f"    {glsl} t, {', '.join(f's{k} = {glsl}(0.0)' for k in range(OUTPUTS))};",
        f"    float {', '.join(f'w{k} = 0.0' for k in range(OUTPUTS))};",
        "    vec4 four;",
        f"    for (int j = 0; j < taps + {OUTPUTS - 1}; j += {OUTPUTS}) {{",
    ]
    for tap in range(OUTPUTS):
        if tap % 4 == 0:
            lines.append(f"        four = weights[(j >> 2) + {tap // 4}];")
        lines.append(f"        w{tap} = four.{'xyzw'[tap % 4]}; t = image_at(p); p += along;")
        lines.append("        " + " ".join(f"s{k} += w{(tap - k) % OUTPUTS} * t;" for k in range(OUTPUTS)))
    lines += ["    }", "    pixel = first;"]
    lines += [f"    if (all(lessThan(pixel, grid))) {{ {text} }} pixel += along;" for text in stores]
    return [*lines, "}"]


def padded_weights(root: Convolve, slides: bool) -> tuple[float, ...]:
    """The uniform block's contents: a sliding convolution runs past the last weight, where zeros must lie."""
    count = len(root.weights)
    if slides:
        count = -(-(count + OUTPUTS - 1) // OUTPUTS) * OUTPUTS
    return root.weights + (0.0,) * (-(-count // 4) * 4 - len(root.weights))


def source(names: Names, root: Reduce, body: list[str], value: str) -> list[str]:
    """`source_at`: a pixel of what is reduced, computed on the spot where its producers joined the pass."""
    shape = names.shape(root.image)
    names.uniform("ivec2", shape.size, "source_size")
    return [
        f"{glsl_type(shape.channels)} source_at(ivec2 p) {{",
        "pixel = p; extent = source_size;", *body, f"return {value};", "}",
    ]


def reduction(names: Names, root: Reduce) -> list[str]:
    """Every invocation folds one block; the blocks at the far edges are smaller."""
    glsl = glsl_type(names.shape(root.image).channels)
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
