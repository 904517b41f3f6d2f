"""Which part of a frame a texture holds, and which part of the texture lies in the frame."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.preview.displayed_images import DisplayedImage
from halation.graph import Port
from halation.nodes import Kind


def hold(size: tuple[int, int], start: tuple[int, int] = (0, 0), frame: tuple[int, int] = (40, 20)) -> DisplayedImage:
    texture: Any = SimpleNamespace(size=size)
    return DisplayedImage(Port("a", "out"), texture, frame, frame, 1.0, Kind.IMAGE, 4, "key", 1, start=start)


@pytest.mark.parametrize(
    ("size", "start", "part", "is_partial", "reaches_beyond", "share"),
    [
        ((40, 20), (0, 0), (0, 0, 40, 20), False, False, 1.0),
        ((10, 5), (20, 10), (0, 0, 10, 5), True, False, 0.0625),
        ((10, 20), (0, 0), (0, 0, 10, 20), True, False, 0.25),
        ((40, 5), (0, 3), (0, 0, 40, 5), True, False, 0.25),
        ((48, 26), (-4, -3), (4, 3, 40, 20), False, True, 1.56),
        ((48, 20), (-2, 0), (2, 0, 40, 20), False, True, 1.2),
        ((20, 20), (30, -5), (0, 5, 10, 15), True, True, 0.5),
    ],
)
def test_parts(
    size: Any, start: Any, part: tuple[int, int, int, int], is_partial: bool, reaches_beyond: bool, share: float
) -> None:
    image = hold(size, start)
    assert image.part == part and image.share == pytest.approx(share)
    assert (image.partial, image.reaches_beyond) == (is_partial, reaches_beyond)
    pixels = [(x + start[0], y + start[1]) for y in range(size[1]) for x in range(size[0])]
    assert sum(0 <= x < 40 and 0 <= y < 20 for x, y in pixels) == part[2] * part[3]
