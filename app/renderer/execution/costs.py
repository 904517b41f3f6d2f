"""What it takes to make pixels again: seconds, measured where that is free, else estimated."""

from __future__ import annotations

from ...compiler import Pass, Plan

_BYTES_PER_SECOND = {True: 4e9, False: 4e11}
"""What passes read and write where they have not been measured yet; True for the software rasterizer."""

_MAX_MEASURED_PROGRAMS = 512
"""Programs whose speed is remembered."""


class PassCosts:
    """Seconds for passes. What was measured of a program is true of pictures of all sizes, by the pixel."""

    def __init__(self, software: bool) -> None:
        self._rate = _BYTES_PER_SECOND[software]
        self._per_pixel: dict[str, float] = {}

    def record_time(self, plan: Plan, render_pass: Pass, seconds: float) -> None:
        """A pass took this long. The first time does not count: drivers finish a program when it first runs."""
        earlier = self._per_pixel.pop(render_pass.shader.source, None)
        self._per_pixel[render_pass.shader.source] = (
            0.0 if earlier is None else seconds / _count_pixels(plan, render_pass)
        )
        if len(self._per_pixel) > _MAX_MEASURED_PROGRAMS:
            del self._per_pixel[next(iter(self._per_pixel))]

    def estimate(self, plan: Plan, render_pass: Pass) -> float:
        """How long a pass will take, or took."""
        if seconds_per_pixel := self._per_pixel.get(render_pass.shader.source):
            return seconds_per_pixel * _count_pixels(plan, render_pass)
        taps = max(1, len(render_pass.weights))
        read = sum(plan.surfaces[number].nbytes for number in render_pass.textures) * taps
        return (read + sum(plan.surfaces[number].nbytes for number in render_pass.targets)) / self._rate


def _count_pixels(plan: Plan, render_pass: Pass) -> int:
    width, height = plan.surfaces[render_pass.targets[0]].size
    return width * height
