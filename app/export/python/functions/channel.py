"""Channels: split, join and rearrange them."""

from __future__ import annotations

import numpy as np

from .pixels import Array, join, luminance_of, straight


def premultiply(image: Array) -> Array:
    """Multiply color by alpha."""
    return join(image[..., :3] * image[..., 3:], image[..., 3:])


def unpremultiply(image: Array) -> Array:
    """Divide color by alpha, where there is any."""
    return join(*straight(image))


def separate(image: Array) -> tuple[Array, Array, Array, Array]:
    """Red, green, blue and alpha as Fields."""
    return image[..., 0:1], image[..., 1:2], image[..., 2:3], image[..., 3:4]


def separate_vector(vector: Array) -> tuple[Array, Array, Array]:
    """The three components of a vector as Fields."""
    return vector[..., 0:1], vector[..., 1:2], vector[..., 2:3]


def separate_vector2(vector: Array) -> tuple[Array, Array]:
    """The two components of a vector as Fields."""
    return vector[..., 0:1], vector[..., 1:2]


def separate_vector4(vector: Array) -> tuple[Array, Array, Array, Array]:
    """The four components of a vector as Fields."""
    return vector[..., 0:1], vector[..., 1:2], vector[..., 2:3], vector[..., 3:4]


def stack(*fields: Array | float) -> Array:
    """Fields and numbers as the channels of one picture."""
    parts = [np.reshape(field, (1, 1, 1)) if np.ndim(field) == 0 else field for field in fields]
    return np.concatenate(np.broadcast_arrays(*parts), axis=-1)


def combine(red: Array, green: Array, blue: Array, alpha: Array) -> Array:
    """An Image of four Fields, which are taken as they are (premultiplied)."""
    return stack(red, green, blue, alpha)


def combine_vector(x: Array, y: Array, z: Array) -> Array:
    """A vector of three Fields."""
    return stack(x, y, z)


def combine_vector2(x: Array, y: Array) -> Array:
    """A vector of two Fields."""
    return stack(x, y)


def combine_vector4(x: Array, y: Array, z: Array, w: Array) -> Array:
    """A vector of four Fields."""
    return stack(x, y, z, w)


def channel_shuffle(image: Array, other: Array, red: str, green: str, blue: str, alpha: str) -> Array:
    """Take each channel from one of two images, as it is."""
    sources = {"zero": np.zeros_like(image[..., :1]), "one": np.ones_like(image[..., :1])}
    for prefix, source in (("", image), ("other ", np.broadcast_to(other, image.shape))):
        for at, name in enumerate(("red", "green", "blue", "alpha")):
            sources[prefix + name] = source[..., at : at + 1]
        sources[prefix + "luminance"] = luminance_of(source)
    return np.concatenate([sources[name] for name in (red, green, blue, alpha)], axis=-1)
