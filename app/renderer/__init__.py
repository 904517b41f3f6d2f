"""Plan in, pixels out. The only floor that knows OpenGL; it never opens a window."""

from __future__ import annotations

from .device import Device, describe, open_device
from .display import Display, Drawable, Handle
from .engine import DEFAULT_BUDGET, Renderer, Wanted
from .executor import Counters
from .look import Look, fitted, to_panel, to_picture
from .pinned import open_pinned, pinned
from .probe import Nonfinite, Probe, first_nonfinite
from .reel import Reel
from .run import Run
from .runner import Runner
from .textures import Lease

__all__ = [
    "DEFAULT_BUDGET", "Counters", "Device", "Display", "Drawable", "Handle", "Lease", "Look", "Nonfinite", "Probe",
    "Reel", "Renderer", "Run", "Runner", "Wanted", "describe", "first_nonfinite", "fitted", "open_device",
    "open_pinned", "pinned", "to_panel", "to_picture",
]
