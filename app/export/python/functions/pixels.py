"""Parts of pixels: color and alpha, luminance, the sRGB curve."""

from __future__ import annotations

import numpy as np

Array = np.ndarray

LUMINANCE_WEIGHTS = np.array([0.2126, 0.7152, 0.0722])  # of linear Rec.709 (ITU-R BT.709-6)


def join(color: Array, alpha: Array) -> Array:
    """An Image [height, width, 4] of a color [height, width, 1 or 3] and an alpha [height, width, 1]."""
    height, width = np.broadcast_shapes(color.shape[:2], alpha.shape[:2])
    return np.concatenate(
        [np.broadcast_to(color, (height, width, 3)), np.broadcast_to(alpha, (height, width, 1))], axis=-1
    )


def straight(image: Array) -> tuple[Array, Array]:
    """The color divided by alpha, and alpha. Light where nothing is covered (alpha 0) is a glow, and stays."""
    color, alpha = image[..., :3], image[..., 3:]
    return np.where(alpha > 1e-6, color / np.maximum(alpha, 1e-6), color), alpha


def premultiply_color(color: Array, alpha: Array) -> Array:
    """The Image of a straight color: the inverse of `straight`."""
    return join(np.where(alpha > 1e-6, color * alpha, color), alpha)


def rgb(color: Array | tuple[float, ...]) -> Array:
    """Red, green and blue of a color."""
    return np.asarray(color, np.float64)[..., :3]


def luminance_of(color: Array) -> Array:
    """The luminance of linear Rec.709, as a Field."""
    return (color[..., :3] * LUMINANCE_WEIGHTS).sum(axis=-1, keepdims=True)


def largest(color: Array) -> Array:
    """The largest channel, as a Field."""
    return color[..., :3].max(axis=-1, keepdims=True)


def smallest(color: Array) -> Array:
    """The smallest channel, as a Field."""
    return color[..., :3].min(axis=-1, keepdims=True)


def length(vector: Array) -> Array:
    """The length of vectors, as a Field."""
    return np.sqrt((vector * vector).sum(axis=-1, keepdims=True))


def dot(a: Array, b: Array) -> Array:
    """The scalar product of vectors, as a Field."""
    return (a * b).sum(axis=-1, keepdims=True)


def mix(a: Array | float, b: Array | float, t: Array | float) -> Array:
    """`a` where t is 0, `b` where t is 1."""
    return np.asarray(a * (1.0 - t) + b * t)


def smoothstep(low: Array | float, high: Array | float, x: Array | float) -> Array:
    """A cubic step from 0 at `low` to 1 at `high`."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def srgb_encode(light: Array) -> Array:
    """The sRGB code of light (IEC 61966-2-1); light below 0 is mirrored."""
    size = np.abs(light)
    return np.sign(light) * np.where(size <= 0.0031308, 12.92 * size, 1.055 * size ** (1.0 / 2.4) - 0.055)


def srgb_decode(code: Array) -> Array:
    """The light of an sRGB code: the inverse of `srgb_encode`."""
    size = np.abs(code)
    return np.sign(code) * np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4)


def display_tone(image: Array) -> Array:
    """How bright a pixel looks on a display: the sRGB code of its luminance, without its alpha."""
    return srgb_encode(np.maximum(luminance_of(straight(image)[0]), 0.0))


def display_tones(image: Array) -> Array:
    """The Image with sRGB codes in place of light."""
    color, alpha = straight(image)
    return premultiply_color(srgb_encode(color), alpha)


def light_of_tones(tones: Array) -> Array:
    """The inverse of `display_tones`."""
    code, alpha = straight(tones)
    return premultiply_color(srgb_decode(code), alpha)


def as_image(field: Array) -> Array:
    """A Field as a gray, opaque Image."""
    return join(field, np.ones_like(field))


def mix_by_mask(before: Array, after: Array, mask: Array | float, mix: Array | float, inverted: bool = False) -> Array:
    """`after` where the mask is 1, `before` where it is 0."""
    inside = np.clip(mask, 0.0, 1.0)
    part = np.clip(mix, 0.0, 1.0) * (1.0 - inside if inverted else inside)
    return before + part * (after - before)
