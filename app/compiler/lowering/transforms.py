"""Transforms of transforms: pixels are filtered once, by the product of the matrices.

A transform of what another one made reads the picture that the other one read, through the product. So nothing is
softened twice, and what left the frame in between comes back: between the two there is no frame. That holds where both
have the same edge mode; another one says that the frame in between does matter. The last kernel is used for all.
"""

from __future__ import annotations

import math
from typing import get_args

from halation.nodes import Affine, Edge, Kernel

from ..areas import Neighborhood
from ..ir import Accessor, Builder, Choice, Parameter, PictureShape, Placement, Ref, UniformConstant

STILL_TOLERANCE = 1e-9
"""A product that moves no pixel farther than this is that of a transform and its inverse, but for rounding."""


_LOBES = {"nearest": 0.0, "triangle": 1.0, "catmull-rom": 2.0, "mitchell": 2.0, "lanczos": 3.0}
_WIDEST = 32.0
"""How far a kernel reaches, and how many times that at most: as in primitive/place.glsl."""

_ROUNDING = 1.0
"""Pixels by which a place may be off in floats of 32 bits."""


def place(
    builder: Builder, image: Ref, owner: str, shape: PictureShape, matrix: Affine, kernel: Kernel, edge: Edge
) -> Ref:
    """Place `image`, or what it was placed from, into a picture of `shape`."""
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
    """Where pixels placed by `first` and `then` lie: both lead backward, so the first one's comes last."""
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
