"""Textures of a device from arrays, and back."""

from __future__ import annotations

import numpy as np
from halation.renderer import Device, DeviceTexture


def upload_texture(device: Device, pixels: np.ndarray) -> DeviceTexture:
    """A texture of [height, width, channels] of float16 or float32."""
    height, width, channels = pixels.shape
    with device.make_current():
        texture = device.create_texture((width, height), channels, "f2" if pixels.dtype == np.float16 else "f4")
        texture.write(np.ascontiguousarray(pixels))
    return texture


def read_texture(device: Device, texture: DeviceTexture, dtype: type[np.generic] = np.float32) -> np.ndarray:
    """The pixels of a texture as [height, width, channels]; `dtype` is what it stores."""
    pixels = np.empty((texture.size[1], texture.size[0], texture.components), dtype)
    with device.make_current():
        device.finish()
        texture.read_into(pixels)
    return pixels
