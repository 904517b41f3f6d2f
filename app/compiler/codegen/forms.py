"""Writes the entry points of compute passes, whose invocations make one pixel, or several that share what they read.

Most of the time of a pass is loads. If an invocation makes several pixels of a function that reads neighbors, these
need many of the same texels; the driver's compiler sees that their positions are equal, and loads them once. A
convolution is written so that each texel is loaded once and added to all pixels.
"""

from __future__ import annotations

from collections.abc import Sequence

from halation.nodes import Size, glsl_type

from ..ir import Convolve
from . import bodies
from .names import ShaderNames
from .pass_parts import PassContext

LOCAL_SIZE = 64
"""Invocations of a work group, side by side in a row, whichever way the pixels lie that each one makes: on the software
rasterizer a group across rows would take twice as long to convolve them. 64 is a multiple of the width at which all
common GPUs execute (32 at NVIDIA, 32 or 64 at AMD); a smaller group would leave lanes idle."""

ROWS = 2
"""Pixels of a column that one invocation makes. On the software rasterizer four are a tenth faster, but take the driver
much longer to compile."""

BLOCK = 8
"""Work groups side by side whose columns are convolved before those of the next block, so that rows which the strip
above has read are still in the cache. 8 groups are 512 pixels, 8 KiB in a row of RGBA floats; the 65 rows of a long
strip take half a MiB, which fits into the second cache of a processor core. Chosen by this estimate."""


def count_rows(context: PassContext) -> int:
    """How many pixels of a column an invocation of a compute pass makes. Functions with loops share no loads.

    If several functions read neighbors, their texels do not fit into registers, and two rows would gain nothing. On
    small pictures the time to compile counts most, and one row takes three quarters of it.
    """
    if context.is_small:
        return 1
    gathers = sum(bool(op.files) and not op.is_pointwise and op.is_inlinable for op in context.members)
    return ROWS if gathers < 2 and all(op.is_straight(context.library) for op in context.members) else 1


def count_groups(convolve: Convolve | None, count: int, size: Size) -> tuple[int, int, int]:
    """Work groups that cover a picture: side by side in a block, below each other, and the number of blocks."""
    axis = convolve.axis if convolve else 1
    across, down = (-(-size[0] // count), size[1]) if axis == 0 else (size[0], -(-size[1] // count))
    groups = -(-across // LOCAL_SIZE)
    block = groups if convolve is None or axis == 0 else min(groups, BLOCK)
    return (block, down, -(-groups // block))


def write_main(
    names: ShaderNames, count: int, convolve: Convolve | None, body: Sequence[str], texels: Sequence[str]
) -> list[str]:
    """The entry point of a compute pass.

    Pixels beyond the edges are computed and not stored. If invocations returned before, the software rasterizer would
    mask every instruction, which is a tenth slower and takes a sixth longer to compile.

    `body` are the statements that compute one pixel, `texels` the expressions that are stored. With a convolution, its
    value at the pixel is called `convolved`, and pixels follow each other along its axis.
    """
    lines = [
        "void main() {",
        "uint across = (gl_WorkGroupID.z * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x"
        " + gl_LocalInvocationID.x;",
        f"ivec2 first = ivec2(across, gl_WorkGroupID.y + first_row) * {_write_spacing(count, convolve)};",
        *([f"first += {names.start};"] if names.start else []),
        "pixel = first; extent = grid;",
    ]
    at, start = (f"{name} - {names.start}" if names.start else name for name in ("pixel", "first"))
    condition = f"if (all(lessThan({start}, {names.room}))) {{"
    if count == 1:
        stores = (f"imageStore(o{number}, {at}, {name});" for number, name in enumerate(name_results(texels)))
        return [*lines, *body, *write_results(texels), condition, *stores, "}", "}"]
    results = name_results(texels)
    step = "pixel += along;" if convolve else "++pixel.y;"
    arguments = [f"{glsl_type(names.program.shape(convolve.image).channels)} convolved"] if convolve else []
    pixel_function = [
        f"void made({', '.join([*arguments, *(f'precise out vec4 {name}' for name in results)])}) {{",
        *body,
        *(f"{name} = {texel};" for name, texel in zip(results, texels, strict=True)),
        "}",
    ]
    if convolve:
        lines += bodies.write_strip(names, convolve, count)
    for k in range(count):
        texel_names = [f"{name}_{k}" for name in results]
        convolved_argument = [f"s{k}"] if convolve else []
        lines.append(f"precise vec4 {', '.join(texel_names)};")
        lines.append(f"made({', '.join([*convolved_argument, *texel_names])}); {step}")
    lines += ["pixel = first;", condition]
    # All reads before all writes: only then are they known to read the same.
    for k in range(count):
        stores = (f"imageStore(o{number}, {at}, {name}_{k});" for number, name in enumerate(results))
        lines.append(f"{' '.join(stores)} {step}")
    return [*pixel_function, *lines, "}", "}"]


def write_results(texels: Sequence[str]) -> list[str]:
    """Statements that compute what is stored.

    It is precise, and so is by the rules of GLSL all that it is computed from. Otherwise drivers change the order of
    sums where it saves an instruction, which depends on what else is in the program: a node would make other pixels
    fused with its neighbors than in a pass of its own. Functions of nodes need no `precise` of their own.
    """
    return [f"precise vec4 {name} = {texel};" for name, texel in zip(name_results(texels), texels, strict=True)]


def name_results(texels: Sequence[str]) -> list[str]:
    """The names of what is stored."""
    return [f"texel{number}" for number in range(len(texels))]


def _write_spacing(count: int, convolve: Convolve | None) -> str:
    """The distance of invocations that lie side by side, and below each other. Both axes of a convolution share a
    program."""
    return f"(1 + along * {count - 1})" if convolve else f"ivec2(1, {count})"
