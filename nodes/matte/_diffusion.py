"""Fills unknown pixels by diffusion: see shaders/lib/diffusion.glsl.

The solution is guessed from that at half the size, and so on down to a single pixel (cascadic multigrid). There the
border of a hole lies a little elsewhere, so two corrections follow: what the equation still lacks is solved for in the
same way (multigrid, Brandt 1977), and added.
"""

import math

from .._declare import Draw, Drawn, Field, Image, Pixels, Size

_CORRECTIONS = 2
"""Measured on holes of 96 x 72 pixels against the exact solution for a range of 1: the largest error is 0.05 without a
correction, 0.015 with one, 0.009 with two."""

_STEPS = 6
_SMOOTHEST = 0.15
"""The steps at each size weaken all errors whose eigenvalue lies between this and 2, the largest. Half the size holds
those below 0.15 well."""


_ROUGH_WEIGHTS = (2.2, 0.55)
"""Measured on six plates before green and blue screens that are keyed with the filling: the mattes have 0.993 of the
error that they have with the exact solution, and at most 1.015 for one of them."""


def _list_weights() -> tuple[float, ...]:
    """The weights of the steps, from the roots of a Chebyshev polynomial (Varga 1962). Large ones and small ones take
    turns, so that rounding errors do not grow."""
    middle, half = 0.5 * (2.0 + _SMOOTHEST), 0.5 * (2.0 - _SMOOTHEST)
    roots = [middle + half * math.cos(math.pi * (number + 0.5) / _STEPS) for number in range(_STEPS)]
    pairs = zip(roots[: _STEPS // 2], reversed(roots[_STEPS // 2 :]), strict=True)
    return tuple(1.0 / root for pair in reversed([*pairs]) for root in reversed(pair))


def fill(draw: Draw, picture: Pixels, known: Pixels) -> Drawn:
    """A picture whose pixels are kept where `known` is 1, and elsewhere diffuse in from there.

    The node's GLSL file includes lib/diffusion.glsl.
    """
    size = draw.size_of(picture)
    guess = _guess(draw, picture, known, _list_weights())
    for _ in range(_CORRECTIONS):
        lack = draw("diffusion_lack", guess=guess, known=known, size=size)
        guess = draw("diffusion_add", guess=guess, change=_correct(draw, lack, known), size=size)
    return guess


def fill_roughly(draw: Draw, picture: Pixels, known: Pixels) -> Drawn:
    """The same in four passes for each size, a fifth of all: for fillings that are blurred, or behind a subject.

    Kept pixels are averaged down to one, and flow back between them: pull and push (Gortler et al. 1996).
    """
    return _guess(draw, picture, known, _ROUGH_WEIGHTS)


def _halve(size: Size) -> Size:
    return (size[0] + 1) // 2, (size[1] + 1) // 2


def _guess(draw: Draw, picture: Pixels, known: Pixels, weights: tuple[float, ...]) -> Drawn:
    """The solution, roughly: the one at half the size, and a few steps from there."""
    size = draw.size_of(picture)
    half = _halve(size)
    coarse, sure = draw.several("diffusion_halve", (Image(), Field()), picture=picture, known=known, size=half)
    if half != (1, 1):
        coarse = _guess(draw, coarse, sure, weights)
    guess = draw("diffusion_start", picture=picture, known=known, coarse=coarse, size=size)
    for weight in weights:
        guess = draw("diffusion_step", guess=guess, known=known, size=size, weight=weight)
    return guess


def _correct(draw: Draw, lack: Pixels, known: Pixels) -> Drawn:
    """The change that makes up for what a guess lacks: 0 where pixels are known."""
    size = draw.size_of(lack)
    half = _halve(size)
    coarse, sure = draw.several("diffusion_gather", (Image(), Field()), lack=lack, known=known, size=half)
    if half != (1, 1):
        coarse = _correct(draw, coarse, sure)
    guess = draw("diffusion_start", picture=lack, known=known, coarse=coarse, size=size)
    for weight in _list_weights():
        guess = draw("diffusion_correct", guess=guess, lack=lack, known=known, size=size, weight=weight)
    return guess
