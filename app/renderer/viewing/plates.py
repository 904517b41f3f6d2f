"""Pictures made elsewhere, such as scopes, as textures that a window can show."""

from __future__ import annotations

import moderngl
import numpy as np

from ..opengl.device import Device


class Plate:
    """One texture that takes what it is given."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._texture: moderngl.Texture | None = None

    def show(self, pixels: np.ndarray) -> moderngl.Texture:
        """Upload [height, width, 4] of uint8, row 0 on top; the same texture as long as the size stays."""
        height, width, _ = pixels.shape
        with self._device.current():
            if self._texture is None or self._texture.size != (width, height):
                self.close()
                self._texture = self._device.context.texture((width, height), 4)
            self._texture.write(np.ascontiguousarray(pixels, np.uint8))
        return self._texture

    def close(self) -> None:
        """Give it back."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None
