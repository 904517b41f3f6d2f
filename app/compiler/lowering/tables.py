"""Tables of numbers that functions read as pictures."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from hashlib import blake2b

from halation.nodes import Kind

from ...resources.picture import NumberTable, Picture
from ..ir import PictureShape, Read


def make_table(owner: str, numbers: Sequence[float], width: int) -> Read:
    """Numbers as a picture of four channels with `width` pixels in a row; the last row is filled with zeros.

    Numbers in an array of floats in 32 bits are handed on as they are, so that millions of them take no time.
    """
    rows = max(1, -(-len(numbers) // (4 * width)))
    filled = numbers[:] if isinstance(numbers, array) else array("f", numbers)
    content = filled.tobytes().ljust(filled.itemsize * 4 * width * rows, b"\0")
    fingerprint = blake2b(content + str(width).encode()).hexdigest()
    picture = Picture("numbers", "", Kind.VECTOR, 4, in_memory=True, pixels=NumberTable(rows, width, content))
    return Read((PictureShape((width, rows), 4, data=True),), owner, picture, fingerprint, half=False)
