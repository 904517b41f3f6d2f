"""Tables of numbers that functions read as pictures."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from hashlib import blake2b

from halation.nodes import Kind

from ...resources.picture import Picture
from ..ir import PictureShape, Read


def make_table(owner: str, numbers: Sequence[float], width: int) -> Read:
    """Numbers as a picture of four channels with `width` pixels in a row; the last row is filled with zeros.

    Numbers in an array of floats in 32 bits are handed on as they are, so that millions of them take no time.
    """
    rows = max(1, -(-len(numbers) // (4 * width)))
    shape = rows, width, 4
    filled = numbers[:] if isinstance(numbers, array) else array("f", numbers)
    filled.frombytes(bytes(filled.itemsize * (math.prod(shape) - len(filled))))
    fingerprint = blake2b(filled.tobytes() + str(width).encode()).hexdigest()
    pixels = memoryview(filled).cast("B").cast("f", shape)
    picture = Picture("numbers", "", Kind.VECTOR, 4, in_memory=True, pixels=pixels)
    return Read((PictureShape((width, rows), 4, data=True),), owner, picture, fingerprint, half=False)
