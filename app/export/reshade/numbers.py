"""Writes how controls change the numbers of an effect, as code that draws them into a small picture once per frame."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
from msgspec import Struct, field

from ..engine_text import write_float
from ..package.curves import Record

Array = np.ndarray

ROW = 256
"""Cells in each row of the picture of numbers. A choice: 64 programs of four vectors take one row."""

_FOUR = 4
"""Numbers in each cell: the channels of a pixel."""


class _SlotNumbers(Struct, frozen=True):
    """The numbers of a slot as arrays, whose last axis counts them, by what the controls of an effect change."""

    base: Array
    curves: Sequence[tuple[Record, Array]]
    """With the numbers at each place of a knob."""
    grids: Sequence[tuple[Record, Array]]
    """With the numbers at each pair of places of two knobs."""
    is_product: bool
    is_whole: bool

    @staticmethod
    def read(record: Record, knobs: Mapping[str, str]) -> _SlotNumbers:
        """Those of a slot; what other knobs change is left out."""
        curves = [curve for curve in record.get("curves", ()) if curve["knob"] in knobs]
        grids = [grid for grid in record.get("grids", ()) if all(knob in knobs for knob in grid["knobs"])]
        return _SlotNumbers(
            np.array(record["base"], np.float64),
            [(curve, np.array(curve["values"], np.float64)) for curve in curves],
            [(grid, np.array(grid["values"], np.float64)) for grid in grids],
            record.get("mode") == "multiply",
            bool(record.get("whole")),
        )


class NumberPicture(Struct):
    """The slots that controls change, as cells of four numbers, and the code that computes them."""

    slots: Sequence[Record]
    knobs: Mapping[str, str]
    """The expression of each knob; knobs that are not here keep the value of the graph."""
    code: list[str] = field(default_factory=list[str])
    count: int = 0
    """Cells so far."""
    _first_cells: dict[tuple[int, int], int] = field(default_factory=dict[tuple[int, int], int])

    def changes(self, slot: int) -> bool:
        """Whether a control changes the numbers of a slot."""
        return any(curve["knob"] in self.knobs for curve in self.slots[slot].get("curves", ()))

    def find_numbers(self, slot: int) -> Array:
        """The numbers of a slot at the settings of the graph, rounded where they are whole."""
        record = self.slots[slot]
        numbers = np.array(record["base"], np.float64)
        return np.rint(numbers) if record.get("whole") else numbers

    def add_slot(self, slot: int, width: int) -> int:
        """The first cell of a slot; each cell has `width` of its numbers."""
        key = slot, width
        if key not in self._first_cells:
            self._first_cells[key] = self.count
            numbers = _SlotNumbers.read(self.slots[slot], self.knobs)
            for at in range(0, len(numbers.base), width):
                self._write_cell(numbers, at, width)
        return self._first_cells[key]

    def write(self) -> list[str]:
        """The texture, the function that reads a cell, and the pass that draws it; nothing if no control does."""
        if not self.count:
            return []
        rows = -(-self.count // ROW)
        head = [
            f"texture2D Numbers {{ Width = {ROW}; Height = {rows}; Format = RGBA32F; }};",
            "sampler2D NumbersSampler { Texture = Numbers; MinFilter = POINT; MagFilter = POINT; MipFilter = POINT; };",
            f"float4 number(int cell) {{ return FETCH(NumbersSampler, cell % {ROW}, cell / {ROW}); }}",
        ]
        choices = [f"    if (cell == {cell}) {{ return cell_{cell}(); }}" for cell in range(self.count)]
        return [
            *head,
            *self.code,
            "float4 draw_numbers(float4 position : SV_Position) : SV_Target {",
            f"    int cell = int(position.y) * {ROW} + int(position.x);",
            *choices,
            "    return float4(0.0, 0.0, 0.0, 0.0);",
            "}",
        ]

    def _write_cell(self, numbers: _SlotNumbers, at: int, width: int) -> None:
        def take(rows: Array) -> Array:
            part = rows[..., at : at + width]
            return np.pad(part, [(0, 0)] * (part.ndim - 1) + [(0, _FOUR - part.shape[-1])])

        base = take(numbers.base)
        lines = [f"    float4 base = {write_four(base)}, sum = base;"]
        for curve, whole_rows in numbers.curves:
            rows = take(whole_rows)
            if np.abs(rows - base).max() > 0.0:
                row = self._write_curve(curve, rows)
                if numbers.is_product:  # where the base is 0 there is no ratio, and the number is added
                    zeros = write_four((base == 0.0).astype(np.float64))
                    lines.append(f"    {{ float4 row = {row}; sum = sum * relative(row, base) + row * {zeros}; }}")
                else:
                    lines.append(f"    sum += {row} - base;")
        for grid, whole_rows in numbers.grids:
            lines += self._write_grid(grid, take(whole_rows))
        lines.append("    return floor(sum + 0.5);" if numbers.is_whole else "    return sum;")
        self.code += [f"float4 cell_{self.count}() {{", *lines, "}"]
        self.count += 1

    def _write_curve(self, curve: Record, rows: Array) -> str:
        """The row at the value of a knob: the first row, and the part of each step behind it; or the nearest row."""
        places, x = curve["at"], self.knobs[curve["knob"]]
        if curve.get("snap"):
            text = write_four(rows[-1])
            for at in range(len(places) - 2, -1, -1):
                middle = (places[at] + places[at + 1]) / 2.0
                text = f"({x} <= {write_float(middle)} ? {write_four(rows[at])} : {text})"
            return text
        steps = [
            f" + part({x}, {write_float(low)}, {write_float(high)}) * {write_four((after - before) / (high - low))}"
            for (low, high), (before, after) in zip(itertools.pairwise(places), itertools.pairwise(rows), strict=True)
            if np.abs(after - before).max() > 0.0
        ]
        return f"({write_four(rows[0])}{''.join(steps)})"

    def _write_grid(self, grid: Record, rows: Array) -> list[str]:
        """Lines that add the number between four places: polygons along the second knob, joined along the first one."""
        (xs, ys), (first, second) = grid["at"], grid["knobs"]
        if np.abs(rows).max() == 0.0:
            return []
        curves = [self._write_curve({"at": ys, "knob": second}, line) for line in rows]
        x = self.knobs[first]
        lines = [f"    {{ float4 here = {curves[0]};"]
        for (low, high), curve in zip(itertools.pairwise(xs), curves[1:], strict=True):
            share = f"part({x}, {write_float(low)}, {write_float(high)}) / {write_float(high - low)}"
            lines.append(f"    here = lerp(here, {curve}, {share});")
        return [*lines, "    sum += here; }"]


def write_four(numbers: Array) -> str:
    """Four numbers as a vector."""
    return f"float4({', '.join(map(write_float, numbers))})"
