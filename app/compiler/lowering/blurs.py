"""Adds separable blurs: decimations, exact convolutions at the small size, enlargements.

`gaussian` plans each axis. Decimations come first, so that everything after works on fewer pixels. x comes before y,
and enlargements come in the opposite order.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from halation.nodes import Edge, Size

from ..areas import Neighborhood
from ..ir import Accessor, Builder, Convolve, Gather, Parameter, PictureShape, Ref, UniformConstant
from ..library import Library
from . import gaussian
from .padding import pad

ENLARGE = ("primitive/enlarge", "enlarge")
"""The function that enlarges a picture along an axis with a cubic B-spline."""


class BlurBuilder:
    """Adds blurs of one node to a program."""

    def __init__(self, builder: Builder, library: Library, owner: str) -> None:
        self._builder, self._library, self._owner = builder, library, owner

    def blur(self, image: Ref, axes: Sequence[gaussian.BlurAxis], edge: Edge) -> Ref:
        """Blur along x and y, as `axes` say.

        A decimated picture may extend beyond the edges of the full one, as far as the edge mode matters: `firsts` are
        the positions of its first pixels. A panorama is padded first: the other side of a pole is not at the same place
        in a picture that extends beyond its edges.
        """
        if edge == "panorama" and any(plan.steps for plan in axes):
            across, down = (plan.reach for plan in axes)
            padded = pad(self._builder, self._library, self._owner, image, (across, down), edge)
            blurred = self.blur(padded, axes, "clamp")
            return pad(self._builder, self._library, self._owner, blurred, (-across, -down), "clamp")
        picture, full = image, self._builder.shape(image).size
        firsts = [0, 0]
        spans = [gaussian.find_spans(plan, length, edge) for plan, length in zip(axes, full, strict=True)]
        for axis, plan in enumerate(axes):
            for step, (first, length) in zip(plan.steps, spans[axis][0], strict=True):
                weights, start = gaussian.decimation_weights(step)
                origin = first * step + start - firsts[axis]
                picture = self.convolve(picture, axis, weights, step, origin, edge, length)
                firsts[axis] = first
        for axis, plan in enumerate(axes):
            if plan.weights:
                length = self._builder.shape(picture).size[axis]
                origin = -(len(plan.weights) // 2)
                picture = self.convolve(picture, axis, plan.weights, 1, origin, spans[axis][1], length)
        for axis, plan in reversed(list(enumerate(axes))):
            if plan.factor > 1:
                apron = -firsts[axis] * plan.factor
                ends_as = None if edge == "black" else (image, axis)
                picture = self._enlarge(picture, axis, plan.factor, apron, full[axis], spans[axis][1], ends_as)
        return picture

    def convolve(
        self, image: Ref, axis: int, weights: tuple[float, ...], stride: int, origin: int, edge: Edge, length: int
    ) -> Ref:
        """Convolve along an axis; `length` is how many pixels that makes."""
        shape = self._resize(image, axis, length)
        averages = min(weights) >= 0.0 and math.isclose(sum(weights), 1.0, rel_tol=1e-3)
        return self._builder.add(Convolve((shape,), self._owner, image, axis, weights, stride, origin, edge, averages))

    def _enlarge(
        self,
        image: Ref,
        axis: int,
        factor: int,
        apron: int,
        length: int,
        edge: Edge,
        ends_as: tuple[Ref, int] | None,
    ) -> Ref:
        shape = self._resize(image, axis, length)
        scale, start = 1.0 / factor, apron / factor
        matrix = (scale, 0.0, start, 0.0, 1.0, 0.0) if axis == 0 else (1.0, 0.0, 0.0, 0.0, scale, start)
        around = Neighborhood(matrix, (2.0, 0.0) if axis == 0 else (0.0, 2.0))
        accessor = Accessor("image", "vec4", image, around)
        numbers = tuple(Parameter("int", UniformConstant(number)) for number in (axis, factor, apron))
        light = self._library.is_light(*ENLARGE, self._owner)
        return self._builder.add(
            Gather(
                (shape,),
                self._owner,
                *ENLARGE,
                numbers,
                accessors=(accessor,),
                edge=edge,
                light=light,
                averages=True,
                ends_as=ends_as,
            )
        )

    def _resize(self, image: Ref, axis: int, length: int) -> PictureShape:
        """The shape of a picture that has another length along an axis."""
        shape = self._builder.shape(image)
        size: Size = (length, shape.size[1]) if axis == 0 else (shape.size[0], length)
        return PictureShape(size, shape.channels, shape.data)
