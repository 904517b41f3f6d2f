"""What panels show, computed pass by pass within the time that a frame of the window has left."""

from __future__ import annotations

from .glimpses import Glimpse
from .preview import Preview, Shown
from .timing import Timing

__all__ = ["Glimpse", "Preview", "Shown", "Timing"]
