"""What panels show, computed pass by pass within the time that a frame of the window has left."""

from __future__ import annotations

from .preview import Preview, Shown
from .timing import Timing

__all__ = ["Preview", "Shown", "Timing"]
