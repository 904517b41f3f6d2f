"""What it takes to make pixels again: seconds, measured where that is free, else estimated."""

from __future__ import annotations

from ...compiler import Pass, Plan

_BYTES_PER_SECOND = {True: 4e9, False: 4e11}
"""What passes read and write where they have not been measured yet; True for the software rasterizer."""

_KNOWN = 512
"""Programs whose speed is remembered."""


class Costs:
    """Seconds for passes. What was measured of a program is true of pictures of all sizes, by the pixel."""

    def __init__(self, software: bool) -> None:
        self._rate = _BYTES_PER_SECOND[software]
        self._per_pixel: dict[str, float] = {}

    def learn(self, plan: Plan, one: Pass, seconds: float) -> None:
        """A pass took this long. The first time does not count: drivers finish a program when it first runs."""
        known = self._per_pixel.pop(one.shader.source, None)
        self._per_pixel[one.shader.source] = 0.0 if known is None else seconds / _count_pixels(plan, one)
        if len(self._per_pixel) > _KNOWN:
            del self._per_pixel[next(iter(self._per_pixel))]

    def estimate(self, plan: Plan, one: Pass) -> float:
        """How long a pass will take, or took."""
        if known := self._per_pixel.get(one.shader.source):
            return known * _count_pixels(plan, one)
        taps = max(1, len(one.weights))
        read = sum(plan.surfaces[number].nbytes for number in one.textures) * taps
        return (read + sum(plan.surfaces[number].nbytes for number in one.targets)) / self._rate


def _count_pixels(plan: Plan, one: Pass) -> int:
    width, height = plan.surfaces[one.targets[0]].size
    return width * height
