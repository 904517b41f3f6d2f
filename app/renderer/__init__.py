"""Plan in, pixels out. The only floor that knows OpenGL; it never opens a window.

A module is loaded when what it has is asked for (PEP 562): most renderings do without half of them.
"""

from __future__ import annotations

from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .device import Device, describe
    from .display import Display, Drawable, Handle
    from .engine import DEFAULT_BUDGET, Renderer, Wanted
    from .executor import Counters
    from .look import Look, fitted, to_panel, to_picture
    from .opening import open_device
    from .pinned import open_pinned
    from .probe import Nonfinite, Probe, first_nonfinite
    from .reel import Reel
    from .run import Run
    from .runner import Runner
    from .textures import Lease

__all__ = [
    "DEFAULT_BUDGET", "Counters", "Device", "Display", "Drawable", "Handle", "Lease", "Look", "Nonfinite", "Probe",
    "Reel", "Renderer", "Run", "Runner", "Wanted", "describe", "first_nonfinite", "fitted",
    "open_device", "open_pinned", "to_panel", "to_picture",
]

_HOMES = MappingProxyType({
    "Counters": "executor", "DEFAULT_BUDGET": "engine", "Device": "device", "Display": "display",
    "Drawable": "display", "Handle": "display", "Lease": "textures", "Look": "look", "Nonfinite": "probe",
    "Probe": "probe", "Reel": "reel", "Renderer": "engine", "Run": "run", "Runner": "runner",
    "Wanted": "engine", "describe": "device", "first_nonfinite": "probe", "fitted": "look", "open_device": "opening",
    "open_pinned": "pinned", "to_panel": "look", "to_picture": "look",
})


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f".{_HOMES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
