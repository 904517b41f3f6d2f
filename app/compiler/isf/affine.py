"""Finds how the numbers of a lowered graph follow a knob, from samples of the graph at other values.

The package says why. Numbers are fitted by straight lines (`fit_slopes`), sizes by fractions of the picture's size
(`find_length_formula`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, cast

from halation.nodes import Size
from msgspec import Struct, field

from ...resources.record import Record
from ..areas import Neighborhood
from ..ir import LoweredProgram, PictureShape, UniformConstant
from ..knobs import Point

TOLERANCE = 1e-5
"""Relative difference that counts as rounding. Chosen by judgement: constants are computed in double precision and
stored as floats of 24 bits (6e-8), and sums of ten terms lose another digit."""

_LEAST_MAGNITUDE = 1e-3
"""Numbers below it count as this large when they are compared: a thousandth of what most values are in GLSL, so that
what rounds to 0 equals 0. Chosen by judgement."""

_FAR_STEPS = 5.0
"""Steps from the start to the point that checks a fit, where the samples lie within two: what bends shows there."""

_TRIED_FACTORS = 9
"""Factors around the measured one that are tried. Lengths are rounded by less than one pixel, which moves factors up to
13 by less than one: samples of the picture are 192 pixels apart. For larger ones it is chosen by judgement."""

MAX_FACTOR = 4096
"""How many times smaller than the picture a buffer may be along a side: a pyramid of twelve halvings, which ends at one
pixel for 4096 pixels."""


class FittedKnob(Struct, frozen=True):
    """A number that the graph depends on. `text` is its GLSL in the shader, `rest` its value in the graph.

    Samples are taken at `base` and in steps of `step` from it. `base` lies beside `rest`: at its value in the graph a
    node may do nothing, so that its numbers are not in the program.
    """

    name: str
    text: str
    rest: float
    base: float
    step: float
    samples: int = 2
    resizes: bool = False
    """True for the width and the height, which may change the sizes of pictures."""

    @property
    def far(self) -> float:
        """A value far from the samples, where the fit is checked; of a switch, which has two values, the other one."""
        return self.base + self.step * (1.0 if self.samples == 1 else _FAR_STEPS)


class Anatomy(Struct):
    """A program taken apart: its structure, its numbers, its sizes, and where the numbers of each constant begin.

    Constants are known by their `id`, so the program is kept.
    """

    program: LoweredProgram
    structure: object = None
    numbers: list[float] = field(default_factory=list[float])
    sizes: list[Size] = field(default_factory=list[Size])
    places: dict[int, int] = field(default_factory=dict[int, int])


def take_apart(program: LoweredProgram) -> Anatomy:
    """The structure, numbers and sizes of a program."""
    parts = Anatomy(program)
    parts.structure = (*(_walk(op, parts) for op in program.ops), tuple(program.outputs.items()))
    return parts


def _walk(item: Any, parts: Anatomy) -> object:
    if isinstance(item, UniformConstant):
        parts.places[id(item)] = len(parts.numbers)
        values = item.value if isinstance(item.value, tuple) else (item.value,)
        parts.numbers += [float(value) for value in values]
        return UniformConstant, len(values)
    if isinstance(item, PictureShape):
        parts.sizes.append(item.size)
        return item.channels, item.data, item.size == (1, 1)
    if isinstance(item, Neighborhood):
        return Neighborhood  # only tiles need it, and a shader of this format always makes the whole picture
    if isinstance(item, Struct):
        excluded = item.compare_exclude if isinstance(item, Record) else ()
        names = (name for name in item.__struct_fields__ if name not in excluded)
        return type(item), tuple(_walk(getattr(item, name), parts) for name in names)
    if isinstance(item, tuple):
        return tuple(_walk(part, parts) for part in cast("tuple[Any, ...]", item))
    return item


class LinearModel(Struct):
    """Every number as base + sum of slopes + sum of products of two knobs."""

    base: Anatomy
    knobs: dict[str, FittedKnob]
    slopes: dict[str, list[float]] = field(default_factory=dict[str, list[float]])
    products: dict[tuple[str, str], list[float]] = field(default_factory=dict[tuple[str, str], list[float]])

    def predict(self, point: Point) -> list[float]:
        """The numbers at other values of the knobs."""
        distances = {name: point.get(name, knob.base) - knob.base for name, knob in self.knobs.items()}
        numbers = list(self.base.numbers)
        for name, slopes in self.slopes.items():
            numbers = [number + slope * distances[name] for number, slope in zip(numbers, slopes, strict=True)]
        for (first, second), slopes in self.products.items():
            product = distances[first] * distances[second]
            numbers = [number + slope * product for number, slope in zip(numbers, slopes, strict=True)]
        return numbers

    def write_formula(self, place: int) -> str:
        """A number as GLSL.

        A product of two knobs is measured as `slope (a - a0) (b - b0)`. It is written as `slope a b`; what that adds
        goes to the factors of a and b and to the constant. Parts that are below the tolerance of all others are
        rounding and are left out.
        """
        constant = self.base.numbers[place]
        factors: dict[str, float] = {name: slopes[place] for name, slopes in self.slopes.items()}
        magnitude = max(abs(constant), 1e-30)  # above 0, for a sum of nothing but zeros
        parts: list[str] = []
        for (first, second), slopes in self.products.items():
            if slope := slopes[place]:
                a, b = self.knobs[first], self.knobs[second]
                factors[first] -= slope * b.base
                factors[second] -= slope * a.base
                constant += slope * a.base * b.base
                magnitude = max(magnitude, abs(slope * a.base * b.base))
                parts.append(f"{write_literal(slope)} * {a.text} * {b.text}")
        for name, factor in factors.items():
            knob = self.knobs[name]
            constant -= self.slopes[name][place] * knob.base
            magnitude = max(magnitude, abs(factor * knob.base))
            if abs(factor * max(abs(knob.base), abs(knob.step))) > TOLERANCE * magnitude:
                parts.append(f"{write_literal(factor)} * {knob.text}")
        if not parts:
            return write_literal(self.base.numbers[place])
        if abs(constant) > TOLERANCE * magnitude:
            parts.append(write_literal(constant))
        return f"({' + '.join(parts)})"


def fit_slopes(take: Callable[[Point], Anatomy | None], base: Anatomy, knob: FittedKnob) -> list[float] | None:
    """How fast every number grows with a knob; None if the structure changes or a number follows no straight line."""
    columns: list[list[float]] = []
    for step in range(1, knob.samples + 1):
        sample = take({knob.name: knob.base + step * knob.step})
        if sample is None or sample.structure != base.structure or (sample.sizes != base.sizes and not knob.resizes):
            return None
        columns.append(sample.numbers)
    slopes = [(end - start) / knob.step for end, start in zip(columns[0], base.numbers, strict=True)]
    for step, column in enumerate(columns, 1):
        if not are_close(column, [a + step * knob.step * b for a, b in zip(base.numbers, slopes, strict=True)]):
            return None
    return slopes


def are_close(numbers: Sequence[float], references: Sequence[float]) -> bool:
    """True if numbers are equal but for rounding."""
    pairs = zip(numbers, references, strict=True)
    return all(abs(a - b) <= TOLERANCE * max(abs(a), abs(b), _LEAST_MAGNITUDE) for a, b in pairs)


def find_length_formula(canvas: Sequence[int], lengths: Sequence[int]) -> str | None:
    """A formula for the length of a buffer, with `{}` for that of the picture; None if none fits all samples.

    A length is constant, equal to the picture's, or a fraction of it, rounded up, down or to the nearest.
    """
    if len(set(lengths)) == 1 and len(set(canvas)) > 1:
        return write_literal(lengths[0])
    if list(lengths) == list(canvas):
        return "{}"
    span = lengths[-1] - lengths[0]
    if span <= 0:
        return None
    rough = (canvas[-1] - canvas[0]) / span
    for factor in sorted(range(2, MAX_FACTOR), key=lambda k: abs(k - rough))[:_TRIED_FACTORS]:
        low = max(length * factor - side for side, length in zip(canvas, lengths, strict=True))
        high = min((length + 1) * factor - 1 - side for side, length in zip(canvas, lengths, strict=True))
        if low <= high:
            added = factor - 1 if low <= factor - 1 <= high else 0 if low <= 0 <= high else (low + high) // 2
            return f"floor(({{}} + {write_literal(added)}) / {write_literal(factor)})"
    return None


def write_literal(number: float) -> str:
    """A number as a float literal of GLSL 1.20."""
    text = f"{number:.9g}"
    return text if any(letter in text for letter in ".en") else f"{text}.0"
