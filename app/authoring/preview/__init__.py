"""What panels show, computed pass by pass within the time that a frame of the window has left."""

from __future__ import annotations

from .preview import DisplayedImage, Preview
from .timing import NodeTiming
from .visible_region import VisibleRegion

__all__ = ["DisplayedImage", "NodeTiming", "Preview", "VisibleRegion"]
