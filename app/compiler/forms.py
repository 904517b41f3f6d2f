"""What one invocation of a compute pass makes: a pixel, or several in a row that share what they read.

Loads are what a pass costs. Several pixels of a function that looks around are written one after another: neighbors
want the same texels, at places that the driver's compiler can tell are the same, and it reads them once. A convolution
is written so that each texel is read once and goes to all pixels at once.
"""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from ...nodes import Size, glsl_type
from . import bodies
from .fuse import Fused
from .ir import Call, Convolve, Gather, Program
from .names import Names

LOCAL_SIZE = 64
"""Invocations of a work group: neighbors across the row of pixels that each makes."""

ROWS = 4
"""Pixels of a column that one invocation makes: more would not fit into registers."""

BLOCK = 8
"""Work groups side by side whose columns are convolved before those of the next block: what a strip reads again of the
rows that the one above it has read is then still in the nearest cache.
"""


class Strip(Struct, frozen=True):
    """The pixels that one invocation makes: so many along an axis (0 is x), block after block if there are `blocks`."""

    axis: int = 1
    count: int = 1
    blocks: bool = False


SINGLE = Strip()


def strip_of(program: Program, fused: Fused) -> Strip:
    """How many pixels an invocation of a compute pass should make."""
    convolve = convolution_in(program, fused)
    if convolve is not None:
        return Strip(convolve.axis, bodies.OUTPUTS, blocks=convolve.axis == 1)
    ops = [program.ops[index] for index in fused.members]
    light = all(isinstance(op, Call) or (isinstance(op, Gather) and op.light) for op in ops)
    return Strip(1, ROWS) if light else SINGLE


def convolution_in(program: Program, fused: Fused) -> Convolve | None:
    """The convolution that is a member of a pass: there is one at most."""
    found = (op for op in (program.ops[index] for index in fused.members) if isinstance(op, Convolve))
    return next(found, None)


def groups(strip: Strip, size: Size) -> tuple[int, int, int]:
    """Work groups that cover a picture: all of the first axis run one after another, then those of the second."""
    width, height = size
    if strip.axis == 0:
        return (-(-width // strip.count), -(-height // LOCAL_SIZE), 1)
    across, down = -(-width // LOCAL_SIZE), -(-height // strip.count)
    return (min(across, BLOCK), down, -(-across // BLOCK)) if strip.blocks else (across, down, 1)


def main(
    names: Names, strip: Strip, convolve: Convolve | None, body: Sequence[str], texels: Sequence[str]
) -> list[str]:
    """The entry point of a compute pass.

    `body` are the statements that make one pixel, `texels` what is stored of it. With a convolution, its value of that
    pixel is called `convolved`.
    """
    at = f"pixel - {names.start}" if names.start else "pixel"
    lines = ["void main() {", *_first(names, strip), "pixel = first; extent = grid;"]
    if strip.count == 1:
        stores = (f"imageStore(o{number}, {at}, {texel});" for number, texel in enumerate(texels))
        return [*lines, *body, *stores, "}"]
    results = [f"r{number}" for number in range(len(texels))]
    step = f"pixel.{'xy'[strip.axis]} += 1;"
    of = [f"{glsl_type(names.shape(convolve.image).channels)} convolved"] if convolve else []
    made = [
        f"void made({', '.join([*of, *(f'out vec4 {name}' for name in results)])}) {{", *body,
        *(f"{name} = {texel};" for name, texel in zip(results, texels, strict=True)), "}",
    ]
    if convolve:
        lines += bodies.strip(names, convolve, strip.count)
    for k in range(strip.count):
        own = [f"{name}_{k}" for name in results]
        given = [f"s{k}"] if convolve else []
        lines.append(f"vec4 {', '.join(own)}; made({', '.join([*given, *own])}); {step}")
    lines.append("pixel = first;")
    # All reads before all writes: only then are they known to read the same. What lies outside is stored nowhere.
    for k in range(strip.count):
        stores = (f"imageStore(o{number}, {at}, {name}_{k});" for number, name in enumerate(results))
        lines.append(f"{' '.join(stores)} {step}")
    return [*made, *lines, "}"]


def _first(names: Names, strip: Strip) -> list[str]:
    """The first pixel of an invocation. What it makes beyond the last row is stored nowhere."""
    if strip.axis == 0:
        along, across = "gl_WorkGroupID.x", "gl_WorkGroupID.y + first_row"
    else:
        block = f"gl_WorkGroupID.z * {BLOCK}u + " if strip.blocks else ""
        along, across = "gl_WorkGroupID.y + first_row", f"{block}gl_WorkGroupID.x"
    first = (f"({along}) * {strip.count}u", f"({across}) * {LOCAL_SIZE}u + gl_LocalInvocationID.x")
    lines = [
        f"ivec2 first = ivec2({', '.join(first if strip.axis == 0 else first[::-1])});",
        f"if (any(greaterThanEqual(first, {names.room}))) return;",
    ]
    return [*lines, f"first += {names.start};"] if names.start else lines
