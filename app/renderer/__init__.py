"""Plan in, pixels out. The only floor that knows OpenGL; it never opens a window.

A module is loaded when what it has is asked for (PEP 562): most renderings do without half of them.
"""

from __future__ import annotations

from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .device import Device, DeviceTexture
    from .engine import DEFAULT_BUDGET, Renderer, RenderRequest
    from .execution.executor import Counters
    from .execution.run import Run
    from .execution.runner import Runner
    from .execution.texture_pool import Lease
    from .frame_renderer import FrameRenderer
    from .opening import open_device
    from .pinned_device import open_pinned
    from .viewing.display import Display, Drawable
    from .viewing.look import Look, fit_zoom, to_panel, to_picture
    from .viewing.probe import Nonfinite, Probe, find_first_nonfinite

__all__ = [
    "DEFAULT_BUDGET",
    "Counters",
    "Device",
    "DeviceTexture",
    "Display",
    "Drawable",
    "FrameRenderer",
    "Lease",
    "Look",
    "Nonfinite",
    "Probe",
    "RenderRequest",
    "Renderer",
    "Run",
    "Runner",
    "find_first_nonfinite",
    "fit_zoom",
    "open_device",
    "open_pinned",
    "to_panel",
    "to_picture",
]

_HOMES = MappingProxyType(
    {
        "Counters": "execution.executor",
        "DEFAULT_BUDGET": "engine",
        "Device": "device",
        "DeviceTexture": "device",
        "Display": "viewing.display",
        "Drawable": "viewing.display",
        "Lease": "execution.texture_pool",
        "Look": "viewing.look",
        "Nonfinite": "viewing.probe",
        "Probe": "viewing.probe",
        "FrameRenderer": "frame_renderer",
        "Renderer": "engine",
        "Run": "execution.run",
        "Runner": "execution.runner",
        "RenderRequest": "engine",
        "find_first_nonfinite": "viewing.probe",
        "fit_zoom": "viewing.look",
        "open_device": "opening",
        "open_pinned": "pinned_device",
        "to_panel": "viewing.look",
        "to_picture": "viewing.look",
    }
)


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f".{_HOMES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
