"""Plan in, pixels out. The only floor that knows OpenGL; it never opens a window."""

from __future__ import annotations

from .device import Device, describe, open_device
from .engine import Renderer, Wanted
from .runner import Counters, Runner

__all__ = ["Counters", "Device", "Renderer", "Runner", "Wanted", "describe", "open_device"]
