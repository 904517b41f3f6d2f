"""Light that spreads, and light of many wavelengths."""

from __future__ import annotations

from math import ceil, remainder
from typing import Literal

import numpy as np

from .blur import blur_gaussian, gaussian_blur
from .color import curve_at
from .pixels import Array, join, largest, luminance_of, mix, rgb, smoothstep
from .places import Edge, bilinear, extend, grid


def soft_threshold(light: Array, threshold: Array | float, knee: Array | float) -> Array:
    """The light above a threshold, with a quadratic transition that is `knee` times as wide (Takahashi 2015)."""
    above, width = light - threshold, np.multiply(threshold, knee)
    eased = np.clip(above + width, 0.0, 2.0 * width)
    return np.maximum(eased * eased / (4.0 * width + 1e-5), above)


def bright_light(image: Array, threshold: float, knee: float, limit: float) -> Array:
    """The light above a soft threshold, not brighter than the limit; hue and alpha stay."""
    light = luminance_of(image)
    safe = np.where(light > 0.0, light, 1.0)
    share = np.where(light > 0.0, soft_threshold(np.minimum(light, limit), threshold, knee) / safe, 0.0)
    return join(image[..., :3] * share, image[..., 3:])


def bright_pass(
    image: Array,
    mask: Array | float,
    mode: str,
    measure: str,
    threshold: Array | float,
    knee: Array | float,
    power: Array | float,
    limit: Array | float,
) -> Array:
    """Keep only the light that should glow. The color is scaled to the new brightness."""
    light = largest(image) if measure == "maximum" else luminance_of(image)
    safe = np.where(light > 0.0, light, 1.0)
    bounded = np.minimum(safe, limit)
    ratio = bounded / np.maximum(threshold, 1e-5)
    glowing = {
        "hard": np.where(bounded > threshold, bounded, 0.0),
        "soft": soft_threshold(bounded, threshold, knee),
        "exponential": bounded * (1.0 - np.exp(-(ratio**power))),
        "power": bounded * ratio**power,
    }.get(mode, bounded)
    share = np.where(light > 0.0, glowing / safe * np.clip(mask, 0.0, 1.0), 0.0)
    return join(np.clip(image[..., :3] * share, -65504.0, 65504.0), image[..., 3:])


def shrink_by_two(image: Array, edge: str) -> Array:
    """Half the size: five overlapping boxes of 4 x 4 pixels, the middle one counts four times (Jimenez 2014)."""
    corners, center = np.array([1, 1, 2, 2, 1, 1]), np.array([0, 1, 1, 1, 1, 0])
    weights = (np.outer(corners, corners) + 4.0 * np.outer(center, center)) / 128.0
    height, width = image.shape[:2]
    padded = extend(image, 2, 4, edge)
    rows, columns = (height + 1) // 2, (width + 1) // 2
    parts = [weights[y, x] * padded[y : y + 2 * rows : 2, x : x + 2 * columns : 2] for y in range(6) for x in range(6)]
    return np.sum(parts, axis=0)


def shrink_steadily(image: Array, edge: str) -> Array:
    """The same boxes, each weighted by 1 / (1 + luminance), so that a single bright pixel does not flicker (Karis)."""
    padded = extend(image, 2, 4, edge)
    rows, columns = (image.shape[0] + 1) // 2, (image.shape[1] + 1) // 2
    total, whole = 0.0, 0.0
    for down, right, part in ((0, 0, 1.0), (0, 2, 1.0), (2, 0, 1.0), (2, 2, 1.0), (1, 1, 4.0)):
        box = sum(
            padded[down + y : down + y + 2 * rows : 2, right + x : right + x + 2 * columns : 2] / 16.0
            for y in range(4)
            for x in range(4)
        )
        weight = part / (1.0 + np.maximum(luminance_of(np.asarray(box)), 0.0))
        total, whole = total + weight * box, whole + weight
    return np.asarray(total / whole)


def halve(image: Array, edge: str, firefly: bool) -> Array:
    """The picture at half its size."""
    if firefly:
        return shrink_steadily(image, edge)
    return shrink_by_two(image, edge)


def grow_by_two(image: Array, width: int, height: int, edge: str) -> Array:
    """Twice the size: the tent filter [1 2 1] on bilinear samples, which is four taps along each axis."""
    tent = np.array([1.0, 5.0, 7.0, 3.0]) / 16.0
    padded = extend(image, 2, 2, edge)
    for axis, size in ((0, height), (1, width)):
        place = np.arange(size)
        first = (place + 1) // 2  # of the padded picture
        grown = 0.0
        for tap in range(4):
            weight = np.where(place % 2 == 0, tent[tap], tent[3 - tap])
            weight = weight[:, None, None] if axis == 0 else weight[None, :, None]
            grown = grown + weight * np.take(padded, first + tap, axis=axis)
        padded = np.asarray(grown)
    return padded


