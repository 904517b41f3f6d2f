"""How many seconds it takes to compute pixels again: measured where that costs nothing, else estimated."""

from __future__ import annotations

from ...compiler import Pass, Plan

_BYTES_PER_SECOND = {True: 4e9, False: 4e11}
"""Bytes that a pass reads and writes per second, until it is measured; True is for the software rasterizer. The order
of magnitude of measured passes: llvmpipe on four cores, and a quarter of the bandwidth of an H100. Only the ratio
between passes matters, since costs rank results of one device."""

_MAX_MEASURED_PROGRAMS = 512
"""Programs whose speed is remembered: as many as `ProgramCache` keeps."""


class PassCosts:
    """Seconds that passes take. A program that was measured is assumed to take as long per pixel at any size."""

    def __init__(self, software: bool) -> None:
        self._rate = _BYTES_PER_SECOND[software]
        self._per_pixel: dict[str, float] = {}

    def record_time(self, plan: Plan, render_pass: Pass, seconds: float) -> None:
        """Record how long a pass took. The first time is ignored: drivers finish compiling a program when it runs."""
        earlier = self._per_pixel.pop(render_pass.shader.source, None)
        self._per_pixel[render_pass.shader.source] = (
            0.0 if earlier is None else seconds / _count_pixels(plan, render_pass)
        )
        if len(self._per_pixel) > _MAX_MEASURED_PROGRAMS:
            del self._per_pixel[next(iter(self._per_pixel))]

    def estimate(self, plan: Plan, render_pass: Pass) -> float:
        """The seconds that a pass takes."""
        if seconds_per_pixel := self._per_pixel.get(render_pass.shader.source):
            return seconds_per_pixel * _count_pixels(plan, render_pass)
        taps = max(1, len(render_pass.weights))
        read = sum(plan.surfaces[number].nbytes for number in render_pass.textures) * taps
        return (read + sum(plan.surfaces[number].nbytes for number in render_pass.targets)) / self._rate


def _count_pixels(plan: Plan, render_pass: Pass) -> int:
    width, height = plan.surfaces[render_pass.targets[0]].size
    return width * height
