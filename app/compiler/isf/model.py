"""Finds which numbers of a program the controls, the frame and the size change, and holds the controls that do more."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Size
from msgspec import Struct, field

from ...errors import HalationError
from ..ir import LoweredProgram, UniformConstant
from ..knobs import FRAME, GraphSampler, Point
from .affine import Anatomy, FittedKnob, LinearModel, are_close, find_length_formula, fit_slopes

WIDTH, HEIGHT = "canvas.width", "canvas.height"
_SIZE_STEPS = (0, 37, 91, 192)
"""Pixels by which sizes are sampled. They differ by odd numbers, so that a formula that rounds wrongly fails at one of
them."""
"""The names of the knobs of the picture's size. No control can have a name with a dot."""

SizeFormulas = Mapping[Size, tuple[str, str]]
"""Sizes of pictures as formulas of the size of the exported picture, which is written `{}`."""


class IsfModel(Struct):
    """A program with its numbers and sizes as formulas. `held_knobs` are the knobs that it does not follow."""

    program: LoweredProgram
    model: LinearModel
    sizes: SizeFormulas
    held_knobs: list[str] = field(default_factory=list[str])

    def write_constant(self, item: UniformConstant) -> tuple[str, ...] | None:
        """The numbers of a constant as GLSL; None if no knob changes them."""
        place = self.model.base.places.get(id(item))
        if place is None:
            return None
        numbers = range(place, place + (len(item.value) if isinstance(item.value, tuple) else 1))
        slopes = (*self.model.slopes.values(), *self.model.products.values())
        return (
            tuple(map(self.model.write_formula, numbers))
            if any(values[at] for values in slopes for at in numbers)
            else None
        )

    @property
    def used_knobs(self) -> set[str]:
        """The knobs that change some number."""
        return {name for name in self.model.slopes if _matters(self.model, name)}


class ModelSearch(Struct):
    """Fits knobs; one that does not fit is held at its value in the graph, and the search starts again without it."""

    sampler: GraphSampler[Anatomy]
    knobs: dict[str, FittedKnob]
    size: Size
    held_knobs: list[str] = field(default_factory=list[str])

    def find_model(self) -> IsfModel:
        """Fit as many knobs as possible. Raises the errors of compiling the graph at its own values."""
        while True:
            try:
                base = self.sampler.take(self._find_base())
            except HalationError:
                if not self.knobs:
                    raise
                self._hold_knob(next(reversed(self.knobs)))
                continue
            model = LinearModel(base, dict(self.knobs))
            failed = self._fit_slopes(model)
            sizes: SizeFormulas | None = None
            if WIDTH in self.knobs and not failed:
                sizes = self._find_size_formulas(model.base)
                failed = WIDTH if sizes is None else ""
            failed = failed or self._fit_products(model)
            if not failed:
                return IsfModel(base.program, model, sizes or {}, self.held_knobs)
            self._hold_knob(failed)

    def _find_base(self) -> dict[str, float]:
        return {name: knob.base for name, knob in self.knobs.items()}

    def _try_take(self, point: Point) -> Anatomy | None:
        return self.sampler.try_take({**self._find_base(), **point})

    def _hold_knob(self, name: str) -> None:
        for held_name in (WIDTH, HEIGHT) if name in (WIDTH, HEIGHT) else (name,):
            self.held_knobs.append(held_name)
            del self.knobs[held_name]

    def _fit_slopes(self, model: LinearModel) -> str:
        """Fit each knob alone; the name of the first knob that does not fit, or ""."""
        for name, knob in self.knobs.items():
            slopes = fit_slopes(self._try_take, model.base, knob)
            if slopes is None:
                return name
            model.slopes[name] = slopes
        return ""

    def _fit_products(self, model: LinearModel) -> str:
        """Fit products of two knobs and check the result far away; the name of a knob that does not fit, or ""."""
        names = [name for name in model.slopes if _matters(model, name)]
        for at, first in enumerate(names):
            for second in names[at + 1 :]:
                a, b = model.knobs[first], model.knobs[second]
                point = {first: a.base + a.step, second: b.base + b.step}
                numbers = self._find_numbers(model, point)
                if numbers is None:
                    return first if first in (WIDTH, HEIGHT, FRAME) else second
                predicted = model.predict(point)
                if not are_close(numbers, predicted):
                    area = a.step * b.step
                    model.products[first, second] = [(x - y) / area for x, y in zip(numbers, predicted, strict=True)]
        point = {name: model.knobs[name].far for name in names}
        numbers = self._find_numbers(model, point) if names else None
        return "" if not names or (numbers is not None and are_close(numbers, model.predict(point))) else names[-1]

    def _find_numbers(self, model: LinearModel, point: Point) -> list[float] | None:
        """The numbers at a point; None if the structure of the program is another one there."""
        sample = self._try_take(point)
        return sample.numbers if sample is not None and sample.structure == model.base.structure else None

    def _find_size_formulas(self, base: Anatomy) -> SizeFormulas | None:
        """The sizes of all pictures as formulas; None if some size has none."""
        steps = _SIZE_STEPS
        samples: list[Anatomy] = []
        for step in steps:
            sample = self._try_take({WIDTH: self.size[0] + step, HEIGHT: self.size[1] + step})
            if sample is None or sample.structure != base.structure:
                return None
            samples.append(sample)
        texts: dict[Size, tuple[str, str]] = {}
        for at, size in enumerate(base.sizes):
            across, down = (
                find_length_formula(
                    [self.size[axis] + step for step in steps], [sample.sizes[at][axis] for sample in samples]
                )
                for axis in (0, 1)
            )
            if across is None or down is None or texts.get(size, (across, down)) != (across, down):
                return None
            texts[size] = across, down
        return texts


_LEAST_EFFECT = 1e-7
_LEAST_NUMBER = 1e-3
"""A knob whose step changes a number by less than this part of it does not matter: floats of 32 bits would show nothing
(6e-8). Numbers below the second one count as this large."""


def _matters(model: LinearModel, name: str) -> bool:
    step = model.knobs[name].step
    numbers = zip(model.slopes[name], model.base.numbers, strict=True)
    return any(abs(slope * step) > _LEAST_EFFECT * max(abs(number), _LEAST_NUMBER) for slope, number in numbers)
