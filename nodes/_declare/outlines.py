"""Closed outlines that are drawn as masks."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from .lettering import Contour

FillMode = Literal["union", "subtract", "intersect", "max", "min", "difference", "plus"]


class OutlinePlace(Struct, frozen=True):
    """Contours by their number in a list, and the map of their points to pixels, as `Affine` has it."""

    number: int
    matrix: tuple[float, float, float, float, float, float]


class OutlineFill(Struct, frozen=True):
    """Contours that count together, and how they change a mask. Other lengths than those of contours are pixels.

    `feathers` are widths of the edge at the points where curves start, in order, in addition to `feather`. `growth`
    moves the edge outward.
    """

    contours: tuple[tuple[Contour, ...], ...]
    places: tuple[OutlinePlace, ...]
    mode: FillMode = "union"
    opacity: float = 1.0
    invert: bool = False
    feather: float = 0.0
    feathers: tuple[float, ...] = ()
    growth: float = 0.0
