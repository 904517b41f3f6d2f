"""Transforms of transforms: pixels are filtered once, by the product of the matrices.

A transform of what another one made reads the picture that the other one read, through the product. So nothing is
softened twice, and what left the frame in between comes back: between the two there is no frame. That holds where both
have the same edge mode; another one says that the frame in between does matter. The last kernel is used for all.
"""

from __future__ import annotations

import math
from typing import ClassVar, get_args

from halation.nodes import Affine, Edge, Kernel

from ..areas import Around
from ..ir import Accessor, Builder, Choice, Constant, Gather, Parameter, Ref, Shape

STILL = 1e-9
"""A product that moves no pixel farther than this is that of a transform and its inverse, but for rounding."""


_LOBES = {"nearest": 0.0, "triangle": 1.0, "catmull-rom": 2.0, "mitchell": 2.0, "lanczos": 3.0}
_WIDEST = 32.0
"""How far a kernel reaches, and how many times that at most: as in primitive/place.glsl."""

_ROUNDING = 1.0
"""Pixels by which a place may be off in floats of 32 bits."""


class Placed(Gather, frozen=True):
    """A picture moved, turned and scaled. `matrix` says where its pixels lie in the one that it reads."""

    matrix: Affine = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    chain: tuple[str, ...] = ()
    """The nodes whose matrices were multiplied, the first one first."""

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"owner", "chain"})

    @property
    def owners(self) -> tuple[str, ...]:
        return self.chain

    @property
    def label(self) -> str:
        return f"{self.function} x {len(self.chain)}" if len(self.chain) > 1 else self.function


def place(builder: Builder, image: Ref, owner: str, shape: Shape, matrix: Affine, kernel: Kernel, edge: Edge) -> Ref:
    """Place `image`, or what it was placed from, into a picture of `shape`."""
    chain, before = (owner,), builder.op(image)
    if isinstance(before, Placed) and before.edge == edge:
        source = before.accessors[0].operand
        assert isinstance(source, Ref)
        image, matrix, chain = source, product(before.matrix, matrix), (*before.chain, owner)
    if shape == builder.shape(image) and is_still(matrix, shape):
        return image
    a, b, x, c, d, y = matrix
    kernels = get_args(Kernel)
    widths = (min(max(math.hypot(*row), 1.0), _WIDEST) for row in ((a, b), (c, d)))
    across, down = (_LOBES[kernel] * width + _ROUNDING for width in widths)
    parameters = (
        Parameter("vec2", Constant((a, b))),
        Parameter("vec2", Constant((c, d))),
        Parameter("vec2", Constant((x, y))),
        Parameter("int", Choice(kernels.index(kernel))),
    )
    return builder.add(
        Placed(
            (shape,),
            owner,
            "primitive/place",
            "place",
            (Accessor("image", "vec4", image, Around(matrix, (across, down))),),
            parameters,
            edge,
            (("kernel", kernels),),
            matrix=matrix,
            chain=chain,
        )
    )


def product(first: Affine, then: Affine) -> Affine:
    """Where pixels placed by `first` and `then` lie: both lead backward, so the first one's comes last."""
    a, b, x, c, d, y = first
    e, f, u, g, h, v = then
    return (a * e + b * g, a * f + b * h, a * u + b * v + x, c * e + d * g, c * f + d * h, c * u + d * v + y)


def is_still(matrix: Affine, shape: Shape) -> bool:
    """True if no pixel of the picture moves."""
    a, b, x, c, d, y = matrix
    width, height = shape.size
    corners = ((0, 0), (width, 0), (0, height))
    away = (abs(part) for i, j in corners for part in (a * i + b * j + x - i, c * i + d * j + y - j))
    return max(away) <= STILL * max(width, height)
