"""Tables of numbers that functions read as pictures."""

from __future__ import annotations

from array import array
from hashlib import blake2b

from halation.nodes import Kind

from ...resources.picture import Picture
from ..ir import PictureShape, Read


def make_table(owner: str, numbers: tuple[float, ...], width: int) -> Read:
    """Numbers as a picture of four channels with `width` pixels in a row; the last row is filled with zeros."""
    rows = max(1, -(-len(numbers) // (4 * width)))
    filled = numbers + (0.0,) * (4 * width * rows - len(numbers))
    table = tuple(
        tuple(filled[at : at + 4] for at in range(row, row + 4 * width, 4)) for row in range(0, len(filled), 4 * width)
    )
    fingerprint = blake2b(array("d", filled).tobytes() + str(width).encode()).hexdigest()
    picture = Picture("numbers", "", Kind.VECTOR, 4, in_memory=True, pixels=table)
    return Read((PictureShape((width, rows), 4, data=True),), owner, picture, fingerprint, half=False)