def glow_pyramid(light: Array, shares: list[float], edge: str, firefly: bool = False) -> Array:
    """Light that is blurred on the way down a pyramid of halves, and on the way up again.

    `shares` says how much of each level comes from the smaller ones.
    """
    height, width = light.shape[:2]
    if edge != "clamp" and (width % 2 or height % 2):  # at an odd size the edge would mean other pixels: pad once
        margin = 7 * 2 ** len(shares)
        wide = extend(light, margin, margin, edge)
        return glow_pyramid(wide, shares, "clamp", firefly)[margin : margin + height, margin : margin + width]
    below = halve(light, edge, firefly)
    if len(shares) > 1:
        below = glow_pyramid(below, shares[1:], edge)
    return mix(light, grow_by_two(below, width, height, edge), shares[0])


def pyramid_amounts(radius: float, scatter: float, levels: tuple[float, ...]) -> tuple[list[float], list[float]]:
    """How much of a glow lies on each level: on the four finer than pixels, from level -4, and on the others."""
    variance = radius * radius
    last = int(np.log(1.0 + variance / 1.5) / np.log(4.0))
    part = (variance - 1.5 * (4.0**last - 1.0)) / (4.5 * 4.0**last)
    octaves = 4
    fine, amounts, rest = [0.0] * octaves, [0.0] * (last + 2), 1.0
    for level in range(min(last - octaves, 0), last + 2):
        octave = last + part - level  # from the radius to how wide this level is, in halvings
        share = scatter ** min(max(octaves + 1.0 - octave, 0.0), 1.0) * (part if level == last else 1.0)
        here = rest if level == last + 1 else rest * (1.0 - share)
        height = float(curve_at(levels, np.array(1.0 - octave / octaves)))
        (fine if level < 0 else amounts)[level] = here * max(height, 1e-12)
        rest -= here
    return fine, amounts


def pyramid_shares(amounts: list[float]) -> list[float]:
    """How much of each level of the pyramid comes from the smaller ones."""
    below = [sum(amounts[level:]) for level in range(len(amounts) + 1)]
    return [below[level + 1] / below[level] if below[level] > 0.0 else 1.0 for level in range(len(amounts) - 1)]


def spread_light(
    light: Array, radius: float, scatter: float, levels: tuple[float, ...], edge: str, firefly: bool, exact: bool
) -> Array:
    """The glow of a light. An exact one has as much variance at each level as the square of its pixels times 1.5."""
    variance = radius * radius
    missing = min(variance, 1.5) if exact else 0.0
    fine, amounts = pyramid_amounts(float(np.sqrt(variance - missing)), scatter, levels)
    finest = sum(fine)
    if not exact:
        amounts[0] += finest  # what is finer than the picture stays on its finest level
    glow = glow_pyramid(blur_gaussian(light, float(np.sqrt(missing)), edge), pyramid_shares(amounts), edge, firefly)
    if not exact or finest <= 0.0:
        return glow
    narrow = sum(amount * missing * 4.0 ** (level - len(fine)) for level, amount in enumerate(fine)) / finest
    return mix(glow, blur_gaussian(light, float(np.sqrt(narrow)), edge), finest / (finest + sum(amounts)))


def bloom(
    image: Array,
    radius: float,
    scatter: float,
    levels: tuple[float, ...],
    tint: tuple[float, ...],
    intensity: float,
    mode: str,
    threshold: float,
    knee: float,
    limit: float,
    firefly: bool,
    exact: bool,
    edge: Literal["clamp", "reflect", "wrap"],
) -> tuple[Array, Array]:
    """Let bright light bleed over its surroundings (Jimenez 2014): the picture with its glow, and the glow alone."""
    light = image
    if threshold > 0.0 or limit < 65504.0:
        light = bright_light(image, threshold, knee, limit)
    glow = spread_light(light, radius, scatter, levels, edge, firefly, exact)
    glow = join(glow[..., :3] * rgb(tint), glow[..., 3:])
    color = image[..., :3]
    shone = color + intensity * glow[..., :3] if mode == "add" else mix(color, glow[..., :3], intensity)
    return join(shone, image[..., 3:]), glow


def spectrum_response(place: float) -> Array:
    """The response of red, green, blue and alpha to a place in the spectrum, from -1 (red) to 1 (blue)."""
    return np.array([max(-place, 0.0), 1.0 - abs(place), max(place, 0.0), 1.0])


