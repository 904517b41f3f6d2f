"""The renderer: runs plans on a device and writes files. The only folder that uses OpenGL; it never opens a window.

- `engine` compiles a graph and runs its plan; `frame_renderer` adds the history of temporal nodes.
- `execution` runs a plan on a `Device`; `opengl` implements the device.
- `jobs` renders frames into files; `provenance` renders a picture again from its header.
- `viewing` draws results on a screen and reads pixels back.

Modules are imported when one of their names is first used (PEP 562), because most programs need only half of them.
"""

from __future__ import annotations

from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .device import Device, DeviceTexture
    from .engine import DEFAULT_BUDGET, Renderer, RenderRequest
    from .execution.executor import RunnerCounters
    from .execution.run import Run
    from .execution.runner import PassTrace, Runner
    from .execution.texture_pool import TextureLease
    from .frame_renderer import FrameRenderer
    from .opening import open_device
    from .pinned_device import open_pinned
    from .viewing.display import Display, Drawable
    from .viewing.look import Look, find_panel_point, find_picture_point, fit_zoom
    from .viewing.probe import NonfinitePixel, PixelProbe, find_first_nonfinite

__all__ = [
    "DEFAULT_BUDGET",
    "Device",
    "DeviceTexture",
    "Display",
    "Drawable",
    "FrameRenderer",
    "Look",
    "NonfinitePixel",
    "PassTrace",
    "PixelProbe",
    "RenderRequest",
    "Renderer",
    "Run",
    "Runner",
    "RunnerCounters",
    "TextureLease",
    "find_first_nonfinite",
    "find_panel_point",
    "find_picture_point",
    "fit_zoom",
    "open_device",
    "open_pinned",
]

_HOMES = MappingProxyType(
    {
        "RunnerCounters": "execution.executor",
        "DEFAULT_BUDGET": "engine",
        "Device": "device",
        "DeviceTexture": "device",
        "Display": "viewing.display",
        "Drawable": "viewing.display",
        "TextureLease": "execution.texture_pool",
        "Look": "viewing.look",
        "NonfinitePixel": "viewing.probe",
        "PixelProbe": "viewing.probe",
        "FrameRenderer": "frame_renderer",
        "Renderer": "engine",
        "Run": "execution.run",
        "PassTrace": "execution.runner",
        "Runner": "execution.runner",
        "RenderRequest": "engine",
        "find_first_nonfinite": "viewing.probe",
        "fit_zoom": "viewing.look",
        "open_device": "opening",
        "open_pinned": "pinned_device",
        "find_panel_point": "viewing.look",
        "find_picture_point": "viewing.look",
    }
)


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f".{_HOMES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
