"""Contact sheets: pictures side by side, with their names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import numpy as np
import OpenImageIO as oiio
from msgspec import Struct

from ...color.display import to_display
from ...color.transforms import Array, decode_srgb, encode_srgb
from ...errors import OutputError
from ...resources.atomic_write import write_atomically
from ...resources.sandbox import Sandbox

RGB = tuple[float, float, float]

_MARGIN = 16
_GAP = 12
_RADIUS = 5.0
_RULE = 2
"""Pixels around a sheet, between its cells, of their round corners, and of its lines. Chosen by eye for cells of 320 to
480 pixels."""
_BACKGROUND = (0.08, 0.08, 0.086)
_TILE_COLOR = (0.115, 0.115, 0.125)
_DIM = (0.70, 0.70, 0.73)
_TEXT = (0.90, 0.90, 0.91)
_CHECKER = (0.20, 0.28)
_SQUARE = 12
"""Colors of the sheet and pixels of a square of the checkerboard: chosen by eye. The background is dark and neutral, so
that it does not change how the pictures look."""
_BOLD = "DroidSans-Bold"
_ROWS = 256
"""Rows of a sheet that are converted at a time: the sheet of all nodes has 7,796, and each step in between is as large
as what it converts."""
_QUALITY = 82
"""JPEG quality of sheets, on the scale of libjpeg. Chosen by eye: no blocks are visible at 1:1, and the sheets in the
documentation take a third less than at 95."""


def show_light(array: Array, view: str = "") -> Array:
    """Scene-linear pixels as display values, [h, w, 3] of float32 within 0..1: the pictures of sheets.

    Raises:
        UsageError: unknown view.
    """
    return decode_srgb(np.clip(to_display(array, view, bits=32)[..., :3], 0.0, 1.0))


def show_any_light(array: Array) -> Array:
    """The same for any number of channels: one is gray, two are red and green."""
    return show_light(_three(array.astype(np.float32)))


def show_over_checker(array: Array, view: str = "") -> Array:
    """The same for RGBA, with a checkerboard behind transparent pixels. Light without alpha lies on top of it."""
    light, alpha = show_light(array, view), np.clip(np.nan_to_num(array[..., 3:4].astype(np.float32)), 0.0, 1.0)
    row, column = np.indices(light.shape[:2]) // _SQUARE
    behind = decode_srgb(np.array(_CHECKER, np.float32))[(row + column) % 2][..., None]
    over = light * np.where(alpha > 0.0, alpha, 1.0) + behind * (1.0 - alpha)
    return np.clip(over, 0.0, 1.0).astype(np.float32)


def show_data(array: Array, low: float, high: float) -> Array:
    """Data as display values: `low` is black and `high` is white; one channel is gray, two are red and green."""
    codes = np.clip((np.nan_to_num(array.astype(np.float32)) - low) / (high - low), 0.0, 1.0)
    return decode_srgb(_three(codes)).astype(np.float32)


def make_caption(light: Array, lines: Sequence[str]) -> Array:
    """A darkened picture behind lines of text: for results that are numbers."""
    height, width = light.shape[:2]
    paper, letters = oiio.ImageBuf(_encode_shown(light * 0.06)), height // 9
    top = height / 2 - (len(lines) - 1) * letters * 0.75
    for index, line in enumerate(lines):
        at = (width // 2, round(top + index * letters * 1.5))
        oiio.ImageBufAlgo.render_text(paper, *at, line, letters, "", _TEXT, "center", "center")
    return _read_light(paper)


def make_sheet(pictures: Mapping[str, Array], columns: int = 4, width: int = 0) -> Array:
    """A sheet of pictures by name, [h, w, 3] of float32; all are display values.

    The first picture is scaled to `width` if that is not 0; the others get its scale, or fit into its cell.
    """
    return make_grouped_sheet({"": pictures}, columns, width)


def make_grouped_sheet(
    groups: Mapping[str, Mapping[str, Array]],
    columns: int = 4,
    width: int = 0,
    *,
    letters: int = 15,
    colors: Mapping[str, RGB] = MappingProxyType({}),
) -> Array:
    """The same for pictures by group and name, under headings with rules in these `colors` (sRGB) by group.

    A small group stands beside others, in the first row with room for it. `letters` is the size of names in pixels.
    """
    first = next(picture for group in groups.values() for picture in group.values())
    width = width or first.shape[1]
    layout = _SheetLayout(
        {name: len(group) for name, group in groups.items()}, columns, (width, _height_at(first, width)), letters
    )
    canvas = np.full((*layout.size[::-1], 3), _BACKGROUND, np.float32)
    for name, group in groups.items():
        for (left, top), picture in zip(layout.cells(name), group.values(), strict=True):
            _paste(canvas, _scale_to_fit(picture, layout.cell, width / first.shape[1]), left, top, layout.cell)
        if name:
            left, top, across = layout.rule(name)
            canvas[top : top + _RULE, left : left + across] = colors.get(name, _DIM)
    paper = oiio.ImageBuf(canvas)
    del canvas  # a copy was made, and the sheet of all nodes has 150 MB
    for name, group in groups.items():
        for (left, top), title in zip(layout.cells(name), group, strict=True):
            _label(paper, title, left, top + layout.cell[1] + round(1.3 * letters), layout.cell[0], letters)
        if name:
            left, top, _ = layout.rule(name)
            oiio.ImageBufAlgo.render_text(paper, left, top - letters // 2, _spell_out(name), letters + 3, _BOLD, _TEXT)
    return _read_light(paper)


def make_grid_sheet(
    rows: Sequence[Sequence[Array]],
    down: Sequence[str],
    across: Sequence[str],
    *,
    width: int = 0,
    title: str = "",
    letters: int = 16,
) -> Array:
    """The same for pictures by row and column, with headings: `down` and `across`."""
    first = rows[0][0]
    width = width or first.shape[1]
    cell = (width, _height_at(first, width))
    room = max(oiio.ImageBufAlgo.text_size(_spell_out(text), letters).width for text in down) + 2 * _GAP
    head = _MARGIN + (3 * letters if title else 0) + 2 * letters
    left, top = _MARGIN + room, head + _GAP // 2
    size = (left + len(across) * (cell[0] + _GAP) - _GAP + _MARGIN, top + len(down) * (cell[1] + _GAP) - _GAP + _MARGIN)
    canvas = np.full((*size[::-1], 3), _BACKGROUND, np.float32)
    x_at = [left + column * (cell[0] + _GAP) for column in range(len(across))]
    y_at = [top + row * (cell[1] + _GAP) for row in range(len(down))]
    for y, row in zip(y_at, rows, strict=True):
        for x, picture in zip(x_at, row, strict=True):
            _paste(canvas, _scale_to_fit(picture, cell, width / first.shape[1]), x, y, cell)
    if title:
        canvas[_MARGIN + 2 * letters : _MARGIN + 2 * letters + _RULE, _MARGIN : size[0] - _MARGIN] = _DIM
    paper, draw = oiio.ImageBuf(canvas), oiio.ImageBufAlgo.render_text
    del canvas  # as in the other sheets
    if title:
        draw(paper, _MARGIN, _MARGIN + round(1.3 * letters), _spell_out(title), letters + 3, _BOLD, _TEXT)
    for text, x in zip(across, x_at, strict=True):
        _label(paper, text, x, head - letters // 3, cell[0], letters)
    for text, y in zip(down, y_at, strict=True):
        draw(paper, left - _GAP, y + cell[1] // 2, _spell_out(text), letters, "", _DIM, "right", "center")
    return _read_light(paper)


def write_sheet(path: str | Path, light: Array, description: str = "", *, sandbox: Sandbox) -> None:
    """Write a sheet as JPEG, small enough for a page. Raises OutputError."""
    height, width, channels = light.shape
    pixels = np.empty((height, width, channels), np.uint8)
    for top in range(0, height, _ROWS):
        pixels[top : top + _ROWS] = _encode_shown(light[top : top + _ROWS]) * 255.0 + 0.5
    spec = oiio.ImageSpec(width, height, channels, "uint8")
    spec.attribute("compression", f"jpeg:{_QUALITY}")
    spec.attribute("jpeg:subsampling", "4:2:0")
    spec.attribute("ImageDescription", description)

    def encode(file: str) -> None:
        output = oiio.ImageOutput.create("jpeg")
        succeeded = output is not None and output.open(file, spec) and output.write_image(pixels)
        if output is None or not (output.close() and succeeded):
            raise OutputError(f"{path}: cannot be written: {oiio.geterror() or 'the encoder gave no reason'}")

    write_atomically(path, encode, pixels.nbytes, sandbox=sandbox)


class _SheetLayout(Struct, frozen=True):
    """The layout of a sheet, in (left, top) of pixels. `counts` are pictures by group, `cell` is the size of one."""

    counts: Mapping[str, int]
    columns: int
    cell: tuple[int, int]
    letters: int

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the sheet."""
        across = min(self.columns, max(first + self.counts[name] for shelf in self._shelves() for name, first in shelf))
        down = _MARGIN + sum(self._shelf_height(shelf) for shelf in self._shelves())
        return 2 * _MARGIN + across * (self.cell[0] + _GAP) - _GAP, down + _MARGIN - _GAP

    def cells(self, group: str) -> Iterator[tuple[int, int]]:
        """The places of all pictures of a group."""
        first, top = self._find_shelf(group)
        for index in range(self.counts[group]):
            row, column = divmod(first + index, self.columns) if not first else (0, first + index)
            yield _MARGIN + column * (self.cell[0] + _GAP), top + self._head + row * self._row

    def rule(self, group: str) -> tuple[int, int, int]:
        """Left end, top and length of the line under a heading."""
        first, top = self._find_shelf(group)
        pictures = min(self.counts[group], self.columns)
        left = _MARGIN + first * (self.cell[0] + _GAP)
        return left, top + self._head - self.letters, pictures * (self.cell[0] + _GAP) - _GAP

    @property
    def _row(self) -> int:
        return self.cell[1] + 2 * self.letters + _GAP

    @property
    def _head(self) -> int:
        return 3 * self.letters if any(self.counts) else 0

    def _shelves(self) -> list[list[tuple[str, int]]]:
        """The groups of each shelf, each with its first column; a group that takes several rows has a shelf for
        itself."""
        shelves: list[list[tuple[str, int]]] = []
        for name, count in self.counts.items():
            columns_used = [sum(self.counts[member] for member, _ in shelf) for shelf in shelves]
            free = next((index for index, part in enumerate(columns_used) if part + count <= self.columns), None)
            if free is None:
                shelves.append([(name, 0)])
            else:
                shelves[free].append((name, columns_used[free]))
        return shelves

    def _shelf_height(self, shelf: Sequence[tuple[str, int]]) -> int:
        return self._head + -(-self.counts[shelf[0][0]] // self.columns) * self._row

    def _find_shelf(self, group: str) -> tuple[int, int]:
        """The first column of a group, and the top of its shelf."""
        top = _MARGIN
        for shelf in self._shelves():
            if group in dict(shelf):
                return dict(shelf)[group], top
            top += self._shelf_height(shelf)
        raise KeyError(group)


def _paste(canvas: Array, picture: Array, left: int, top: int, cell: tuple[int, int]) -> None:
    """Put a picture into the middle of its cell, whose corners are round."""
    tile = np.full((cell[1], cell[0], 3), _TILE_COLOR, np.float32)
    height, width = picture.shape[:2]
    y, x = (cell[1] - height) // 2, (cell[0] - width) // 2
    tile[y : y + height, x : x + width] = _encode_shown(picture)
    inside = [np.minimum(np.arange(side), np.arange(side)[::-1]) + 0.5 for side in (cell[1], cell[0])]
    dy, dx = np.meshgrid(*(np.maximum(_RADIUS - distance, 0.0) for distance in inside), indexing="ij")
    cover = np.clip(_RADIUS + 0.5 - np.hypot(dx, dy), 0.0, 1.0).astype(np.float32)[..., None]
    region = canvas[top : top + cell[1], left : left + cell[0]]
    region += (tile - region) * cover


def _label(paper: oiio.ImageBuf, title: str, left: int, baseline: int, room: int, letters: int) -> None:
    """A name, in smaller letters if it is long."""
    text = _spell_out(title)
    while letters > 8 and oiio.ImageBufAlgo.text_size(text, letters).width > room:
        letters -= 1
    oiio.ImageBufAlgo.render_text(paper, left, baseline, text, letters, "", _DIM)


def _scale_to_fit(light: Array, cell: tuple[int, int], scale: float) -> Array:
    """The picture at this scale, or the largest that fits into the cell."""
    scale = min(scale, cell[0] / light.shape[1], cell[1] / light.shape[0])
    width, height = (max(1, round(scale * side)) for side in light.shape[1::-1])
    width, height = min(width, cell[0]), min(height, cell[1])
    source = np.ascontiguousarray(light, np.float32)
    if source.shape[:2] == (height, width):
        return source
    resized = oiio.ImageBufAlgo.resize(
        oiio.ImageBuf(source), filtername="catmull-rom", roi=oiio.ROI(0, width, 0, height)
    )
    return np.clip(np.asarray(resized.get_pixels(oiio.FLOAT), np.float32), 0.0, 1.0)


def _three(array: Array) -> Array:
    if array.shape[2] == 2:
        return np.pad(array, ((0, 0), (0, 0), (0, 1)))
    return array[..., [0, 0, 0]] if array.shape[2] == 1 else array[..., :3]


def _height_at(picture: Array, width: int) -> int:
    return round(width * picture.shape[0] / picture.shape[1])


def _spell_out(name: str) -> str:
    return name.replace("_", " ")


def _encode_shown(light: Array) -> Array:
    """sRGB values of light, as far as a screen shows it."""
    return encode_srgb(np.clip(light, 0.0, 1.0)).astype(np.float32)


def _read_light(paper: oiio.ImageBuf) -> Array:
    """The display values of what was drawn in sRGB."""
    light = np.empty((paper.spec().height, paper.spec().width, paper.nchannels), np.float32)
    for top in range(0, len(light), _ROWS):
        roi = oiio.ROI(0, light.shape[1], top, min(top + _ROWS, len(light)))
        light[top : top + _ROWS] = decode_srgb(np.asarray(paper.get_pixels(oiio.FLOAT, roi)))
    return light
