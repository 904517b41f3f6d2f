"""Exports what a graph does to colors as a table (LUT).

The graph is rendered once, over a picture that has every color of the table, so all nodes are right by construction.
`color_function` makes sure first that nothing but the color decides what a pixel becomes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from halation.nodes import Kind

from ..color.lut_files import (
    MAX_SHAPER_STEPS,
    SHAPER_DENSITY,
    ColorTable,
    Shaper,
    apply_table_file,
    list_lattice,
    write_clf,
    write_cube,
)
from ..color.transforms import decode_srgb, encode_srgb
from ..compiler import Request
from ..compiler.lowering.lower import lower
from ..compiler.planner import graph_library
from ..errors import GraphError, UsageError
from ..media.pictures.table_strip import read_table_strip, write_table_strip
from ..renderer import RenderRequest
from ..resources.atomic_write import write_bytes_atomically
from .color_function import find_color_input
from .order import ExportOrder, ExportReport

_OPAQUE = 1e-4
"""How far from 1 the alpha of opaque colors may be: what the rounding of floats may have added. Chosen by judgement."""

_GRAY_PART = 8
"""One of so many test colors is gray, which most looks treat in its own way. Chosen by judgement."""

_CHECK_WIDTH = 1024
"""Colors in a row of the picture that is measured: any number gives the same."""

USUAL_HIGH = 16.0
"""The brightest light of a table where no picture says it: a white wall in the sun is 1, so four stops above it."""

SIDES = (2, 129)
"""The smallest and the largest side of a table that OpenColorIO reads."""

TEST_COLORS = 65536
"""Colors of the test picture, for a table without a picture: the largest error of so many changes by a few percent from
one set to another."""

Array = np.ndarray


def export_cube(order: ExportOrder) -> ExportReport:
    """Write a .cube. Raises GraphError where the picture is no function of color alone."""
    return _TableExport(order, "linear", MAX_SHAPER_STEPS / SHAPER_DENSITY).export_text(write_cube)


def export_clf(order: ExportOrder) -> ExportReport:
    """Write a file in the Common LUT Format. Raises GraphError as `export_cube`."""
    return _TableExport(order, "linear").export_text(write_clf)


def export_strip(order: ExportOrder) -> ExportReport:
    """Write a picture of a table of display codes. Raises GraphError as `export_cube`."""
    return _TableExport(order, "srgb").export_strip()


class _TableExport:
    """One table: its renderer, the input that it changes, and its range."""

    def __init__(self, order: ExportOrder, usual_encoding: str, limit: float = math.inf) -> None:
        self.order, self.limit = order, limit
        self.encoding = order.table.encoding or usual_encoding
        if not SIDES[0] <= order.table.side <= SIDES[1]:
            raise UsageError(f"--lut-size {order.table.side}: give a number from {SIDES[0]} to {SIDES[1]}")
        self.renderer = order.open_renderer()
        self.frame = order.frame if order.frame is not None else (order.graph.settings.frames or (1, 1))[0]
        self.notes: list[str] = []
        self.input = self._find_input()
        self.picture = self._read_picture()
        self.shaper = self._choose_shaper()

    def export_text(self, write: Callable[[ColorTable], bytes]) -> ExportReport:
        """Bake the table and write it as text."""
        assert self.order.output is not None
        write_bytes_atomically(self.order.output, write(self._bake()), sandbox=self.order.sandbox)
        path = str(self.order.output)
        return self._report(lambda colors: apply_table_file(path, colors, self.order.sandbox))

    def export_strip(self) -> ExportReport:
        """Bake the table and write it as a picture."""
        assert self.order.output is not None
        if self.encoding != "srgb":
            raise UsageError("--encoding linear: a picture holds numbers from 0 to 1, so use srgb, or write a .cube")
        path = self.order.output
        write_table_strip(path, self._bake().colors, self.order.sandbox)
        return self._report(lambda colors: _apply_colors(read_table_strip(path, self.order.sandbox), colors))

    def _find_input(self) -> str:
        order, bindings = self.order, dict[str, Array]()
        for name, end in order.graph.inputs.items():
            bindings[name] = np.zeros((1, 1, end.width), np.float32)
        pictures = self.renderer.pictures
        request = Request({"table": order.target}, pictures.bind(order.graph, bindings), frame=self.frame)
        library = graph_library(order.graph, pictures)
        program = lower(order.graph, request, library, pictures).program
        name = find_color_input(program, program.outputs["table"], library)
        if order.graph.inputs[name].kind is not Kind.IMAGE:
            raise GraphError(f"input '{name}' has no color: a table changes the color of an Image")
        if order.graph.animation:
            self.notes.append(f"values of the graph are animated: the table holds frame {self.frame}")
        return name

    def _read_picture(self) -> Array | None:
        """The colors [pixels, 3] of the input's picture, encoded; None where the user names none."""
        if self.input not in self.order.inputs:
            return None
        from ..graph import INPUTS, Port

        targets = {"picture": Port(INPUTS, self.input)}
        request = RenderRequest({self.input: self.order.inputs[self.input]}, targets, frame=self.frame)
        pixels = self.renderer.render(self.order.graph, request)["picture"].astype(np.float32)
        covered = pixels[..., 3] > 0.0
        return self._encode(pixels[covered][:, :3] / pixels[covered][:, 3:])

    def _choose_shaper(self) -> Shaper:
        """Even steps for display codes, which are from 0 to 1; a logarithm for light, up to that of the picture."""
        options = self.order.table
        if self.encoding == "srgb":
            if (options.low, options.high) not in ((None, None), (0.0, 1.0)):
                raise UsageError("--range: display codes are from 0 to 1; only --encoding linear has another range")
            return Shaper(0.0, 1.0, is_log=False)
        low, high = 0.0, USUAL_HIGH
        if self.picture is not None and self.picture.size:
            low = min(0.0, float(self.picture.min()))
            high = 2.0 ** math.ceil(math.log2(max(float(self.picture.max()), 1.0)))
            if high > self.limit:
                self.notes.append(f"light above {self.limit:g} becomes {self.limit:g}: a .clf has no such limit")
                high = self.limit
        low = low if options.low is None else options.low
        high = high if options.high is None else options.high
        if not low < high:
            raise UsageError(f"--range {low:g},{high:g}: the first number must be less than the second one")
        return Shaper(low, high, is_log=True)

    def _bake(self) -> ColorTable:
        side = self.order.table.side
        lattice = list_lattice(self.shaper, side)
        return ColorTable(
            self.shaper, self._render_colors(lattice.reshape(side, side * side, 3)).reshape(lattice.shape)
        )

    def _render_colors(self, codes: Array) -> Array:
        """What the graph makes of opaque colors [height, width, 3], encoded as those of the table."""
        order = self.order
        height, width, _ = codes.shape
        pixels = np.ones((height, width, 4), np.float32)
        pixels[..., :3] = self._decode(codes)
        bindings: dict[str, Array] = {}
        for name, end in order.graph.inputs.items():
            channels = end.width
            bindings[name] = pixels if name == self.input else np.zeros((height, width, channels), np.float32)
        request = RenderRequest(bindings, {"table": order.target}, (width, height), frame=self.frame, precision="float")
        colors = self.renderer.render(order.graph, request)["table"].astype(np.float32)
        if colors.shape[2] < 3:
            raise GraphError("the picture has no color: a table holds red, green and blue")
        if colors.shape[2] == 4 and np.abs(colors[..., 3] - 1.0).max() > _OPAQUE:
            raise GraphError("the graph makes opaque colors transparent, and a table of colors holds no alpha")
        return self._encode(np.nan_to_num(colors[..., :3]))

    def _report(self, apply: Callable[[Array], Array]) -> ExportReport:
        figures: dict[str, float | str] = {
            "encoding": self.encoding,
            "shaper": "logarithm" if self.shaper.is_log else "none",
            "low": self.shaper.low,
            "high": self.shaper.high,
            "side": self.order.table.side,
        }
        if self.order.table.checks:
            figures |= self._measure_errors(apply)
        return ExportReport((str(self.order.output),), tuple(self.notes), figures)

    def _measure_errors(self, apply: Callable[[Array], Array]) -> dict[str, float | str]:
        """The largest and the mean difference between the graph and the table in the file."""
        colors = self.picture
        if colors is None or not colors.size:
            places = np.random.default_rng(1).random((TEST_COLORS, 3))
            places[: TEST_COLORS // _GRAY_PART] = places[: TEST_COLORS // _GRAY_PART, :1]
            colors = self.shaper.decode(places).astype(np.float32)
        colors = colors.reshape(1, -1, 3)
        width = _CHECK_WIDTH
        count = -(-colors.shape[1] // width) * width
        rows = np.resize(colors, (1, count, 3)).reshape(-1, width, 3)
        errors = np.abs(apply(rows) - self._render_colors(rows)).reshape(-1, 3)[: colors.shape[1]]
        return {
            "picture": self.order.inputs.get(self.input, f"{TEST_COLORS} colors at random"),
            "largest error": float(errors.max()),
            "mean error": float(errors.mean()),
        }

    def _encode(self, light: Array) -> Array:
        if self.encoding == "linear":
            return light
        return np.clip(encode_srgb(light), 0.0, 1.0).astype(np.float32)

    def _decode(self, codes: Array) -> Array:
        return codes if self.encoding == "linear" else decode_srgb(codes)


def _apply_colors(table: Array, codes: Array) -> Array:
    """Codes behind a table, interpolated along the three axes, as a texture unit does."""
    side = table.shape[0]
    places = np.clip(codes, 0.0, 1.0) * (side - 1)
    corner = np.minimum(places.astype(int), side - 2)
    rest = (places - corner)[..., None]
    mixed = np.zeros(codes.shape, np.float64)
    for offset in np.ndindex(2, 2, 2):
        at = corner + np.array(offset)
        weight = np.where(np.array(offset)[:, None] == 1, rest, 1.0 - rest).prod(axis=-2)
        mixed += weight * table[at[..., 0], at[..., 1], at[..., 2]]
    return mixed