def chromatic_aberration(
    image: Array, shape: str, amount: float, angle: float, samples: int, center: tuple[float, float], edge: Edge
) -> Array:
    """Spread light into its colors along a line, as a lens that bends blue more than red."""
    height, width = image.shape[:2]
    at = grid(width, height)
    middle = np.asarray(center) * (width, height)
    radial = (at - middle) / (0.5 * height)
    spread = amount * (radial if shape == "radial" else np.array([np.cos(angle), np.sin(angle)]))
    total, whole = np.zeros_like(image), np.zeros(4)
    for i in range(samples):
        place = 2.0 * i / (samples - 1) - 1.0
        response = spectrum_response(place)
        total += response * bilinear(image, at + place * spread, edge)
        whole += response
    return total / whole


def sun_beams(
    image: Array,
    mask: Array | float,
    source: tuple[float, float],
    radius: float,
    length: float,
    decay: float,
    intensity: float,
    tint: tuple[float, ...],
    threshold: float,
    knee: float,
    limit: float,
    quality: Literal["full"],
) -> tuple[Array, Array]:
    """Light shafts (Mitchell 2007): every pixel gathers the bright light between itself and the source.

    The mean at source + (pixel - source) shrink^n with the weights fade^n, as passes of four samples each.
    """
    height, width = image.shape[:2]
    at, middle = grid(width, height), np.asarray(source) * (width, height)
    away = at - middle
    far = np.sqrt((away * away).sum(axis=-1, keepdims=True))
    near = 1.0 - smoothstep(radius, 2.0 * radius, far) if radius > 0.0 else 0.0 * far
    beams = bright_light(image, threshold, knee, limit) * near * np.clip(mask, 0.0, 1.0)
    farthest = np.hypot(*(max(abs(m), abs(side - m)) for m, side in zip(middle, (width, height), strict=True)))
    apart = -farthest * np.log(max(1.0 - length, 0.01))
    samples = 4 ** max(ceil(np.log(max(apart, 1.0)) / np.log(4.0)), 1)
    stride = samples
    while stride > 1:
        stride //= 4
        shrink, fade = (max(1.0 - part, 0.01) ** (stride / samples) for part in (length, decay))
        weights = fade ** np.arange(4)
        places = [middle + away * shrink**i for i in range(4)]
        read = [weight * bilinear(beams, place, "black") for weight, place in zip(weights, places, strict=True)]
        beams = np.sum(read, axis=0) / weights.sum()
    glow = join(beams[..., :3] * rgb(tint), image[..., 3:])
    return join(image[..., :3] + intensity * glow[..., :3], image[..., 3:]), glow


def shrunk(image: Array, factor: int, edge: str) -> Array:
    """The mean of each block of pixels; beyond the border as the edge says."""
    height, width = image.shape[:2]
    pads = ((0, -height % factor), (0, -width % factor), (0, 0))
    padded = np.pad(image, pads, mode="edge") if edge == "clamp" else np.pad(image, pads)
    rows, columns = padded.shape[0] // factor, padded.shape[1] // factor
    return padded.reshape(rows, factor, columns, factor, 4).mean(axis=(1, 3))


def enlarge(image: Array, factor: int, width: int, height: int) -> Array:
    """The picture at a multiple of its size, by bilinear interpolation."""
    return bilinear(image, grid(width, height) / factor)


def streak(light: Array, angle: float, reach: float, dispersion: float, edge: str) -> Array:
    """Light along one arm, which fades to a hundredth at `reach`, red and blue at other lengths (Kawase 2003).

    Each pass is the mean of four samples, with four times the distance and fade^4 of the pass before: their product is
    the geometric series of all samples.
    """
    height, width = light.shape[:2]
    back = np.array([-np.cos(angle), np.sin(angle)])  # a pixel finds its light where the arm came from
    lengths = np.maximum(reach * (np.array([611.0, 549.0, 464.0]) / 549.0) ** dispersion, 1e-3)
    stride = 1
    while stride < 1.5 * lengths.max():
        fade = 0.01 ** (stride / lengths)
        total, whole = 0.0, 0.0
        for i in range(4):
            total = total + fade**i * bilinear(light, grid(width, height) + i * stride * back, edge)[..., :3]
            whole = whole + fade**i
        light = join(np.asarray(total / whole), np.ones_like(light[..., :1]))
        stride *= 4
    return light


