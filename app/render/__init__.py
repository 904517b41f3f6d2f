"""Plan in, pixels out. The only floor that knows OpenGL; it never opens a window."""

from __future__ import annotations

from .device import Device, describe, open_device
from .renderer import Binding, Renderer
from .runner import Counters, Runner

__all__ = ["Binding", "Counters", "Device", "Renderer", "Runner", "describe", "open_device"]
