"""Color: one pixel at a time."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from .pixels import (
    Array,
    display_tone,
    join,
    largest,
    luminance_of,
    mix,
    premultiply_color,
    rgb,
    smallest,
    smoothstep,
    srgb_decode,
    srgb_encode,
    straight,
)


def exposure(image: Array, stops: Array | float) -> Array:
    """Every stop doubles the light."""
    return join(image[..., :3] * np.exp2(stops), image[..., 3:])


def saturation(image: Array, saturation: Array | float) -> Array:
    """Move colors away from or toward gray; the luminance stays."""
    gray = luminance_of(image)
    return join(mix(gray, image[..., :3], saturation), image[..., 3:])


def luminance(image: Array, measure: str) -> Array:
    """How bright every pixel is, as it looks over black."""
    if measure == "average":
        return image[..., :3].mean(axis=-1, keepdims=True)
    return {"maximum": largest, "minimum": smallest}.get(measure, luminance_of)(image)


def grade(image: Array, lift: Array, gamma: Array, gain: Array, offset: Array, amount: Array | float) -> Array:
    """Lift, gamma, gain and offset, as in Nuke: (in (gain - lift) + lift + offset) ^ (1 / gamma).

    Works on the color without its alpha. Light below 0 skips the gamma.
    """
    alpha = image[..., 3:]
    lifted = image[..., :3] * (rgb(gain) - rgb(lift)) + alpha * (rgb(lift) + rgb(offset))
    color, _ = straight(join(lifted, alpha))
    bent = np.maximum(color, 0.0) ** (1.0 / np.maximum(rgb(gamma), 1e-3))
    return mix(image, premultiply_color(np.where(color > 0.0, bent, color), alpha), amount)


def cdl(image: Array, style: str, slope: Array, offset: Array, power: Array, saturation: Array | float) -> Array:
    """A color decision list (ASC CDL 1.2, 2009): (in slope + offset) ^ power, then saturation.

    "asc" limits light to 0..1 before the power and at the end; else light below 0 skips the power.
    """
    alpha = image[..., 3:]
    color, _ = straight(join(image[..., :3] * rgb(slope) + alpha * rgb(offset), alpha))
    if style == "asc":
        color = np.clip(color, 0.0, 1.0)
    color = np.where(color > 0.0, np.maximum(color, 1e-30) ** np.maximum(rgb(power), 0.0), color)
    color = mix(luminance_of(color), color, saturation)
    return premultiply_color(np.clip(color, 0.0, 1.0) if style == "asc" else color, alpha)


def color_balance(
    image: Array,
    lift: Array,
    gamma: Array,
    gain: Array,
    shadows: Array | float,
    midtones: Array | float,
    highlights: Array | float,
    low: Array | float,
    high: Array | float,
    blend: Array | float,
    show: str,
) -> Array:
    """Three color wheels, as Blender's Color Balance: lift moves black in sRGB codes, gain multiplies them, gamma is a
    power of the light. The three amounts say in which tones the change is seen."""

    def grade_codes(color: Array) -> Array:
        code = np.maximum((1.0 + (srgb_encode(color) - 1.0) * (2.0 - rgb(lift))) * rgb(gain), 0.0)
        return np.maximum(srgb_decode(code), 0.0) ** (1.0 / np.maximum(rgb(gamma), 1e-4))

    color, alpha = straight(image)
    tone = srgb_encode(np.maximum(luminance_of(color), 0.0))
    half = np.maximum(0.5 * blend, 1e-4)
    above = smoothstep(low - half, low + half, tone)
    top = smoothstep(high - half, high + half, tone)
    ranges = np.concatenate([1.0 - above, above * (1.0 - top), above * top], axis=-1)
    if show == "ranges":
        return premultiply_color(ranges, alpha)
    changed = grade_codes(color)
    changed = np.where(
        alpha > 1e-6, changed, changed - grade_codes(np.zeros((1, 1, 3)))
    )  # transparent pixels stay black
    amounts = [np.clip(amount, 0.0, 1.0) for amount in (shadows, midtones, highlights)]
    amount = sum(part * ranges[..., at : at + 1] for at, part in enumerate(amounts))
    return premultiply_color(mix(color, changed, amount), alpha)


def channel_mixer(
    image: Array,
    red: tuple[float, ...],
    green: tuple[float, ...],
    blue: tuple[float, ...],
    monochrome: bool,
    gray: tuple[float, ...],
    constant: tuple[float, ...],
    normalized: bool,
) -> Array:
    """Make every channel from a mix of red, green and blue, one row of a matrix for each."""
    rows = [gray] * 3 if monochrome else [red, green, blue]
    mixed = []
    for row in rows:
        parts = np.asarray(row, np.float64)
        total = parts.sum(axis=-1, keepdims=True)
        scale = np.where(normalized & (np.abs(total) > 1e-6), total, 1.0)
        mixed.append((image[..., :3] * parts).sum(axis=-1, keepdims=True) / scale)
    return join(np.concatenate(mixed, axis=-1) + image[..., 3:] * np.asarray(constant), image[..., 3:])


def clip(image: Array, low: Array | float, high: Array | float) -> Array:
    """Limit every channel to a range; transparent pixels stay black."""
    color, alpha = straight(image)
    lowest = np.where(alpha > 1e-6, low, np.minimum(low, 0.0))
    return premultiply_color(np.maximum(np.minimum(color, high), lowest), alpha)


def levels(
    image: Array,
    space: str,
    black: Array | float,
    white: Array | float,
    gamma: Array | float,
    low: Array | float,
    high: Array | float,
    clip: bool,
) -> Array:
    """low + (high - low) ((in - black) / (white - black)) ^ (1 / gamma); below black the line goes on."""
    color, alpha = straight(image)
    span = np.subtract(white, black)
    span = np.where(np.abs(span) < 1e-6, 1e-6, span)  # equal ends: a step
    covered = alpha > 1e-6  # transparent pixels stay black
    code = srgb_encode(color) if space == "display" else color
    level = (code - covered * black) / span
    if clip:
        level = np.clip(level, 0.0, 1.0)
    level = np.where(level > 0.0, np.maximum(level, 0.0) ** (1.0 / np.maximum(gamma, 0.01)), level)
    code = level * np.subtract(high, low) + covered * low
    return premultiply_color(srgb_decode(code) if space == "display" else code, alpha)


def invert(image: Array, space: str, amount: Array | float) -> Array:
    """The negative: 1 - c of sRGB codes or of light, or 0.18^2 / c within eight stops of middle gray."""
    color, alpha = straight(image)
    if space == "display":
        negative = srgb_decode(1.0 - srgb_encode(color))
    elif space == "linear":
        negative = 1.0 - color
    else:
        negative = 0.18**2 / np.clip(color, 0.18 / 256.0, 0.18 * 256.0)
    return premultiply_color(mix(color, negative, np.where(alpha > 1e-6, amount, 0.0)), alpha)


def posterize(image: Array, levels: Array | float, space: str, channels: str, amount: Array | float) -> Array:
    """Round to a few levels: round(c (levels - 1)) / (levels - 1), of each channel or of the luminance."""
    steps = np.maximum(levels, 2.0) - 1.0

    def level(light: Array) -> Array:
        code = srgb_encode(light) if space == "display" else light
        code = np.floor(code * steps + 0.5) / steps
        return srgb_decode(code) if space == "display" else code

    color, alpha = straight(image)
    light = luminance_of(color)
    ratio = np.where(light > 0.0, level(light) / np.where(light > 0.0, light, 1.0), 0.0)
    rounded = level(color) if channels == "separate" else color * ratio
    return premultiply_color(mix(color, rounded, amount), alpha)


def split_toning(
    image: Array,
    shadows: Array,
    highlights: Array,
    balance: Array | float,
    range: Array | float,
    amount: Array | float,
) -> Array:
    """Tint shadows and highlights in different colors; the luminance stays."""

    def tint(color: Array) -> Array:
        positive = np.maximum(rgb(color), 0.0)
        light = luminance_of(positive)
        return np.where(light > 1e-6, positive / np.maximum(light, 1e-6), 1.0)

    color, alpha = straight(image)
    light = luminance_of(color)
    safe = np.where(light > 0.0, light, 1.0)
    stops = np.log2(safe / 0.18) - balance
    bright = smoothstep(-0.5, 0.5, stops / np.maximum(range, 0.01))
    toned = color * mix(1.0, mix(tint(shadows), tint(highlights), bright), amount)
    toned = toned * np.clip(safe / np.maximum(luminance_of(toned), 1e-12), 0.0, 14.0)  # 14: blue has 0.0722
    return np.where(light > 0.0, premultiply_color(toned, alpha), image)


def vignette(
    image: Array,
    falloff: str,
    amount: Array | float,
    radius: Array | float,
    softness: Array | float,
    roundness: Array | float,
    center: Array | tuple[float, float],
) -> Array:
    """Darken toward the edges. 1 is the middle of an edge, 1.41 a corner; cos4 is the natural loss of a lens."""
    height, width = image.shape[:2]
    half = 0.5 * np.array([width, height])
    y, x = np.mgrid[:height, :width] + 0.5
    away = np.stack([x, y], axis=-1) - np.asarray(center) * (width, height)
    unit = mix(half, np.hypot(*half) * np.sqrt(0.5), roundness)
    off_axis = np.sqrt(((away / np.maximum(unit, 1e-3)) ** 2).sum(axis=-1, keepdims=True))
    if falloff == "smooth":
        inner, outer = radius * (1.0 - np.asarray(softness)), radius * (1.0 + np.asarray(softness))
        loss = smoothstep(inner, np.maximum(outer, inner + 1e-4), off_axis)
    else:
        loss = 1.0 - (1.0 + (off_axis / np.maximum(radius, 1e-3)) ** 2) ** -2
    return join(image[..., :3] * (1.0 - amount * loss), image[..., 3:])


def color_matrix(image: Array, matrix: tuple[float, ...], offset: Array | tuple[float, ...]) -> Array:
    """Multiply colors by a matrix of 3 x 3, one row for each channel of the result."""
    rows = np.reshape(matrix, (3, 3))
    return join(image[..., :3] @ rows.T + image[..., 3:] * np.asarray(offset), image[..., 3:])


def curve_at(points: tuple[float, ...], x: Array, extended: bool = False) -> Array:
    """The monotone cubic through x0, y0, x1, y1, ... (Fritsch and Butland 1984), level or straight beyond its ends."""
    xs, ys = np.array(points[0::2]), np.array(points[1::2])
    curve = PchipInterpolator(xs, ys)
    inside = np.clip(x, xs[0], xs[-1])
    value = curve(inside)
    if extended:
        slope = curve.derivative()
        value = value + np.where(x < xs[0], slope(xs[0]), slope(xs[-1])) * (x - inside)
    return value


def acescct_encode(light: Array) -> Array:
    """The ACEScct curve (Academy S-2016-001)."""
    linear = 10.5402377416545 * light + 0.0729055341958355
    return np.where(light <= 0.0078125, linear, (np.log2(np.maximum(light, 0.0078125)) + 9.72) / 17.52)


def acescct_decode(code: Array) -> Array:
    """The inverse of `acescct_encode`."""
    linear = (code - 0.0729055341958355) / 10.5402377416545
    return np.where(code <= 0.155251141552511, linear, np.exp2(np.minimum(code, 2.0) * 17.52 - 9.72))


def curves(
    image: Array,
    space: str,
    keep_color: bool,
    master: tuple[float, ...],
    red: tuple[float, ...],
    green: tuple[float, ...],
    blue: tuple[float, ...],
) -> Array:
    """One curve for all channels, then one for each; in sRGB codes, logarithms (ACEScct) or light."""
    encode = {"display": srgb_encode, "log": acescct_encode}.get(space, np.asarray)
    decode = {"display": srgb_decode, "log": acescct_decode}.get(space, np.asarray)

    def bent(color: Array) -> Array:
        if keep_color:  # the curve changes the luminance, and the ratios of the channels stay
            light = luminance_of(color)
            curved = decode(curve_at(master, encode(light), extended=True))
            ratio = curved / np.where(light > 1e-6, light, 1.0)
            code = encode(np.where(light > 1e-6, color * ratio, color + (curved - light)))
        else:
            code = curve_at(master, encode(color), extended=True)
        channels = [curve_at(c, code[..., i], extended=True) for i, c in enumerate((red, green, blue))]
        return decode(np.stack(channels, axis=-1))

    color, alpha = straight(image)
    changed = bent(color)
    changed = np.where(alpha > 1e-6, changed, changed - bent(np.zeros((1, 1, 3))))  # transparent pixels stay black
    return premultiply_color(changed, alpha)


def ramp_at(stops: tuple[float, ...], t: Array, smooth: bool = False) -> Array:
    """The color at t [height, width, 1] of a ramp t, r, g, b, a, t, r, ...; level beyond its ends."""
    table = np.reshape(stops, (-1, 5))
    if smooth:  # ease in and out between two stops
        after = np.clip(np.searchsorted(table[:, 0], t[..., 0], side="right"), 1, len(table) - 1)
        first, last = table[after - 1, 0], table[after, 0]
        u = np.clip((t[..., 0] - first) / np.maximum(last - first, 1e-12), 0.0, 1.0)
        t = (first + u * u * (3.0 - 2.0 * u) * (last - first))[..., None]
    return np.stack([np.interp(t[..., 0], table[:, 0], table[:, 1 + i]) for i in range(4)], axis=-1)


def gradient_map(
    image: Array,
    ramp: tuple[float, ...],
    scale: str,
    low: float,
    high: float,
    reverse: bool,
    smooth: bool,
    amount: float,
) -> Array:
    """Map brightness to the colors of a ramp, in stops, sRGB codes or light between `low` and `high`."""

    def scale_light(light: Array | float) -> Array:
        if scale == "stops":
            return np.log2(np.maximum(light, 1e-5))
        return srgb_encode(np.asarray(light)) if scale == "display" else np.asarray(light)

    color, alpha = straight(image)
    span = scale_light(high) - scale_light(low)
    span = np.where(np.abs(span) < 1e-6, 1e-6, span)  # equal ends: a step
    t = np.clip((scale_light(luminance_of(color)) - scale_light(low)) / span, 0.0, 1.0)
    painted = ramp_at(ramp, 1.0 - t if reverse else t, smooth)
    covered = painted[..., 3:] * alpha
    return mix(image, join(painted[..., :3] * covered, covered), amount)


def toon(image: Array, levels: Array | float, sharpness: Array | float) -> Array:
    """Soft quantization of the tone (Winnemöller et al. 2006): tanh between steps; hue and saturation stay."""
    color, alpha = straight(image)
    light = luminance_of(color)
    sharp = np.clip(sharpness, 1e-3, 80.0)
    step = 1.0 / (np.maximum(levels, 2.0) - 1.0)
    tone = display_tone(image)
    middle = (np.floor(tone / step) + 0.5) * step
    tone = np.maximum(middle + 0.5 * step * np.tanh(sharp * (tone - middle) / step) / np.tanh(0.5 * sharp), 0.0)
    painted = color * srgb_decode(tone) / np.where(light > 0.0, light, 1.0)
    return np.where(light > 0.0, premultiply_color(painted, alpha), image)
