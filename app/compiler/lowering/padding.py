"""Adds pixels around a picture, by its edge mode, or cuts them off."""

from __future__ import annotations

from halation.nodes import Edge

from ..areas import Neighborhood
from ..ir import Accessor, Builder, Gather, Parameter, PictureShape, Ref, UniformConstant
from ..library import Library

PAD = ("primitive/pad", "pad")
"""The function that reads a picture at an offset."""


def pad(builder: Builder, library: Library, owner: str, image: Ref, margin: tuple[int, int], edge: Edge) -> Ref:
    """The picture with `margin` more pixels on the left and right, and above and below; below 0 they are cut off."""
    shape = builder.shape(image)
    size = (shape.size[0] + 2 * margin[0], shape.size[1] + 2 * margin[1])
    offset = (1.0, 0.0, -float(margin[0]), 0.0, 1.0, -float(margin[1]))
    return builder.add(
        Gather(
            (PictureShape(size, shape.channels, shape.data),),
            owner,
            *PAD,
            (Parameter("vec2", UniformConstant((float(margin[0]), float(margin[1])))),),
            accessors=(Accessor("image", "vec4", image, Neighborhood(offset, (0.0, 0.0))),),
            edge=edge,
            light=library.is_light(*PAD, owner),
        )
    )
