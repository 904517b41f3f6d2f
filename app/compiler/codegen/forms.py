"""What one invocation of a compute pass makes: a pixel, or several in a row that share what they read.

Loads are what a pass costs. Several pixels of a function that looks around are written one after another: neighbors
want the same texels, at places that the driver's compiler can tell are the same, and it reads them once. A convolution
is written so that each texel is read once and goes to all pixels at once.
"""

from __future__ import annotations

from collections.abc import Sequence

from halation.nodes import Size, glsl_type

from ..ir import Convolve
from . import bodies
from .names import ShaderNames
from .pass_parts import PassContext

LOCAL_SIZE = 64
"""Invocations of a work group: neighbors across the row of pixels that each makes."""

ROWS = 2
"""Pixels of a column that one invocation makes. Four would be a tenth faster, and take the driver long to compile."""

BLOCK = 8
"""Work groups side by side whose columns are convolved before those of the next block: what a strip reads again of the
rows that the one above it has read is then still in the nearest cache.
"""


def count_rows(context: PassContext) -> int:
    """How many pixels of a column an invocation of a compute pass makes. Functions with loops share nothing.

    Where several functions look around, what two rows share is lost again, since so much does not fit into registers.
    """
    gathers = sum(bool(op.files) and not op.is_pointwise and op.is_inlinable for op in context.members)
    return ROWS if gathers < 2 and all(op.is_straight(context.library) for op in context.members) else 1


def count_groups(convolve: Convolve | None, count: int, size: Size) -> tuple[int, int, int]:
    """Work groups that cover a picture: side by side across the rows of pixels, along them, and blocks of those."""
    axis = convolve.axis if convolve else 1
    along, across = -(-size[axis] // count), -(-size[1 - axis] // LOCAL_SIZE)
    block = across if convolve is None else min(across, BLOCK) if axis == 1 else 1
    return (block, along, -(-across // block))


def write_main(
    names: ShaderNames, count: int, convolve: Convolve | None, body: Sequence[str], texels: Sequence[str]
) -> list[str]:
    """The entry point of a compute pass.

    What is made beyond the edges is stored nowhere. To leave before it is made would have the software rasterizer mask
    everything, which is a tenth slower and takes a sixth longer to compile.

    `body` are the statements that make one pixel, `texels` what is stored of it. With a convolution, its value of that
    pixel is called `convolved`, and pixels are made `along` its axis.
    """
    lines = [
        "void main() {",
        "uint across = (gl_WorkGroupID.z * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x"
        " + gl_LocalInvocationID.x;",
        f"ivec2 first = {_write_place(f'int(gl_WorkGroupID.y + first_row) * {count}', 'int(across)', convolve)};",
        *([f"first += {names.start};"] if names.start else []),
        "pixel = first; extent = grid;",
    ]
    at, start = (f"{name} - {names.start}" if names.start else name for name in ("pixel", "first"))
    condition = f"if (all(lessThan({start}, {names.room}))) {{"
    if count == 1:
        stores = (f"imageStore(o{number}, {at}, {texel});" for number, texel in enumerate(texels))
        return [*lines, *body, condition, *stores, "}", "}"]
    results = [f"texel{number}" for number in range(len(texels))]
    step = "pixel += along;" if convolve else "++pixel.y;"
    arguments = [f"{glsl_type(names.shape(convolve.image).channels)} convolved"] if convolve else []
    pixel_function = [
        f"void made({', '.join([*arguments, *(f'out vec4 {name}' for name in results)])}) {{",
        *body,
        *(f"{name} = {texel};" for name, texel in zip(results, texels, strict=True)),
        "}",
    ]
    if convolve:
        lines += bodies.write_strip(names, convolve, count)
    for k in range(count):
        texel_names = [f"{name}_{k}" for name in results]
        convolved_argument = [f"s{k}"] if convolve else []
        lines.append(f"vec4 {', '.join(texel_names)}; made({', '.join([*convolved_argument, *texel_names])}); {step}")
    lines += ["pixel = first;", condition]
    # All reads before all writes: only then are they known to read the same.
    for k in range(count):
        stores = (f"imageStore(o{number}, {at}, {name}_{k});" for number, name in enumerate(results))
        lines.append(f"{' '.join(stores)} {step}")
    return [*pixel_function, *lines, "}", "}"]


def _write_place(along: str, across: str, convolve: Convolve | None) -> str:
    """A pixel by where it is along its row of pixels, and across; both axes of a convolution share a program."""
    return f"along * ({along}) + along.yx * {across}" if convolve else f"ivec2({across}, {along})"