def streaks(
    image: Array,
    arms: int,
    length: float,
    angle: float,
    dispersion: float,
    intensity: float,
    tint: tuple[float, ...],
    threshold: float,
    knee: float,
    limit: float,
    quality: str,
    edge: str,
) -> tuple[Array, Array]:
    """Long straight streaks from bright light: the picture with them, and the streaks alone."""
    height, width = image.shape[:2]
    factor = {"full": 1, "half": 2, "quarter": 4}[quality]
    light = shrunk(bright_light(image, threshold, knee, limit), factor, edge)
    arm_angles = [angle + 2.0 * np.pi * arm / arms for arm in range(arms)]
    star = sum(streak(light, arm_angle, length / factor, dispersion, edge) for arm_angle in arm_angles)
    star = np.asarray(star) if factor == 1 else enlarge(np.asarray(star), factor, width, height)
    glow = join(star[..., :3] / arms * rgb(tint), image[..., 3:])
    return join(image[..., :3] + intensity * glow[..., :3], image[..., 3:]), glow


def halo_mixture(reach: float) -> list[tuple[float, float]]:
    """Gaussians, with their shares, of the light that comes back from behind the film: b^2 / (pi (r^2 + b^2)^2).

    The 42 percent that leave the film within the critical angle are taken off as a narrow Gaussian.
    """
    sigmas = np.array([0.22, 0.33, 0.5, 0.74, 1.11, 1.67, 2.5, 3.76])
    straight_back = ((1.48 - 1.0) / (1.48 + 1.0)) ** 2  # Fresnel's reflection of triacetate
    precisions = (reach / sigmas) ** 2
    bounds = [0.0, *np.exp(-0.5 * np.sqrt(precisions[:-1] * precisions[1:])), 1.0]
    back = np.diff(bounds)
    variance = 0.5 * 0.416 / (1.0 - straight_back)
    lost = (1.0 - straight_back) * variance * (back * precisions).sum()
    shares = [*(back / (1.0 - lost)), -lost / (1.0 - lost)]
    return list(zip([*sigmas, np.sqrt(variance) * reach], shares, strict=True))


def film_halation(
    image: Array,
    amount: float,
    color: tuple[float, ...],
    radius: float,
    reach: tuple[float, ...],
    threshold: tuple[float, ...],
    knee: float,
    limit: float,
    edge: Literal["clamp", "reflect", "wrap"],
) -> tuple[Array, Array]:
    """The halo of bright light on film, one for each layer of color: the picture with it, and the halo alone."""
    light = np.clip(image[..., :3], 0.0, limit)
    light = np.where(light > 0.0, soft_threshold(light, np.asarray(threshold), knee), 0.0)
    thickness = radius / np.tan(np.arcsin(1.0 / 1.48))  # total reflection begins at this radius
    layers = []
    for layer in range(3):
        channel = light[..., layer : layer + 1]
        mixture = halo_mixture(min(max(reach[layer], 0.5), 1.0))
        layers.append(sum(share * blur_gaussian(channel, sigma * thickness, edge) for sigma, share in mixture))
    glow = join(amount * rgb(color) * np.maximum(np.concatenate(layers, axis=-1), 0.0), image[..., 3:])
    return join(image[..., :3] + glow[..., :3], image[..., 3:]), glow


def star_turned(image: Array, width: int, height: int, angle: float, edge: str) -> Array:
    """The picture turned counterclockwise about its middle, at another size."""
    rows, columns = image.shape[:2]
    at = grid(width, height) - 0.5 * np.array([width, height])
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = at[..., :1], at[..., 1:]
    places = np.concatenate([0.5 * columns + cos * x - sin * y, 0.5 * rows + sin * x + cos * y], axis=-1)
    return bilinear(image, places, edge)


def star(
    image: Array,
    length: float,
    angle: float,
    intensity: float,
    tint: Array,
    threshold: float,
    knee: float,
    limit: float,
    edge: Edge,
) -> tuple[Array, Array]:
    """A star with four points on bright light, and the star alone: Gaussians in two directions, added."""
    light = bright_light(image, threshold, knee, limit)
    height, width = image.shape[:2]
    angle = remainder(angle, 0.5 * np.pi)
    turned = abs(angle) > 1e-5
    if turned:  # a frame that holds the turned picture, with a pixel around it
        cos, sin = abs(np.cos(angle)), abs(np.sin(angle))
        frame = ceil(width * cos + height * sin) + 2, ceil(width * sin + height * cos) + 2
        light = star_turned(light, *frame, -angle, edge)
    arms = 0.5 * (gaussian_blur(light, length, (1.0, 0.0), edge) + gaussian_blur(light, length, (0.0, 1.0), edge))
    if turned:
        arms = star_turned(arms, width, height, angle, edge)
    glow = join(arms[..., :3] * rgb(tint), image[..., 3:])
    return join(image[..., :3] + intensity * glow[..., :3], image[..., 3:]), glow
