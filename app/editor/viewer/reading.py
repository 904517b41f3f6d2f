"""Pixels read back from the device, once for every picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from .geometry import Box, Pixels, texel, texels
from .measuring import Array, Statistics, statistics

if TYPE_CHECKING:
    from ...authoring.preview import DisplayedImage
    from ...renderer.viewing.probe import PixelProbe

T = TypeVar("T")

SMALL = 208
"""The width of the small picture from which scopes and ranges are measured."""

BAND = 2**19
"""Pixels that are scanned per frame of the window."""


class ValueReader:
    """Caches the numbers that were read last."""

    def __init__(self) -> None:
        self._cache: dict[object, tuple[object, Any]] = {}

    def read_small(self, probe: PixelProbe, image: DisplayedImage) -> Array:
        """A small version of the picture, [h, w, channels]."""
        return self._remember(
            "small",
            _mark(image),
            lambda: probe.read_small(image.texture, SMALL, image.part)[..., : image.channels].astype(np.float32),
        )

    def read_pixel(self, probe: PixelProbe, name: str, image: DisplayedImage, pixel: Pixels) -> tuple[float, ...]:
        """The numbers of one pixel, given at full size; `name` says what for. None where there are none as yet."""
        (x, y), (left, top) = texel(pixel, image.full_size, image.size), image.start
        x, y = x - left, y - top
        if not (0 <= x < image.texture.size[0] and 0 <= y < image.texture.size[1]):
            return ()
        return self._remember(
            ("pixel", name),
            (_mark(image), x, y),
            lambda: tuple(probe.read_pixel(image.texture, x, y)[: image.channels]),
        )

    def measure_box(self, probe: PixelProbe, name: str, image: DisplayedImage, box: Box) -> Statistics:
        """The statistics of a box of fractions."""
        left, top, width, height = image.part
        x, y, *size = texels(box, (width, height))
        part = (left + x, top + y, size[0], size[1])
        return self._remember(
            ("box", name),
            (_mark(image), part),
            lambda: statistics(probe.read_region(image.texture, part)[..., : image.channels]),
        )

    def _remember(self, key: object, mark: object, read: Callable[[], T]) -> T:
        entry = self._cache.get(key)
        if entry is None or entry[0] != mark:
            entry = self._cache[key] = (mark, read())
        return entry[1]


class Scan:
    """Counts the pixels of a picture that are not finite, a part of it per frame of the window."""

    def __init__(self) -> None:
        self._mark: object = None
        self._steps: Iterator[int] | None = None
        self.wrong = 0
        """Pixels found so far."""

    def step(self, probe: PixelProbe, image: DisplayedImage | None) -> None:
        """Continue to count; start again for another picture."""
        if image is None:
            self._mark, self._steps, self.wrong = None, None, 0
            return
        if self._mark != _mark(image):
            self._mark, self._steps, self.wrong = _mark(image), self._look_through(probe, image), 0
        if self._steps is not None:
            count = next(self._steps, None)
            if count is None:
                self._steps = None
            else:
                self.wrong += count

    def _look_through(self, probe: PixelProbe, image: DisplayedImage) -> Iterator[int]:
        left, top, width, height = image.part
        rows = max(BAND // max(width, 1), 1)
        for row in range(0, height, rows):
            band = left, top + row, width, min(rows, height - row)
            part = probe.read_region(image.texture, band)[..., : image.channels]
            yield int((~np.isfinite(part).all(axis=2)).sum())


def _mark(image: DisplayedImage) -> object:
    return image.key, image.revision, image.texture.size
