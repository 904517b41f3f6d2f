"""Merging of pictures, and calculations with Fields and vectors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .pixels import Array, dot, join, largest, length, luminance_of, mix, smallest, smoothstep, straight
from .places import bilinear, grid


def screen(b: Array, a: Array) -> Array:
    """Screen is not defined above 1: there the brighter one wins, as in Nuke."""
    return np.where(np.maximum(a, b) > 1.0, np.maximum(a, b), a + b - a * b)


def hard_light(b: Array, a: Array) -> Array:
    """Dark light of a multiplies b, bright light screens it."""
    return np.where(a <= 0.5, 2.0 * a * b, screen(b, 2.0 * a - 1.0))


def soft_light(b: Array, a: Array) -> Array:
    """The soft light of the W3C; a background of 1 or more stays."""
    a = np.minimum(a, 1.0)
    lighter = np.where(b <= 0.25, ((16.0 * b - 12.0) * b + 4.0) * b, np.sqrt(np.maximum(b, 0.0)))
    soft = np.where(a <= 0.5, b - (1.0 - 2.0 * a) * b * (1.0 - b), b + (2.0 * a - 1.0) * (lighter - b))
    return np.where(b >= 1.0, b, soft)


def color_dodge(b: Array, a: Array) -> Array:
    """Divide by the negative of a; limited to 1, or to the background if that is brighter."""
    most = np.maximum(b, 1.0)
    dodged = np.where(a >= 1.0, most, np.minimum(most, b / np.where(a < 1.0, 1.0 - a, 1.0)))
    return np.where(b == 0.0, 0.0, dodged)


def color_burn(b: Array, a: Array) -> Array:
    """The negative of a dodge; a background of 1 or more stays."""
    burned = np.where(a <= 0.0, 0.0, 1.0 - np.minimum(1.0, (1.0 - b) / np.where(a > 0.0, a, 1.0)))
    return np.where(b >= 1.0, b, burned)


BLENDS = {
    "multiply": lambda b, a: b * a,
    "screen": screen,
    "overlay": lambda b, a: hard_light(a, b),
    "soft light": soft_light,
    "hard light": hard_light,
    "color dodge": color_dodge,
    "color burn": color_burn,
    "darken": np.minimum,
    "lighten": np.maximum,
    "difference": lambda b, a: np.abs(b - a),
    "exclusion": lambda b, a: b + a - 2.0 * b * a,
    "subtract": lambda b, a: b - a,
    "divide": lambda b, a: np.where(a > 0.0, b / np.where(a > 0.0, a, 1.0), 0.0),
    "hypot": np.hypot,
    "average": lambda b, a: 0.5 * (b + a),
}
"""Blend modes of one channel (W3C Compositing and Blending 1), continued for light above 1."""


def spread(color: Array) -> Array:
    """The difference of the largest and the smallest channel."""
    return largest(color) - smallest(color)


def with_luminance(color: Array, luminance: Array, ceiling: Array) -> Array:
    """The color with another luminance, moved toward gray as far as it leaves 0..ceiling."""
    color = color + luminance - luminance_of(color)
    low = smallest(color)
    high = largest(color)
    raised = luminance + (color - luminance) * luminance / np.maximum(luminance - low, 1e-9)
    color = np.where(low < 0.0, raised, color)
    lowered = luminance + (color - luminance) * (ceiling - luminance) / np.maximum(high - luminance, 1e-9)
    return np.where(high > ceiling, lowered, color)


def with_saturation(color: Array, saturation: Array) -> Array:
    """The color with another difference between its largest and smallest channel."""
    return (color - smallest(color)) * saturation / np.maximum(spread(color), 1e-9)


def blend_colors(mode: str, b: Array, a: Array) -> Array:
    """The four blends of whole colors: hue, saturation, color and luminosity."""
    ceiling = np.maximum(1.0, np.maximum(largest(b), largest(a)))  # above 1, no brighter than the inputs
    level = luminance_of(b)
    if mode == "hue":
        return with_luminance(with_saturation(a, spread(b)), level, ceiling)
    if mode == "saturation":
        return with_luminance(with_saturation(b, spread(a)), level, ceiling)
    if mode == "color":
        return with_luminance(a, level, ceiling)
    return with_luminance(b, luminance_of(a), ceiling)


def blend(a: Array, b: Array, beyond: Array, formula: Callable[[Array, Array], Array]) -> Array:
    """a (1 - b.alpha) + b (1 - a.alpha) + a.alpha b.alpha blend(b, a); `beyond` stands for 1 - b.alpha."""
    above, below = np.maximum(straight(a)[0], 0.0), np.maximum(straight(b)[0], 0.0)
    both = formula(below, above)
    cover_a, cover_b = a[..., 3:], b[..., 3:]
    color = a[..., :3] * beyond + b[..., :3] * (1.0 - cover_a) + cover_a * cover_b * both
    return join(color, cover_a + cover_b - cover_a * cover_b)


PORTER_DUFF = {
    "over": lambda a, b, front, beyond: front + b * (1.0 - a[..., 3:]),
    "under": lambda a, b, front, beyond: b + a * beyond,
    "in": lambda a, b, front, beyond: a * b[..., 3:],
    "out": lambda a, b, front, beyond: a * beyond,
    "atop": lambda a, b, front, beyond: a * b[..., 3:] + b * (1.0 - a[..., 3:]),
    "xor": lambda a, b, front, beyond: a * beyond + b * (1.0 - a[..., 3:]),
    "clear": lambda a, b, front, beyond: 0.0 * (a + b),
    "plus": lambda a, b, front, beyond: join(front[..., :3] + b[..., :3], np.minimum(a[..., 3:] + b[..., 3:], 1.0)),
}
"""The operators of Porter and Duff (1984) for premultiplied pictures. `front` is the part of `a` that may show, and
`beyond` how much of it shows where `b` does not cover."""


def merge(a: Array, b: Array, mask: Array | float, mode: str, amount: Array | float, clipped: bool) -> Array:
    """Combine the foreground `a` with the background `b`, or show it only there."""
    front, beyond = (a * b[..., 3:], np.zeros_like(b[..., 3:])) if clipped else (a, 1.0 - b[..., 3:])
    if mode in PORTER_DUFF:
        merged = PORTER_DUFF[mode](a, b, front, beyond)
    elif mode in BLENDS:
        merged = blend(a, b, beyond, BLENDS[mode])
    else:
        merged = blend(a, b, beyond, lambda below, above: blend_colors(mode, below, above))
    if clipped and (mode == "plus" or mode not in PORTER_DUFF):
        merged = join(merged[..., :3], b[..., 3:])
    return mix(b, merged, mask * np.asarray(amount))


def mix_images(a: Array, b: Array, factor: Array | float) -> Array:
    """A dissolve: a (1 - factor) + b factor."""
    return mix(a, b, factor)


def divide(a: Array | float, b: Array | float) -> Array:
    """a / b, and 0 where b is 0."""
    divisor = np.asarray(b, np.float64)
    return np.where(divisor != 0.0, a / np.where(divisor != 0.0, divisor, 1.0), 0.0)


OPERATIONS = {
    "add": lambda a, b, c: a + b,
    "subtract": lambda a, b, c: a - b,
    "multiply": lambda a, b, c: a * b,
    "divide": lambda a, b, c: divide(a, b),
    "multiply add": lambda a, b, c: a * b + c,
    "power": lambda a, b, c: np.where(b == 0.0, 1.0, np.where(a > 0.0, np.maximum(a, 1e-37) ** b, 0.0)),
    "minimum": lambda a, b, c: np.minimum(a, b),
    "maximum": lambda a, b, c: np.maximum(a, b),
    "modulo": lambda a, b, c: np.where(b != 0.0, a - b * np.floor(divide(a, b)), 0.0),
    "greater": lambda a, b, c: np.where(a > b, 1.0, 0.0),
    "less": lambda a, b, c: np.where(a < b, 1.0, 0.0),
    "absolute": lambda a, b, c: np.abs(a),
    "negate": lambda a, b, c: -a,
    "sign": lambda a, b, c: np.sign(a),
    "floor": lambda a, b, c: np.floor(a),
    "ceiling": lambda a, b, c: np.ceil(a),
    "round": lambda a, b, c: np.floor(a + 0.5),
    "fraction": lambda a, b, c: a - np.floor(a),
    "square root": lambda a, b, c: np.sqrt(np.maximum(a, 0.0)),
    "exponential": lambda a, b, c: np.exp(np.minimum(a, 88.0)),
    "logarithm": lambda a, b, c: np.where(a > 0.0, np.log(np.maximum(a, 1e-37)), 0.0),
    "sine": lambda a, b, c: np.sin(a),
    "cosine": lambda a, b, c: np.cos(a),
    "arc tangent": lambda a, b, c: np.arctan2(a, b),
    "clamp": lambda a, b, c: np.maximum(np.minimum(a, c), b),
    "remap": lambda a, b, c: divide(a - b, np.subtract(c, b)),
    "smoothstep": lambda a, b, c: np.where(np.equal(b, c), a >= b, smoothstep(b, np.where(b == c, b + 1.0, c), a)),
    "mix": lambda a, b, c: mix(a, b, c),
}
"""What `math` calculates; an undefined result is 0."""


def math(a: Array | float, operation: str, b: Array | float, c: Array | float) -> Array:
    """Calculate with Fields and Numbers."""
    result = np.asarray(OPERATIONS[operation](np.asarray(a), np.asarray(b), np.asarray(c)), np.float64)
    return result if result.ndim else np.reshape(result, (1, 1, 1))


def project(a: Array, b: Array) -> Array:
    """The part of `a` along `b`."""
    return b * divide(dot(a, b), dot(b, b))


VECTOR_OPERATIONS = {
    "add": lambda a, b, c, factor: a + b,
    "subtract": lambda a, b, c, factor: a - b,
    "multiply": lambda a, b, c, factor: a * b,
    "divide": lambda a, b, c, factor: divide(a, b),
    "multiply add": lambda a, b, c, factor: a * b + c,
    "cross": lambda a, b, c, factor: np.cross(a, b),
    "project": lambda a, b, c, factor: project(a, b),
    "reflect": lambda a, b, c, factor: a - 2.0 * project(a, b),
    "scale": lambda a, b, c, factor: a * factor,
    "normalize": lambda a, b, c, factor: divide(a, length(a)),
    "absolute": lambda a, b, c, factor: np.abs(a),
    "minimum": lambda a, b, c, factor: np.minimum(a, b),
    "maximum": lambda a, b, c, factor: np.maximum(a, b),
    "floor": lambda a, b, c, factor: np.floor(a),
    "fraction": lambda a, b, c, factor: a - np.floor(a),
}
"""What `vector_math` calculates; an undefined result is 0."""


def vector_math(a: Array, operation: str, b: Array, c: Array, factor: Array | float) -> tuple[Array, Array, Array]:
    """Calculate with vectors: the result, the scalar product of a and b, and the length of the result."""
    u, v, w = (np.asarray(vector, np.float64) for vector in (a, b, c))
    u, v, w = (np.broadcast_to(vector, np.broadcast_shapes(vector.shape, (1, 1, 3))) for vector in (u, v, w))
    result = VECTOR_OPERATIONS[operation](u, v, w, factor)
    return result, dot(u, v), length(result)


def stereo(left: Array, right: Array, format: str, swap: bool) -> Array:
    """The pictures of two eyes in one: for red and cyan glasses (Dubois 2001), side by side, or row by row."""
    first, second = (right, left) if swap else (left, right)
    height, width = first.shape[:2]
    if format == "interlaced":
        return np.where(np.arange(height)[:, None, None] % 2 == 0, first, second)
    if format in ("side by side", "top and bottom"):
        axis = 0 if format == "side by side" else 1
        at = grid(width, height)
        middle = 0.5 * (width, height)[axis]
        is_second = at[..., axis : axis + 1] > middle
        at[..., axis] = 2.0 * np.where(is_second[..., 0], at[..., axis] - middle, at[..., axis])
        return np.where(is_second, bilinear(second, at), bilinear(first, at))
    if format == "dubois":
        for_left = np.array([[0.456, 0.5, 0.176], [-0.04, -0.038, -0.016], [-0.015, -0.021, -0.005]])
        for_right = np.array([[-0.043, -0.088, -0.002], [0.378, 0.734, -0.018], [-0.072, -0.113, 1.226]])
        color = first[..., :3] @ for_left.T + second[..., :3] @ for_right.T
    else:
        red, cyan = first[..., :1], second[..., 1:3]
        if format in ("half color anaglyph", "gray anaglyph"):
            red = luminance_of(first)
        if format == "gray anaglyph":
            cyan = np.repeat(luminance_of(second), 2, axis=-1)
        color = np.concatenate([red, cyan], axis=-1)
    return join(color, np.maximum(first[..., 3:], second[..., 3:]))


def select(
    which: int,
    a: Array | float = 0.0,
    b: Array | float = 0.0,
    c: Array | float = 0.0,
    d: Array | float = 0.0,
    e: Array | float = 0.0,
    f: Array | float = 0.0,
    g: Array | float = 0.0,
    h: Array | float = 0.0,
) -> Array:
    """One of several pictures, by number."""
    return np.asarray((a, b, c, d, e, f, g, h)[which - 1])
