"""Plans a graph at many values of its knobs, and takes the plans apart into structure and numbers."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping

import numpy as np
from halation.nodes import Uniform
from msgspec import Struct, field

from ...compiler import Plan
from ...compiler.knobs import Knob, Point
from ...resources.picture import Picture

FIRST_STEPS = 3
"""Steps between the first samples of a knob; where numbers bend or passes change, samples between follow."""

DENSE_STEPS = 8
"""Whole numbers up to which each is sampled. A choice."""

SMALLEST_STEP = 1 / 128
"""The smallest step between samples, as a part of the range: two steps of a slider of 256 pixels."""

JUMP_STEP = 1 / 4096
"""The smallest step where passes change, or a slot gets more or fewer numbers, such as the weights of a wider blur.
Between such samples there is nothing, so they are so close that no slider stops there: a tenth of a pixel of its
width."""

BEND = 2e-3
"""How far a number may lie beside the line between two samples, as a part of the largest number of its slot: half a
step of 8 bits for what scales a color. A table mixes units, such as places of lights and how many there are: there each
number counts by itself. It counts by what it is there, not by its largest: 1 / reach^2 has a pole, beside which all
else would be nothing."""

JUMP = 0.02
"""How far the numbers of a table lie beside the line between neighbors, as such a part, where they jump.
It is ten times `BEND`; at the smallest step, a smooth number is ten times nearer."""

LEAST_SCALE = 1e-4
"""What a number of a table counts as at least, so that the rounding of a float near 1 is nothing. A choice."""

MOST_JUMPS = 4
"""Jumps of tables along a knob up to which it is a control: so many of 256 steps of a slider are wrong. A choice."""

LEAST_PART = 1 / 32
"""The smallest part of a range after which it is asked whether a knob can still be a control. A choice."""

BESIDE = 1e-4
"""How far beside a special value a sample is taken, as a part of the range: less than any slider moves. A choice."""

LEAST_MATRIX = 9
"""Numbers of the smallest matrix: three rows of three."""

Array = np.ndarray
_NO_SCALE = np.ones(1)
LoadFunction = Callable[[Picture], Array]


class Slot(Struct, frozen=True, eq=False):
    """The numbers of one uniform, of the weights of a pass, or of a table that a node made."""

    numbers: Array
    is_whole: bool
    is_table: bool = False
    is_matrix: bool = False
    """A matrix or a camera: an error of its numbers moves things in the picture."""


class Sample(Struct, frozen=True, eq=False):
    """A plan taken apart: equal structures differ in the numbers of their slots alone."""

    plan: Plan
    structure: object
    slots: tuple[Slot, ...]


def take_apart(plan: Plan, load: LoadFunction) -> Sample:
    """The structure of a plan, and its slots: uniforms and weights by pass, then tables of numbers."""
    slots: list[Slot] = []
    structure: list[object] = []
    number_surfaces = {upload.surface for upload in plan.uploads if is_number_table(upload.picture)}
    for render_pass in plan.passes:
        names = tuple((name, _count_numbers(value)) for name, value in render_pass.uniforms)
        slots += [_make_uniform_slot(value) for _, value in render_pass.uniforms]
        if render_pass.weights:
            weights = np.trim_zeros(np.asarray(render_pass.weights, np.float64), "b")  # the block is filled up with 0
            slots.append(Slot(weights, is_whole=False))
        shader, tables = render_pass.shader, tuple(table.sampler for table in render_pass.tables)
        mesh = render_pass.mesh.digest if render_pass.mesh else ""
        structure.append((shader.source, shader.vertex, render_pass.textures, render_pass.targets, names, tables, mesh))
    for number, surface in enumerate(plan.surfaces):
        size = (0, 0) if number in number_surfaces else surface.size
        structure.append((size, surface.channels, surface.depth, surface.slot))
    for upload in plan.uploads:
        if is_number_table(upload.picture):
            pixels = load(upload.picture).astype(np.float64)
            slots.append(Slot(np.concatenate([pixels.shape, pixels.reshape(-1)]), is_whole=False, is_table=True))
        structure.append((upload.surface, is_number_table(upload.picture) or upload.picture))
    structure += [tuple(plan.outputs.items()), tuple(plan.memories)]
    return Sample(plan, tuple(structure), tuple(slots))


def is_number_table(picture: Picture) -> bool:
    """True for a table that a node computed of its values, such as a list of lights."""
    return picture.in_memory and picture.path == "numbers"


def _make_uniform_slot(value: Uniform) -> Slot:
    return Slot(_as_array(value), _is_whole(value), is_matrix=_count_numbers(value) >= LEAST_MATRIX)


def _as_array(value: Uniform) -> Array:
    return np.asarray(value if isinstance(value, tuple) else (value,), np.float64)


def _count_numbers(value: Uniform) -> int:
    return len(value) if isinstance(value, tuple) else 1


def _is_whole(value: Uniform) -> bool:
    return all(isinstance(part, int) for part in (value if isinstance(value, tuple) else (value,)))


class _TableScales:
    """The largest that each number of a table has in all samples of the same passes and as many numbers."""

    def __init__(self) -> None:
        self._largest: dict[tuple[object, int, int], Array] = {}

    def add(self, sample: Sample) -> None:
        """Take one more sample into account."""
        for number, slot in enumerate(sample.slots):
            if slot.is_table:
                key = sample.structure, number, len(slot.numbers)
                self._largest[key] = np.maximum(self._largest.get(key, LEAST_SCALE), np.abs(slot.numbers))

    def find(self, sample: Sample, number: int) -> Array:
        """What each number of a slot counts as; nothing is known of what is no table."""
        return self._largest.get((sample.structure, number, len(sample.slots[number].numbers)), _NO_SCALE)


class KnobSampler(Struct):
    """Samples one knob while all others rest at `base`."""

    take: Callable[[Point], Sample | None]
    base: Point
    knob: Knob
    is_dense: bool = False
    """Whether all whole numbers of the range are sampled: keys of an animation may be anywhere."""
    samples: dict[float, Sample] = field(default_factory=dict[float, Sample])

    def sample_range(self) -> dict[float, Sample]:
        """Samples from low to high, close enough for lines between them."""
        knob = self.knob
        span = round(knob.high - knob.low)
        count = max(span, 1) if knob.is_whole and (self.is_dense or span <= DENSE_STEPS) else FIRST_STEPS
        places = sorted({knob.snap(x) for x in (*np.linspace(knob.low, knob.high, count + 1), knob.rest)})
        for x in places:
            self._add(x)
        if not knob.is_whole:
            self._replace_special(places)
        for low, high in itertools.pairwise(places):
            self._refine(low, high)
            if self._is_hopeless(low, high):
                break
        return dict(sorted(self.samples.items()))

    def _take(self, x: float) -> Sample | None:
        return self.take({**self.base, self.knob.name: x})

    def _add(self, x: float) -> Sample | None:
        sample = self._take(x)
        if sample is not None:
            self.samples[x] = sample
        return sample

    def _replace_special(self, places: list[float]) -> None:
        """Take samples beside special values, at which a node does nothing and the structure is another one."""
        for at, x in enumerate(places):
            sample = self.samples.get(x)
            neighbors = [self.samples.get(places[k]) for k in (at - 1, at + 1) if 0 <= k < len(places)]
            if (
                sample is None
                or len(places) < 3
                or any(near and near.structure == sample.structure for near in neighbors)
            ):
                continue
            self._take_beside(x, places[at - 1] < x if at else False)

    def _take_beside(self, x: float, is_below: bool) -> None:
        step = (self.knob.high - self.knob.low) * BESIDE
        beside = self._take(x - step if is_below else x + step)
        if beside is not None and beside.structure != self.samples[x].structure:
            self.samples[x] = beside

    def _refine(self, low: float, high: float) -> None:
        """Add samples between two, until numbers between them lie on a line."""
        middle = self.knob.snap((low + high) / 2.0)
        first, last = self.samples.get(low), self.samples.get(high)
        smallest_step = JUMP_STEP if first and last and _jumps(first, last) else SMALLEST_STEP
        if middle in (low, high) or high - low <= (self.knob.high - self.knob.low) * smallest_step:
            return
        sample = self._add(middle)
        if first is None or last is None or sample is None:
            return
        if sample.structure not in (first.structure, last.structure) and not self.knob.is_whole:
            self._take_beside(middle, is_below=False)
            sample = self.samples[middle]
            if high - low <= (self.knob.high - self.knob.low) * SMALLEST_STEP:
                return  # passes that change everywhere, as with a size of pictures, have no edge to look for
        if first.structure == last.structure == sample.structure and self._is_straight(first, sample, last):
            return
        self._refine(low, middle)
        if not self._is_hopeless(low, middle):
            self._refine(middle, high)

    def _is_hopeless(self, low: float, high: float) -> bool:
        """True if the samples up to `high` are irregular already: then the knob is no control, whatever follows.

        Large parts of the range are asked alone, since to look through all samples takes time too.
        """
        if self.knob.is_whole or high - low < (self.knob.high - self.knob.low) * LEAST_PART:
            return False
        return is_irregular(dict(sorted(self.samples.items())), until=high)

    def _is_straight(self, first: Sample, middle: Sample, last: Sample) -> bool:
        """True if all numbers of the middle sample lie between those of the others."""
        for a, b, c in zip(first.slots, middle.slots, last.slots, strict=True):
            if not len(a.numbers) == len(b.numbers) == len(c.numbers):
                return False
            if _measure_bend(a, b, c, np.maximum(np.abs(a.numbers), np.abs(c.numbers))) > BEND:
                return False
        return True


def _jumps(first: Sample, last: Sample) -> bool:
    """True if the passes are others, or a slot of one of them has more numbers in one sample."""
    return first.structure != last.structure or any(
        len(a.numbers) != len(b.numbers) for a, b in zip(first.slots, last.slots, strict=True)
    )


def is_irregular(samples: Mapping[float, Sample], until: float = math.inf) -> bool:
    """True if a table jumps again and again along a knob of fractions, as the sorted outlines of a text that is scaled.

    Between two such tables there is nothing, and the nearest one is that of another value. Jumps count up to `until`,
    beyond which samples may lie too far apart to tell a jump from a bend.
    """
    jumps, scales = 0, _TableScales()
    for sample in samples.values():
        scales.add(sample)
    for (x, a), (y, b), (z, c) in zip(*(list(samples.items())[at:] for at in range(3)), strict=False):
        if z <= until and a.structure == b.structure == c.structure:
            share = (y - x) / (z - x)
            jumps += any(
                _measure_bend(*slots, scales.find(b, number), share) > JUMP
                for number, slots in enumerate(zip(a.slots, b.slots, c.slots, strict=True))
                if slots[1].is_table and len({len(slot.numbers) for slot in slots}) == 1
            )
    return jumps > MOST_JUMPS


def _measure_bend(first: Slot, middle: Slot, last: Slot, scale: Array, share: float = 0.5) -> float:
    """How far numbers lie beside the line between those of two other samples, as a part of the largest of these.

    `scale` is what each number of a table counts as.
    """
    a, c = first.numbers, last.numbers
    aside = np.abs(a + share * (c - a) - middle.numbers)
    if middle.is_table:
        return float((aside / np.maximum(scale, LEAST_SCALE)).max(initial=0.0))
    largest = max(np.abs(a).max(initial=0.0), np.abs(c).max(initial=0.0), 1e-9)  # above 0, where all are 0
    return float(aside.max(initial=0.0) / largest)
