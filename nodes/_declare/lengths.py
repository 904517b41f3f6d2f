"""Lengths: values in pixels or in fractions of a height, and the units in which a graph may give them.

A length is a value whose class declares it in "px" or in "height". A graph chooses what its numbers mean:

- `px`: pixels of the full picture. The same number is a smaller part of a larger picture.
- `px@1080`: pixels of a picture that is 1080 pixels high. The look is the same at every size.
- `height`: a fraction of the height, so that 0.01 is the same as 10.8 px@1080.

A node says the unit of a single value in `length_units`. For all others `reference_height` of the graph decides: with
it a number that is declared in pixels is in pixels at that height, without it in pixels of the full picture.
"""

from __future__ import annotations

import math
import re

from msgspec import Struct, structs

from .values import Plain, Value

LengthUnits = tuple[tuple[str, str], ...]
"""Values by name with the unit of their number, sorted by name."""

REFERENCE_HEIGHT = 1080
"""The reference height of new graphs: that of HD, for which most artists know how large a pixel is."""

MAX_REFERENCE_HEIGHT = 65536
"""The largest reference height, as high as the highest picture that is read."""

WORKING_UNITS = frozenset({None, "EV", "ratio", "count", "s", "scene", "K", "mm"})
"""Units of numbers that shaders get as they are."""

_REFERENCE = re.compile(r"px@([1-9]\d{0,4})")


def is_length(value: Value) -> bool:
    """True for a value in pixels or in fractions of the height."""
    return value.unit in ("px", "height")


def read_reference(unit: str | None) -> int | None:
    """The height of a unit such as `px@1080`; None for any other unit."""
    matched = _REFERENCE.fullmatch(unit) if unit else None
    height = int(matched[1]) if matched else 0
    return height if 0 < height <= MAX_REFERENCE_HEIGHT else None


def name_reference(height: int) -> str:
    """The unit of pixels at a height: `px@1080`."""
    return f"px@{height}"


def length_unit_fault(value: Value, unit: str) -> str | None:
    """Why the number of a value cannot be in a unit, or None."""
    if not is_length(value):
        return f"'{value.name}' is not a length, so that its unit cannot be chosen"
    if unit in ("px", "height") or read_reference(unit):
        return None
    return f"'{unit}' is no unit of a length: write px, height, or px@ with a height, such as px@{REFERENCE_HEIGHT}"


def resolve_length_unit(unit: str | None, reference_height: int | None) -> str | None:
    """What a unit means in a graph: with a reference height, px is pixels at that height."""
    return name_reference(reference_height) if unit == "px" and reference_height else unit


def unit_factor(unit: str | None, scale: float, height: float) -> float:
    """The factor from a unit to working units, for a proxy of `scale` and a picture `height` pixels high."""
    if unit is None or unit == "ratio":
        return 1.0
    if unit == "px":
        return scale
    if unit == "height":
        return height
    if unit == "deg":
        return math.pi / 180.0
    reference = read_reference(unit)
    return height / reference if reference else 1.0


def convert_length(plain: Plain, unit: str | None, new_unit: str | None, height: float) -> Plain:
    """A length in another unit, so that it stays the same for a picture `height` pixels high."""
    factor = unit_factor(unit, 1.0, height) / unit_factor(new_unit, 1.0, height)
    if isinstance(plain, tuple):
        return tuple(part * factor for part in plain)
    return plain * factor if isinstance(plain, int | float) else plain


def declare_in_unit(value: Value, unit: str) -> Value:
    """The declaration of a length whose number is in another unit: default and ranges are converted.

    Fractions of the height are converted by the usual reference height, so that ranges depend on no picture.
    """
    if unit == value.unit:
        return value
    factor = (REFERENCE_HEIGHT if value.unit == "height" else 1.0) / (REFERENCE_HEIGHT if unit == "height" else 1.0)
    default = value.default
    converted: Plain = (
        tuple(part * factor for part in default)
        if isinstance(default, tuple)
        else default * factor
        if isinstance(default, int | float)
        else default
    )
    limits = {name: getattr(value, name) * factor for name in ("low", "high", "minimum", "maximum")}
    return structs.replace(value, unit=unit, default=converted, **limits)


class Spacing(Struct, frozen=True):
    """How an operator of 3x3 pixels works for pixels of another size: which pixels it reads, and of what.

    A picture of n times the size that is averaged over n x n pixels is the picture of the usual size. So an operator
    that reads pixels `step` apart of a picture that is blurred by `sigma` gives the same result. `gain` keeps the sum
    where the wanted distance is no whole number of pixels, or less than one.
    """

    step: int
    sigma: float
    gain: float


def space_pixels(width: float) -> Spacing:
    """The spacing for a distance of pixels in working units; 0 means neighbors at any size.

    The variance of a box that is n pixels wide is n^2 / 12, of which the pixel itself has 1 / 12.
    """
    if width <= 0.0:
        return Spacing(1, 0.0, 1.0)
    step = max(1, round(width))
    return Spacing(step, math.sqrt(max(width * width - 1.0, 0.0) / 12.0), width / step)
