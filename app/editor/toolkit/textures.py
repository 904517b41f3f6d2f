"""A cache of small textures."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable

import numpy as np
from imgui_bundle import hello_imgui, imgui

from ...color.transforms import Array

_MOST = 300
"""Small pictures on the device: those of all nodes in the menu, and of what was shown last. Chosen by judgement."""


class Textures:
    """Uploads each picture once and keeps the most recently shown ones. Must be cleared before the window closes."""

    def __init__(self) -> None:
        self._kept: OrderedDict[Hashable, hello_imgui.TextureGpu] = OrderedDict()

    def get(self, key: Hashable, make: Callable[[], Array]) -> imgui.ImTextureRef:
        """The texture of the picture that `make` returns, [h, w, 3] of uint8; cached by key."""
        if key not in self._kept:
            pixels = make()
            opaque = np.full((*pixels.shape[:2], 4), 255, np.uint8)
            opaque[..., :3] = pixels
            self._kept[key] = hello_imgui.create_texture_gpu_from_rgba_data(opaque)
            while len(self._kept) > _MOST:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return imgui.ImTextureRef(self._kept[key].texture_id())

    def clear(self) -> None:
        """Release all textures."""
        self._kept.clear()


def fit_picture(pixels: Array, width: float, height: float) -> tuple[float, float]:
    """The largest size of a picture in a box, enlarged at most twice."""
    across, down = pixels.shape[1], pixels.shape[0]
    scale = min(width / across, height / down, 2.0)
    return across * scale, down * scale
