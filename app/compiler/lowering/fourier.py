"""Convolves two pictures by the fast Fourier transform: its lengths, stages and passes. See primitive/fourier.glsl."""

from __future__ import annotations

import math
from functools import cache

from msgspec import Struct

from ..ir import Accessor, Builder, Choice, Gather, Parameter, PictureShape, Ref, UniformConstant

_PRIMES = (2, 3, 5)
"""Lengths are padded to products of these, of which there is one less than 11 % above any length from 64 pixels on."""

_STAGE_COST = 14
"""What a stage costs besides its reads, in reads: measured on the software rasterizer. With a larger number, stages get
fewer and larger."""

_MAX_READS = 20
"""Reads of a stage at most: the driver unrolls the loop, and compile times grow with it. Lengths up to 8000 pixels then
need five stages at most, mostly four."""


_SHADER = "primitive/fourier"


class FourierStage(Struct, frozen=True):
    """One pass: `radix` transforms of length `span` become one; every pixel of it is made of `terms` pixels.

    Of the first stage, `terms` may be less than `radix`: what is not read is black.
    """

    radix: int
    span: int
    terms: int


def add_convolution(builder: Builder, image: Ref, kernel: Ref, owner: str) -> Ref:
    """A picture convolved with another one around its middle, black outside."""
    image_size, kernel_size = builder.shape(image).size, builder.shape(kernel).size
    width, height = (pad_length(*lengths) for lengths in zip(image_size, kernel_size, strict=True))
    spectra = [
        _transform(builder, _transform(builder, picture, 0, width, owner), 1, height, owner)
        for picture in (image, kernel)
    ]
    product = builder.add(
        Gather(
            (PictureShape((width, height), 4, data=True),),
            owner,
            _SHADER,
            "fourier_product",
            (Parameter("float", UniformConstant(1.0 / (width * height))),),
            accessors=tuple(
                Accessor(name, "vec4", spectrum) for name, spectrum in zip(("image", "kernel"), spectra, strict=True)
            ),
        )
    )
    across, down = kernel_size[0] // 2, kernel_size[1] // 2
    convolved = _transform(builder, product, 1, height, owner, (down, image_size[1]))
    return _transform(builder, convolved, 0, width, owner, (across, image_size[0]))


def pad_length(picture: int, kernel: int) -> int:
    """How many pixels to transform, so that no light wraps around from one edge of the picture to the other."""
    length = max(kernel, picture + kernel // 2)
    while _remove_primes(length) != 1:
        length += 1
    return length


def plan_stages(length: int, filled: int) -> tuple[FourierStage, ...]:
    """The passes that transform a length whose prime factors are 2, 3 and 5; pixels from `filled` on are black.

    A stage of radix r reads r pixels for each one that it makes. A large radix means few stages with many reads, so
    costs are compared: reads, and `_STAGE_COST` for the pass itself. The first stage reads no black pixels and may take
    a larger radix for it.
    """
    terms = {radix: math.ceil(filled * radix / length) for radix in range(1, length + 1) if length % radix == 0}
    first = min(
        (radix for radix in terms if terms[radix] <= _MAX_READS),
        key=lambda radix: _STAGE_COST + terms[radix] + _count_cost(_find_radices(length // radix)),
    )
    stages = [FourierStage(first, 1, terms[first])]
    span = first
    for radix in _find_radices(length // first):
        stages.append(FourierStage(radix, span, radix))
        span *= radix
    return tuple(stages)


@cache
def _find_radices(length: int) -> tuple[int, ...]:
    """The factors of a length that cost the least."""
    if length == 1:
        return ()
    candidates = ((radix, *_find_radices(length // radix)) for radix in range(2, _MAX_READS + 1) if length % radix == 0)
    return min(candidates, key=_count_cost)


def _count_cost(radices: tuple[int, ...]) -> int:
    return sum(_STAGE_COST + radix for radix in radices)


def _remove_primes(length: int) -> int:
    for prime in _PRIMES:
        while length % prime == 0:
            length //= prime
    return length


def _transform(
    builder: Builder, picture: Ref, axis: int, length: int, owner: str, inverse: tuple[int, int] | None = None
) -> Ref:
    """Transform along an axis; with `inverse` (the first pixel and how many) back, into these pixels."""
    passes = plan_stages(length, builder.shape(picture).size[axis])
    for stage in passes:
        size = builder.shape(picture).size
        first, count = inverse if inverse and stage is passes[-1] else (0, length)
        size = (count, size[1]) if axis == 0 else (size[0], count)
        distance = length // stage.radix
        begins = not inverse and stage is passes[0]
        # The numbers that loops run to are part of the text, so that drivers unroll them.
        parameters = [Parameter("int", Choice(axis)), Parameter("int", Choice(stage.terms))]
        if begins:
            parameters += [Parameter("int", UniformConstant(number)) for number in (stage.radix, distance)]
        else:
            parameters += [Parameter("int", UniformConstant(number)) for number in (stage.span, distance, first)]
            parameters.append(Parameter("float", UniformConstant(1.0 if inverse else -1.0)))
        picture = builder.add(
            Gather(
                (PictureShape(size, 4, data=True),),
                owner,
                _SHADER,
                "fourier_first" if begins else "fourier_stage",
                tuple(parameters),
                accessors=(Accessor("image", "vec4", picture),),
                edge="black" if begins else "clamp",
            )
        )
    return picture
