"""The curves of links, as they are drawn."""

from __future__ import annotations

Curve = tuple[float, float, float, float, float, float, float, float]
"""A cubic Bezier: start, two handles, end, each as x, y."""

_MIN_HANDLE, _MAX_HANDLE = 24.0, 200.0
"""The shortest handle, and the longest one of a link that runs back, in canvas units: chosen by eye."""


def make_curve(x0: float, y0: float, x1: float, y1: float) -> Curve:
    """The shape of a link: it leaves to the right and arrives from the left, with room to turn where it runs back."""
    across, down = x1 - x0, abs(y1 - y0)
    if across > 0:
        handle = max(across * 0.5, min(_MIN_HANDLE, (across + down) * 0.5))
    else:
        handle = min(max(-across * 0.75 + down * 0.5, _MIN_HANDLE), _MAX_HANDLE)
    return x0, y0, x0 + handle, y0, x1 - handle, y1, x1, y1
