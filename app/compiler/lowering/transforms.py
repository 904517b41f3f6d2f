"""Joins chains of transforms: pixels are filtered once, through the product of the matrices.

The second of two transforms reads the picture that the first one read, through the product. So the picture is not
softened twice, and what the first one moved out of the frame can come back. That holds where both have the same edge
mode; with another one, the edge of the frame between them is visible and must be kept. The last kernel is used for all.
"""

from __future__ import annotations

import math
from typing import get_args

from halation.nodes import Affine, Edge, Kernel

from ..areas import Neighborhood
from ..ir import Accessor, Builder, Choice, Parameter, PictureShape, Placement, Ref, UniformConstant

STILL_TOLERANCE = 1e-9
"""How far, in widths of the picture, a matrix may move pixels and still count as none. A transform and its inverse
leave about 1e-15 in doubles; a millionth of a pixel in 8192 pixels is 1e-10, which nobody sees."""


_LOBES = {"nearest": 0.0, "triangle": 1.0, "catmull-rom": 2.0, "mitchell": 2.0, "lanczos": 3.0}
_WIDEST = 32.0
"""How far each kernel reaches in pixels, and how many times as far at most where it shrinks a picture: the same numbers
as in primitive/place.glsl, because tiles must hold all pixels that the shader reads."""

_ROUNDING = 1.0
"""Pixels by which a position in 32-bit floats may be off. At 32768 pixels their spacing is 1/256, and a matrix adds
three roundings; a whole pixel is more than enough."""


def place(
    builder: Builder, image: Ref, owner: str, shape: PictureShape, matrix: Affine, kernel: Kernel, edge: Edge
) -> Ref:
    """Place `image`, or what it was placed from, into a picture of `shape`.

    The first of two transforms is left in the program: other nodes may read it. If none does, it is never drawn.
    """
    chain, before = (owner,), builder.inspect(image)
    if isinstance(before, Placement) and before.edge == edge:
        source = before.accessors[0].operand
        assert isinstance(source, Ref)
        image, matrix, chain = source, multiply(before.matrix, matrix), (*before.chain, owner)
    if shape == builder.shape(image) and is_still(matrix, shape):
        return image
    a, b, x, c, d, y = matrix
    kernels = get_args(Kernel)
    widths = (min(max(math.hypot(*row), 1.0), _WIDEST) for row in ((a, b), (c, d)))
    across, down = (_LOBES[kernel] * width + _ROUNDING for width in widths)
    parameters = (
        Parameter("vec2", UniformConstant((a, b))),
        Parameter("vec2", UniformConstant((c, d))),
        Parameter("vec2", UniformConstant((x, y))),
        Parameter("int", Choice(kernels.index(kernel))),
    )
    return builder.add(
        Placement(
            (shape,),
            owner,
            "primitive/place",
            "place",
            parameters,
            (("kernel", kernels),),
            accessors=(Accessor("image", "vec4", image, Neighborhood(matrix, (across, down))),),
            edge=edge,
            matrix=matrix,
            chain=chain,
        )
    )


def multiply(first: Affine, then: Affine) -> Affine:
    """The matrix of two transforms in a row. Matrices lead from output to input, so that of `first` is applied last."""
    a, b, x, c, d, y = first
    e, f, u, g, h, v = then
    return (a * e + b * g, a * f + b * h, a * u + b * v + x, c * e + d * g, c * f + d * h, c * u + d * v + y)


def is_still(matrix: Affine, shape: PictureShape) -> bool:
    """True if no pixel of the picture moves."""
    a, b, x, c, d, y = matrix
    width, height = shape.size
    corners = ((0, 0), (width, 0), (0, height))
    away = (abs(part) for i, j in corners for part in (a * i + b * j + x - i, c * i + d * j + y - j))
    return max(away) <= STILL_TOLERANCE * max(width, height)
