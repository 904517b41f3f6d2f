"""Numbers of a slot as curves of knobs: polygons through samples, added or multiplied."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from .sampling import LEAST_SCALE, Array, Sample

_LEAST_NUMBER, _LEAST_LARGEST = 1e-12, 1e-9
"""What the largest number counts as at least, so that nothing is divided by 0: below what matters in a picture."""

_WHOLE_DOUBLES = 1e15
"""Below it, doubles hold all whole numbers and are written without an exponent."""

_SAME = 1e-7
"""Difference of numbers, as a part of the largest, that is rounding: half of what a float of 24 bits resolves."""
LINE = 2e-5
"""How far a sample may lie beside the polygon that leaves it out, as a part of its largest number, or of each number of
a table: a hundredth of `BEND`, so that leaving out costs nothing against sampling."""

PLACED = 5e-6
"""How far a number of a matrix may lie beside its curve, as a part of the largest of its row of samples: 0.005 pixels
of a picture of 1000: devices place corners at 256ths."""

_CUBIC = 4
"""The samples that a cubic goes through."""

_ROUNDED_ENDS = 2.0 * _SAME
"""How far a line between two samples is off because these are rounded, as a part of the larger."""

_SMOOTH = 1e-3
"""How far a sample may lie beside the cubic of its neighbors in a smooth curve: half of `BEND`, which a corner exceeds.
A cubic between samples is then nearer by far, as the gap is half as wide."""

_LEAST_SCALE = 1e-3
"""Numbers of a matrix below this part of its largest one do not count by themselves."""

_MOST_BETWEEN = 32
"""The most places between two samples, whatever the curve is: keeps pages small."""

_ASIDE = 1e-4
"""How far beside the middle of a gap a jump begins and ends, as a part of the gap: more than places are rounded."""

Record = dict[str, Any]


class Jumps(NamedTuple):
    """Where the numbers of a pass jump: by knob, a truth value for each gap between two samples."""

    whole: Mapping[str, Array] = MappingProxyType({})
    """Whole numbers jump, and nobody knows exactly where."""
    lengths: Mapping[str, Array] = MappingProxyType({})
    """A slot gets more or fewer numbers, in a gap that is nearly a point."""


NO_JUMPS = Jumps()

PairSamples = tuple[list[float], list[float], Sequence[Sequence[Sample | None]]]
"""Values of two knobs, and the samples at all combinations of them; None where the passes are others."""


def write_slot(
    number: int,
    base: Sample,
    samples: Mapping[str, Mapping[float, Sample]],
    checks: list[Any],
    jumps: Jumps = NO_JUMPS,
) -> Record:
    """A slot as JSON: its numbers at rest, and a curve for each knob that changes them.

    `checks` are points with all knobs elsewhere, and their samples: they decide whether curves are added or multiplied.
    Where whole numbers jump along a knob, the nearest sample counts for them, with nothing between, and others jump
    where these do. Where a slot of the pass gets more numbers, all jump: half a weight more means nothing.
    """
    slot = base.slots[number]
    lengths = {len(s.slots[number].numbers) for group in samples.values() for s in group.values()}
    length = max({len(slot.numbers)} | lengths)
    rest = _pad(slot.numbers, length)
    curves: list[Record] = []
    for name, group in samples.items():
        places = np.array(list(group))
        rows = np.array([_pad(sample.slots[number].numbers, length) for sample in group.values()])
        largest = _find_largest(rows, is_table=slot.is_table)
        if len(places) > 1 and (np.abs(rows - rest) / largest).max(initial=0.0) > _SAME:
            is_snapped = name in jumps.whole and (slot.is_whole or len(lengths) > 1)
            knob_gaps = [gaps[name] for gaps in jumps if name in gaps]
            if knob_gaps and not is_snapped:
                places, rows = _split(places, rows, np.any(knob_gaps, axis=0))
            keep = list(range(len(places))) if is_snapped else simplify(places, rows, is_table=slot.is_table)
            if slot.is_matrix and not is_snapped:
                filled_places, filled_rows = fill_gaps(places, rows)
                if len(filled_places) > len(places):
                    places, rows, keep = filled_places, filled_rows, list(range(len(filled_places)))
            curve: Record = {"knob": name, "at": _round(places[keep]), "values": [_round(row) for row in rows[keep]]}
            curves.append({**curve, "snap": True} if is_snapped else curve)
    record: Record = {"base": _round(rest)}
    if slot.is_whole:
        record["whole"] = True
    if curves:
        record["curves"] = curves
    if len(curves) > 1:
        record["mode"] = _choose_mode(record, number, length, checks)
    return record


def read_slot(record: Record, point: Mapping[str, float], mode: str = "") -> Array:
    """The numbers of a slot at a point: what every reader of a package computes."""
    base = np.array(record["base"], np.float64)
    numbers = base.copy()
    for curve in record.get("curves", ()):
        places, rows = np.array(curve["at"]), np.array(curve["values"])
        x = point.get(curve["knob"])
        if x is None:
            continue
        if curve.get("snap"):
            row = rows[np.abs(places - x).argmin()]
        else:
            row = np.array([np.interp(x, places, column) for column in rows.T])
        if (mode or record.get("mode", "add")) == "multiply":
            ratio = np.divide(row, base, out=np.zeros_like(row), where=base != 0.0)
            numbers = np.where(base != 0.0, numbers * ratio, numbers + row)
        else:
            numbers += row - base
    for grid in record.get("grids", ()):
        numbers += _interpolate_grid(grid, *(point[name] for name in grid["knobs"]))
    return numbers


def add_grids(
    record: Record, number: int, pairs: Callable[[str, str], PairSamples], checks: list[Any], limit: float
) -> None:
    """Add what two knobs change together and their curves do not say, for each pair of knobs that needs it."""
    names = [curve["knob"] for curve in record["curves"] if not curve.get("snap")]
    for first, second in itertools.combinations(names, 2):
        if measure_error(record, number, checks) <= limit:
            return
        xs, ys, rows = pairs(first, second)
        length = len(record["base"])
        rest = np.zeros((len(xs), len(ys), length))
        for (i, x), (j, y) in itertools.product(enumerate(xs), enumerate(ys)):
            if (sample := rows[i][j]) is not None:
                numbers = _pad(sample.slots[number].numbers, length)
                rest[i, j] = numbers - read_slot({**record, "grids": ()}, {first: x, second: y})
        largest = _find_largest(np.array([record["base"]]), is_table=checks[0][1].slots[number].is_table)
        if (np.abs(rest) / largest).max(initial=0.0) > LINE:
            values = [[_round(row) for row in line] for line in rest]
            record.setdefault("grids", []).append(
                {"knobs": [first, second], "at": [_round(np.array(xs)), _round(np.array(ys))], "values": values}
            )


def _interpolate_grid(grid: Record, x: float, y: float) -> Array:
    """The row of a grid between four others."""
    xs, ys = grid["at"]
    values = np.array(grid["values"])
    lines = [np.array([np.interp(y, ys, column) for column in line.T]) for line in values]
    return np.array([np.interp(x, xs, column) for column in np.array(lines).T])


def _split(places: Array, rows: Array, is_jump: Array) -> tuple[Array, Array]:
    """A polygon that jumps in the middle of some of its gaps, as the nearest sample does."""
    at = np.nonzero(is_jump)[0]
    middles, aside = 0.5 * (places[at] + places[at + 1]), _ASIDE * (places[at + 1] - places[at])
    inserted = np.repeat(at + 1, 2)
    places = np.insert(places, inserted, np.stack([middles - aside, middles + aside], axis=1).ravel())
    return places, np.insert(rows, inserted, np.stack([rows[at], rows[at + 1]], axis=1).reshape(-1, rows.shape[1]), 0)


def fill_gaps(places: Array, rows: Array) -> tuple[Array, Array]:
    """Places between samples of a smooth curve, so that a polygon through all of them is as close as `PLACED`.

    They lie on the cubic through the four nearest samples. A gap is left alone where such a cubic misses one of the
    samples beside it: there is a corner in the curve. So are whole numbers, between which no slider stops.
    """
    if len(places) < _CUBIC + 1 or not (places % 1.0).any():
        return places, rows
    scale = np.maximum(np.abs(rows).max(axis=0), _LEAST_SCALE * float(np.abs(rows).max()))
    is_smooth = np.array([_is_smooth(places, rows / scale, at) for at in range(len(places))])
    all_places, all_rows = [places[:1]], [rows[:1]]
    for at in range(len(places) - 1):
        if is_smooth[at] and is_smooth[at + 1]:
            near = _find_nearest(places, 0.5 * (places[at] + places[at + 1]))
            middle = _follow_cubic(places[near], rows[near], 0.5 * (places[at : at + 1] + places[at + 1 : at + 2]))
            aside = float((np.abs(middle[0] - 0.5 * (rows[at] + rows[at + 1])) / scale).max())
            count = min(int(np.ceil(np.sqrt(aside / PLACED))), _MOST_BETWEEN)
            between = np.linspace(places[at], places[at + 1], max(count, 1) + 1)[1:-1]
            all_places.append(between)
            all_rows.append(_follow_cubic(places[near], rows[near], between))
        all_places.append(places[at + 1 : at + 2])
        all_rows.append(rows[at + 1 : at + 2])
    return np.concatenate(all_places), np.concatenate(all_rows)


def _is_smooth(places: Array, rows: Array, at: int) -> bool:
    """True if a sample is on the cubic through the four nearest others."""
    others = np.delete(np.arange(len(places)), at)
    near = others[np.argsort(np.abs(places[others] - places[at]), kind="stable")[:_CUBIC]]
    return float(np.abs(_follow_cubic(places[near], rows[near], places[at : at + 1])[0] - rows[at]).max()) < _SMOOTH


def _find_nearest(places: Array, x: float) -> Array:
    return np.sort(np.argsort(np.abs(places - x), kind="stable")[:_CUBIC])


def _follow_cubic(places: Array, rows: Array, x: Array) -> Array:
    """The cubic through four rows, at places x (Lagrange)."""
    weights = np.ones((len(x), _CUBIC))
    for k, other in itertools.permutations(range(_CUBIC), 2):
        weights[:, k] *= (x - places[other]) / (places[k] - places[other])
    return weights @ rows


def simplify(places: Array, rows: Array, *, is_table: bool = False) -> list[int]:
    """The places that a polygon needs: those on the line between their neighbors are left out."""
    sizes = np.abs(rows)
    least = LEAST_SCALE if is_table else _LEAST_LARGEST
    scales = np.maximum(sizes if is_table else sizes.max(axis=1, keepdims=True, initial=0.0), least)
    keep = [0]
    for at in range(1, len(places) - 1):
        first, last = keep[-1], at + 1
        share = (places[at] - places[first]) / (places[last] - places[first])
        inside = np.arange(first + 1, last)
        shares = (places[inside] - places[first]) / (places[last] - places[first])
        lines = rows[first] + shares[:, None] * (rows[last] - rows[first])
        allowed = LINE * scales[inside] + _ROUNDED_ENDS * np.maximum(scales[first], scales[last])
        if not 0.0 < share < 1.0 or (np.abs(lines - rows[inside]) > allowed).any():
            keep.append(at)
    return [*keep, len(places) - 1]


def find_needed_places(samples: Mapping[float, Sample], places: list[float]) -> list[float]:
    """The places that the curves of all slots need; all where the structure is not the same everywhere."""
    group = [samples[x] for x in places]
    if len(places) < 3 or len({sample.structure for sample in group}) > 1:
        return places
    needed: set[int] = {0, len(places) - 1}
    for number in range(len(group[0].slots)):
        if len({len(sample.slots[number].numbers) for sample in group}) > 1:
            return places
        rows = np.array([sample.slots[number].numbers for sample in group])
        needed.update(simplify(np.array(places), rows, is_table=group[0].slots[number].is_table))
    return [places[at] for at in sorted(needed)]


def _choose_mode(record: Record, number: int, length: int, checks: list[Any]) -> str:
    """How curves are joined: "add", or "multiply" where that predicts the checks better."""
    errors = {"add": 0.0, "multiply": 0.0}
    for point, sample in checks:
        numbers = _pad(sample.slots[number].numbers, length)
        for mode in errors:
            errors[mode] += float(np.abs(read_slot(record, point, mode) - numbers).max(initial=0.0))
    return min(errors, key=lambda mode: errors[mode])


def measure_error(record: Record, number: int, checks: list[Any]) -> float:
    """The largest error of a slot at the checks, as a part of its largest number."""
    if not checks:
        return 0.0
    rows = np.array([_pad(sample.slots[number].numbers, len(record["base"])) for _, sample in checks])
    errors = np.abs(np.array([read_slot(record, point) for point, _ in checks]) - rows)
    is_table = checks[0][1].slots[number].is_table
    least = LEAST_SCALE if is_table else _LEAST_LARGEST
    return float((errors / np.maximum(_find_largest(rows, is_table=is_table), least)).max(initial=0.0))


def _find_largest(rows: Array, *, is_table: bool) -> Array:
    """What errors are parts of: the largest number of all rows, or of each column of tables, as they mix all units."""
    return np.asarray(np.abs(rows).max(axis=0 if is_table else None, initial=_LEAST_NUMBER))


def _pad(numbers: Array, length: int) -> Array:
    if len(numbers) == length:  # nearly always
        return numbers
    return np.pad(numbers, (0, max(length - len(numbers), 0)))


def _round(numbers: Array) -> list[float]:
    """Numbers with the digits of a 32-bit float, whole ones without a point."""
    short = (float(f"{number:.9g}") for number in numbers.tolist())
    return [int(number) if number == int(number) and abs(number) < _WHOLE_DOUBLES else number for number in short]
