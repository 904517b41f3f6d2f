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
"""Width of what stands for a whole picture in scopes and ranges."""

BAND = 2**19
"""Pixels that are looked through per frame."""


class ValueReader:
    """What was read last, by what it is of."""

    def __init__(self) -> None:
        self._known: dict[object, tuple[object, Any]] = {}

    def small(self, probe: PixelProbe, shown: DisplayedImage) -> Array:
        """The picture [h, w, channels] with most pixels left out."""
        return self._kept(
            "small",
            _mark(shown),
            lambda: probe.read_small(shown.texture, SMALL)[..., : shown.channels].astype(np.float32),
        )

    def pixel(self, probe: PixelProbe, name: str, shown: DisplayedImage, pixel: Pixels) -> tuple[float, ...]:
        """The numbers of one pixel, given at full size; `name` says what for. None where there are none as yet."""
        (x, y), (left, top) = texel(pixel, shown.full_size, shown.size), shown.start
        x, y = x - left, y - top
        if not (0 <= x < shown.texture.size[0] and 0 <= y < shown.texture.size[1]):
            return ()
        return self._kept(
            ("pixel", name),
            (_mark(shown), x, y),
            lambda: tuple(probe.read_pixel(shown.texture, x, y)[: shown.channels]),
        )

    def measured(self, probe: PixelProbe, name: str, shown: DisplayedImage, box: Box) -> Statistics:
        """Statistics of a box of fractions."""
        part = texels(box, shown.texture.size)
        return self._kept(
            ("box", name),
            (_mark(shown), part),
            lambda: statistics(probe.read_region(shown.texture, part)[..., : shown.channels]),
        )

    def _kept(self, key: object, mark: object, read: Callable[[], T]) -> T:
        known = self._known.get(key)
        if known is None or known[0] != mark:
            known = self._known[key] = (mark, read())
        return known[1]


class Scan:
    """Looks through a picture for numbers that are not finite, some of it every frame."""

    def __init__(self) -> None:
        self._mark: object = None
        self._steps: Iterator[int] | None = None
        self.wrong = 0
        """Pixels found so far."""

    def step(self, probe: PixelProbe, shown: DisplayedImage | None) -> None:
        """Go on, from the start where the picture is another one."""
        if shown is None:
            self._mark, self._steps, self.wrong = None, None, 0
            return
        if self._mark != _mark(shown):
            self._mark, self._steps, self.wrong = _mark(shown), self._look_through(probe, shown), 0
        if self._steps is not None:
            found = next(self._steps, None)
            if found is None:
                self._steps = None
            else:
                self.wrong += found

    def _look_through(self, probe: PixelProbe, shown: DisplayedImage) -> Iterator[int]:
        width, height = shown.texture.size
        rows = max(BAND // max(width, 1), 1)
        for top in range(0, height, rows):
            part = probe.read_region(shown.texture, (0, top, width, min(rows, height - top)))[..., : shown.channels]
            yield int((~np.isfinite(part).all(axis=2)).sum())


def _mark(shown: DisplayedImage) -> object:
    return shown.key, shown.revision, shown.texture.size
