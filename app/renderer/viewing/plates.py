"""Uploads pictures that no plan renders, such as scopes, as textures that a window can show."""

from __future__ import annotations

import numpy as np

from ..device import Device, DeviceTexture


class PlateTexture:
    """One texture for a picture that changes."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._texture: DeviceTexture | None = None

    def show(self, pixels: np.ndarray) -> DeviceTexture:
        """Upload [height, width, 4] of uint8, row 0 on top; the same texture as long as the size stays."""
        height, width, _ = pixels.shape
        with self._device.make_current():
            if self._texture is None or self._texture.size != (width, height):
                self.close()
                self._texture = self._device.create_texture((width, height), 4, "f1", linear=True)
            self._texture.write(np.ascontiguousarray(pixels, np.uint8))
        return self._texture

    def close(self) -> None:
        """Give the texture back."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None
