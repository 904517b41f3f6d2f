"""Writes and applies tables of colors, by OpenColorIO.

A table of three dimensions has even steps, and light has not: half of all steps would lie above half of the brightest
light. So a *shaper* precedes the table of linear light: a curve that is straight near black and logarithmic above.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from msgspec import Struct

from ..resources.input_files import check_file
from ..resources.sandbox import Sandbox
from .config_files import check_table
from .management import load_ocio
from .transforms import Array

TOE = 16.0
"""How steep a shaper is at black: log2(1 + 16 x). Of 16, 64, 256 and 1024, 16 has the least errors for the preset
agx_look, up to light of 16: 0.011 at most, 0.0003 on average."""

SHAPER_DENSITY = 1024
"""Steps of a shaper in a .cube for each unit of light: they are even, and light of a thousandth is nearly black."""

MAX_SHAPER_STEPS = 65536
"""The most steps of a shaper that DaVinci Resolve reads (Cube LUT Specification 1.0, Adobe 2013)."""


class Shaper(Struct, frozen=True):
    """The curve before a table: from numbers of the range to 0 .. 1. `is_log` is False where the steps are even."""

    low: float
    high: float
    is_log: bool

    def decode(self, places: Array) -> Array:
        """The numbers at places between 0 and 1."""
        if self.is_log:
            places = (np.exp2(places * self._octaves) - 1.0) / TOE
            return places + self.low
        return places * (self.high - self.low) + self.low

    def make_transform(self) -> Any:
        """The curve as a transform of OpenColorIO, from numbers to places."""
        api = load_ocio()
        if self.is_log:
            return api.LogAffineTransform(
                logSideSlope=[1.0 / self._octaves] * 3,
                logSideOffset=[0.0] * 3,
                linSideSlope=[TOE] * 3,
                linSideOffset=[1.0 - self.low * TOE] * 3,
            )
        return api.RangeTransform(minInValue=self.low, maxInValue=self.high, minOutValue=0.0, maxOutValue=1.0)

    @property
    def _octaves(self) -> float:
        return math.log2(1.0 + (self.high - self.low) * TOE)


class ColorTable(Struct, frozen=True, eq=False):
    """A table of colors [red, green, blue, 3] behind a shaper."""

    shaper: Shaper
    colors: Array

    @property
    def side(self) -> int:
        """How many colors it has along each side."""
        return self.colors.shape[0]


def list_lattice(shaper: Shaper, side: int) -> Array:
    """The colors that a table is asked for, as float32 [red, green, blue, 3]."""
    places = shaper.decode(np.linspace(0.0, 1.0, side)).astype(np.float32)
    return np.stack(np.meshgrid(places, places, places, indexing="ij"), axis=-1)


def write_cube(table: ColorTable) -> bytes:
    """The text of a .cube: of DaVinci Resolve, with its shaper, or of Iridas where the steps are even from 0 to 1."""
    api = load_ocio()
    config = api.Config.CreateRaw()
    group, shaped = _make_group(table), [table.shaper.make_transform()]
    for name, transforms in (("light", []), ("shaped", shaped), ("look", [group])):
        space = api.ColorSpace(name=name)
        if transforms:
            whole = api.GroupTransform(transforms)
            space.setTransform(whole, api.COLORSPACE_DIR_FROM_REFERENCE)
        config.addColorSpace(space)
    baker = api.Baker()
    baker.setConfig(config)
    baker.setInputSpace("light")
    baker.setTargetSpace("look")
    baker.setCubeSize(table.side)
    if table.shaper.is_log:
        baker.setFormat("resolve_cube")
        baker.setShaperSpace("shaped")
        baker.setShaperSize(min(math.ceil((table.shaper.high - table.shaper.low) * SHAPER_DENSITY), MAX_SHAPER_STEPS))
    else:
        baker.setFormat("iridas_cube")
    return str(baker.bake()).encode()


def write_clf(table: ColorTable) -> bytes:
    """The text of a file in the Common LUT Format: the shaper as an exact formula, and the table."""
    api = load_ocio()
    text = _make_group(table).write("Academy/ASC Common LUT Format", api.Config.CreateRaw())
    return str(text).encode()


def apply_table_file(path: str | Path, colors: Array, sandbox: Sandbox) -> Array:
    """The colors [..., 3] behind a table in a file, which OpenColorIO reads and applies on the processor."""
    api = load_ocio()
    api.ClearAllCaches()
    check_table(str(path), sandbox)
    transform = api.FileTransform(str(check_file(path, sandbox)), interpolation=api.INTERP_TETRAHEDRAL)
    processor = api.Config.CreateRaw().getProcessor(transform).getDefaultCPUProcessor()
    changed = np.ascontiguousarray(colors, np.float32).reshape(-1, 3).copy()
    processor.applyRGB(changed)
    return changed.reshape(colors.shape)


def _make_group(table: ColorTable) -> Any:
    """The shaper and the table as one transform."""
    api = load_ocio()
    cube = api.Lut3DTransform(table.side)
    cube.setInterpolation(api.INTERP_TETRAHEDRAL)
    cube.setFileOutputBitDepth(api.BIT_DEPTH_F32)
    cube.setData(np.ascontiguousarray(table.colors, np.float32).reshape(-1))
    return api.GroupTransform([table.shaper.make_transform(), cube])
