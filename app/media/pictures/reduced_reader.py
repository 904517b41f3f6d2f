"""Reads large pictures smaller than they are, without ever holding all of their pixels."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from halation.nodes import Kind
from msgspec.structs import replace

from ...color.transforms import Array
from ...resources.sandbox import Sandbox
from ..convert import LayerRequest, Pixels
from ..info import read_info
from .row_reader import read_rows

_BAND = 2**21
"""Pixels that are read at a time by each thread: 16 MiB of half floats. Each band opens the file again, which costs
nothing beside it, and reads some rows around itself; with half as many, twice as many rows are decoded in vain."""
_THREADS = 2
"""Threads that read bands: while one decodes, the other makes its band smaller, which is half of the work."""


def read_reduced(path: str, request: LayerRequest, reduction: int, sandbox: Sandbox) -> Pixels:
    """What `read_layer` returns, with one pixel for each square of `reduction` x `reduction`, of a file `by_rows`.

    A pixel of an Image is the mean of its square, in light; of data, which must not be mixed, it is the pixel in the
    middle. Where the last square reaches beyond the picture, this goes on as it ends; less than half a square is left
    out.

    Raises:
        InputError: as `read_layer`.
    """
    width, height = read_info(path, sandbox=sandbox).size
    across, count = (max(1, round(side / reduction)) for side in (width, height))
    step = max(1, _BAND // (width * reduction))

    def read_band(first: int) -> Pixels:
        last = min(first + step, count)
        band = read_rows(path, request, first * reduction, min(last * reduction, height), sandbox)
        rows = _set_length(band.array, (last - first) * reduction)
        squares = _set_length(rows.swapaxes(0, 1), across * reduction).swapaxes(0, 1)
        reduced = _average(squares, reduction) if request.kind is Kind.IMAGE else _pick(squares, reduction)
        return replace(band, array=reduced)

    with ThreadPoolExecutor(_THREADS, thread_name_prefix="reduce") as threads:
        bands = list(threads.map(read_band, range(0, count, step)))
    return replace(
        bands[0],
        array=np.concatenate([band.array for band in bands]),
        repaired=sum(band.repaired for band in bands),
        warning=next((band.warning for band in bands if band.warning), ""),
    )


def _set_length(array: Array, length: int) -> Array:
    """The array with this length of its first axis: cut, or its end repeated."""
    missing = length - len(array)
    return np.concatenate([array, np.repeat(array[-1:], missing, axis=0)]) if missing > 0 else array[:length]


def _average(rows: Array, reduction: int) -> Array:
    """The mean of each square. Rows are added first: that is a third of the work if it follows the memory."""
    height, width, channels = rows.shape
    flat = np.ascontiguousarray(rows).reshape(height // reduction, reduction, width * channels)
    sums = np.add.reduce(flat, axis=1, dtype=np.float32).reshape(-1, width // reduction, reduction, channels)
    return (sum(sums[:, :, column] for column in range(reduction)) / np.float32(reduction**2)).astype(rows.dtype)


def _pick(rows: Array, reduction: int) -> Array:
    """The pixel in the middle of each square."""
    return np.ascontiguousarray(rows[reduction // 2 :: reduction, reduction // 2 :: reduction])
