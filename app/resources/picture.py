"""Pixels from outside of a graph, named before they are read."""

from __future__ import annotations

from typing import ClassVar

from halation.nodes import ColorSettings, Kind
from msgspec import Struct, field

from .record import Record

MAX_OVERSCAN = 2.0
"""The largest overscan in heights of the frame. A picture of 16:9 then has eleven times the pixels of its frame, if
somebody reads them all. Chosen by judgement: plates and renders are made with a tenth, rarely with a half."""

MAX_SIDE = 1 << 17
"""Pixels on the longest side of a picture or canvas (docs/security.md): four times the largest texture of today's GPUs
(32768). A longer side in a file is a damaged header."""

LARGE_PICTURE = 2**24
"""Pixels from which on a proxy of a file is made while it is read: in half floats they fill a quarter of the editor's
first budget for pictures, 512 MiB. Chosen by judgement: with half as many, proxies of UHD pictures change a little."""

PixelRectangle = tuple[int, int, int, int]
"""A rectangle of pixels: x, y, width and height. The top left pixel of a frame is (0, 0)."""


class NumberTable(Struct, frozen=True):
    """Numbers that a node made, as pixels of four channels: floats of 32 bits in the order of bytes of the machine.

    Bytes, because what is written of a plan must not depend on the process that has made it.
    """

    height: int
    width: int
    content: bytes


class Picture(Record, frozen=True):
    """Pixels from outside: a layer of a file, or an array bound to an input (then `path` is the input's name).

    `frame` is that of a video, whose file holds all of them; of a picture it is 1. `pixels` is that array, which the
    compiler never looks at: a plan has all that it needs to run. `space` is what color in a file is in, "" to find out;
    `color` says how colors are managed. With a folder `within` the file must lie in it, links followed. Rows of it can
    be read alone if it is `by_rows`; `rows` are those that are read, the first and the one after the last, None
    for all. With `overscan`, pixels around its frame are read as well, where a file has them. With a `reduction` of n,
    squares of n x n pixels are read as one: their mean, of data the pixel in the middle.
    """

    path: str
    layer: str
    kind: Kind
    width: int
    in_memory: bool = False
    pixels: object = None
    frame: int = 1
    space: str = ""
    color: ColorSettings = field(default_factory=ColorSettings)
    within: str = ""
    by_rows: bool = False
    rows: tuple[int, int] | None = None
    overscan: bool = False
    reduction: int = 1

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"pixels"})
