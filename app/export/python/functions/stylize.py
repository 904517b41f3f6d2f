"""Prints, paint, grain and old television."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from .blur import blur_gaussian
from .hashing import hash3, normal3, stream_of
from .pixels import (
    Array,
    display_tone,
    display_tones,
    join,
    length,
    light_of_tones,
    luminance_of,
    mix,
    premultiply_color,
    smallest,
    srgb_decode,
    srgb_encode,
    straight,
)
from .places import Edge, bilinear, grid, shift_picture


def grain_clumps(places: Array, stream: Array) -> Array:
    """Normally distributed numbers, mean 0 and variance 1, in clumps: nine cells under a quadratic B-spline."""
    cell = np.floor(places)
    after = places - cell
    weights = [0.5 * (1.0 - after) ** 2, 0.5 + after * (1.0 - after), 0.5 * after**2]
    total, power = 0.0, np.sum([weight * weight for weight in weights], axis=0)
    for y in range(3):
        for x in range(3):
            corner = np.concatenate([cell + np.array([x - 1, y - 1]), np.zeros_like(cell[..., :1])], axis=-1)
            total = total + weights[x][..., :1] * weights[y][..., 1:] * normal3(corner, stream)
    return np.asarray(total / np.sqrt(power[..., :1] * power[..., 1:]))


def film_grain(
    image: Array,
    amount: Array | float,
    size: float,
    color: Array | float,
    shadows: Array | float,
    midtones: Array | float,
    highlights: Array | float,
    seed: int,
    animate: bool,
    frame: int,
) -> Array:
    """The grain of film: of the grains that light L meets, u = L / (L + 0.18) is developed, each by itself.

    So the density varies as sqrt(u (1 - u)) (Newson, Delon and Galerne 2017); light is multiplied by 2^grain, and
    divided by the mean of that factor. Pixels that hold several clumps average them (Selwyn 1935).
    """
    film, alpha = straight(image)
    height, width = image.shape[:2]
    stream = stream_of(seed, frame if animate else 0, 0)
    grain = grain_clumps(grid(width, height) / max(size, 1.0), stream)
    like = 1.0 - np.clip(color, 0.0, 1.0)  # the correlation of the three layers
    common = grain.mean(axis=-1, keepdims=True)
    grain = np.sqrt(1.0 - like) * (grain - common) + np.sqrt(1.0 + 2.0 * like) * common
    rest = 0.18 / (np.maximum(film, 0.0) + 0.18)
    developed = 1.0 - rest
    tone = shadows * rest**2 + 2.0 * np.asarray(midtones) * rest * developed + highlights * developed**2
    response = 2.0 * np.sqrt(rest * developed) * tone  # 1 at middle gray
    spread = np.log(2.0) * amount * (size / np.hypot(size, 0.55)) * response
    return premultiply_color(film * np.exp(spread * grain - 0.5 * spread**2), alpha)


def tv_snow(
    image: Array,
    amount: Array | float,
    mode: str,
    size: float,
    contrast: Array | float,
    lines: Array | float,
    color: Array | float,
    interlaced: bool,
    hold: int,
    seed: int,
    frame: int,
) -> Array:
    """Snow of a television set: white noise, filtered by 1/4, 1/2, 1/4 along each line, mixed with sRGB codes."""
    picture, alpha = straight(image)
    height, width = image.shape[:2]
    cell = np.floor(grid(width, height) / max(size, 1.0)).astype(np.int64)
    x, y = cell[..., :1], cell[..., 1:]
    moment = np.full_like(x, frame // max(hold, 1))
    if interlaced:  # lines of the other field change in the next frame
        moment = (moment + (y & 1)) >> 1
    taps = [
        weight * hash3(np.concatenate([x + tap, y, moment], axis=-1), stream_of(seed, 0, 0))
        for tap, weight in ((-1, 0.25), (0, 0.5), (1, 0.25))
    ]
    flakes = np.sum(taps, axis=0) - 0.5
    flakes = mix(flakes[..., :1], flakes, color)
    level = hash3(np.concatenate([y, moment, np.zeros_like(y)], axis=-1), stream_of(seed, 1, 0))[..., :1] - 0.5
    fine = min(size, 1.0)  # a pixel averages several lines, and as many flakes in each
    snow = np.clip(0.5 + contrast * (flakes * fine + level * np.sqrt(fine) * lines), 0.0, 1.0)
    code = srgb_encode(picture)
    code = mix(code, snow, amount) if mode == "mix" else code * (1.0 + amount * (2.0 * snow - 1.0))
    return premultiply_color(srgb_decode(code), alpha)


def nine_places(width: int, height: int) -> list[Array]:
    """Nine places inside of each pixel."""
    corners = grid(width, height) - 0.5
    return [corners + (np.array([i % 3, i // 3]) + 0.5) / 3.0 for i in range(9)]


def halftone_threshold(pattern: str, place: Array, angle: float) -> Array:
    """The tone at which ink reaches a place of a cell: all are equally frequent, so a tone covers its part."""
    along = place[..., :1] * np.cos(angle) + place[..., 1:] * np.sin(angle)
    across = -place[..., :1] * np.sin(angle) + place[..., 1:] * np.cos(angle)
    q = np.abs(np.concatenate([along, across], axis=-1) % 1.0 - 0.5)
    if pattern == "line":
        return 2.0 * q[..., 1:]
    if pattern == "cross":
        return 1.0 - (1.0 - 2.0 * q.min(axis=-1, keepdims=True)) ** 2
    radius = length(q)  # the part of a unit square that a disc covers
    outside = np.maximum(radius, 0.5)
    corner = outside**2 * np.arccos(0.5 / outside) - 0.5 * np.sqrt(outside**2 - 0.25)
    return np.pi * radius**2 - 4.0 * np.where(radius > 0.5, corner, 0.0)


def halftone(image: Array, inks: str, pattern: str, size: float, angle: float) -> Array:
    """Dots or lines of ink on white paper whose areas make the tones (Demichel's equation).

    Cyan, magenta, yellow and black have the angles of print: 15, 75, 0 and 45 degrees.
    """
    color, alpha = straight(image)
    height, width = image.shape[:2]
    absorbed = 1.0 - np.clip(color, 0.0, 1.0)
    if inks == "cmyk":
        black = smallest(absorbed)
        cover = np.concatenate([(absorbed - black) / np.maximum(1.0 - black, 1e-6), black], axis=-1)
    else:
        black = 1.0 - np.clip(luminance_of(color), 0.0, 1.0)
        cover = np.concatenate([np.zeros_like(absorbed), black], axis=-1)
    total = np.zeros_like(absorbed)
    for place in nine_places(width, height):
        paper = np.ones_like(absorbed)
        for ink, degrees in enumerate((15.0, 75.0, 0.0, 45.0)):
            amount = cover[..., ink : ink + 1]
            reached = halftone_threshold(pattern, place / max(size, 0.5), angle + np.radians(degrees)) < amount
            light = np.zeros(3) if ink == 3 else 1.0 - np.eye(3)[ink]
            paper = np.where((amount > 0.0) & reached, paper * light, paper)
        total = total + paper / 9.0
    return join(total * np.clip(alpha, 0.0, 1.0), alpha)


def layer_turn(layer: int) -> float:
    """The direction of a layer of strokes: 0, 90, 45, 135 degrees, ... (van der Corput sequence)."""
    half_turns, part = 0.0, 0.5
    while layer:
        half_turns, part, layer = half_turns + part * (layer & 1), 0.5 * part, layer >> 1
    return half_turns * np.pi


def crosshatch(
    image: Array, size: float, thickness: Array | float, layers: int, angle: float, ink: Array, paper: Array
) -> Array:
    """Strokes of a pen: the darker, the thicker, in more layers (tonal art maps, Praun et al. 2001)."""
    height, width = image.shape[:2]
    dark = (1.0 - np.minimum(display_tone(image), 1.0)) * layers
    covered = np.zeros_like(dark)
    for place in nine_places(width, height):
        hit = np.zeros(dark.shape, bool)
        for layer in range(min(layers, 16)):
            direction = angle + layer_turn(layer)
            across = (place[..., :1] * np.sin(direction) + place[..., 1:] * np.cos(direction)) / max(size, 0.5)
            beside = 2.0 * np.abs(across % 1.0 - 0.5)
            hit |= beside < np.clip(dark - layer, 0.0, 1.0) * thickness
        covered = covered + hit / 9.0
    color = mix(np.asarray(paper), np.asarray(ink), covered)
    return join(color[..., :3] * color[..., 3:] * image[..., 3:], image[..., 3:])


def glitch(
    image: Array, amount: float, shift: float, colors: float, band: float, hold: int, seed: int, edge: Edge, frame: int
) -> Array:
    """Bands that jump sideways, as in damaged video: wide ones, and others of a quarter of their height.

    A row of pixels where two bands meet shows both, by what they cover; thinner bands are seen in its middle.
    """
    height, width = image.shape[:2]
    places, thin = grid(width, height), 0.25 * band
    top = places[..., 1:] - 0.5
    end = thin * np.ceil(top / thin)
    covered = np.clip(end - top, 0.0, 1.0)
    seen = [(covered, end - 0.5 * thin), (1.0 - covered, end + 0.5 * thin)] if thin > 1.0 else [(1.0, top + 0.5)]
    result = np.zeros_like(image)
    for weight, at in seen:
        moved, apart = np.zeros((height, width, 1)), np.zeros((height, width, 1))
        for level, part in enumerate((band, thin)):
            row = np.floor(at / part)
            cells = np.concatenate([row, np.full_like(row, frame // hold), np.full_like(row, level)], axis=-1)
            dice = hash3(cells, np.array([seed, 0, 0]))
            jumps = dice[..., :1] < amount
            moved += np.where(jumps, shift * (2.0 * dice[..., 1:2] - 1.0), 0.0)
            apart += np.where(jumps, colors * (2.0 * dice[..., 2:] - 1.0), 0.0)
        right = np.array([1.0, 0.0])
        red, middle, blue = (
            bilinear(image, places + (moved + side * apart) * right, edge) for side in (1.0, 0.0, -1.0)
        )
        result += weight * np.concatenate([red[..., :1], middle[..., 1:2], blue[..., 2:3], middle[..., 3:]], axis=-1)
    return result


def mean_cosine(phase: Array, width: float) -> Array:
    """The mean of a cosine over `width` turns; periods near two pixels fade out, so that nothing beats."""
    if width >= 0.5:
        return np.zeros_like(phase)
    return min(10.0 - 20.0 * width, 1.0) * np.cos(2.0 * np.pi * phase) * np.sinc(width)


def crt(
    image: Array,
    barrel: float,
    jitter: float,
    chroma_delay: float,
    lines: float,
    scanlines: float,
    mask: str,
    mask_strength: float,
    triad: float,
    frame: int,
) -> Array:
    """An old television tube: a bulging screen, uneven lines, late color, scan lines and phosphor stripes."""
    height, width = image.shape[:2]
    at, center = grid(width, height), 0.5 * np.array([width, height])
    away = (at - center) / center[1]
    source = center + center[1] * away * (1.0 + barrel * (away * away).sum(axis=-1, keepdims=True))
    line = source[..., 1:] / height * lines
    zero = np.zeros_like(line)
    dice = hash3(np.concatenate([np.floor(line), zero + frame, zero], axis=-1), np.zeros(3))[..., :1]
    source = source + jitter * (2.0 * dice - 1.0) * np.array([1.0, 0.0])
    light, late = bilinear(image, source, "black"), bilinear(image, source - (chroma_delay, 0.0), "black")
    color = luminance_of(light) + late[..., :3] - luminance_of(late)
    color = color * (1.0 - 0.5 * scanlines * (1.0 + mean_cosine(line, lines / height))) / (1.0 - 0.5 * scanlines)
    if mask != "none":
        stripe = at[..., :1] / triad
        if mask == "shadow mask":
            stripe = stripe + 0.5 * (np.floor(at[..., 1:] / triad) % 2.0)
        color = color * (1.0 + mask_strength * mean_cosine(stripe - (np.arange(3) + 0.5) / 3.0, 1.0 / triad))
    return join(color, light[..., 3:])


def oil(image: Array, radius: float, levels: int, edge: Edge) -> Array:
    """The mean color of the most frequent step of tone in a disc (Holzmann 1988, "Beyond Photography")."""
    tones = display_tones(image)
    level = np.clip(luminance_of(straight(tones)[0]), 0.0, 1.0) * levels
    level = np.minimum(level.astype(int), levels - 1)
    best, most = np.zeros_like(tones), np.full(level.shape, -1.0)
    reach = int(np.ceil(radius))
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    disc = ((x * x + y * y) <= radius * radius).astype(float)[..., None]
    modes = {"clamp": "nearest", "black": "constant"}
    for step in range(levels):
        inside = (level == step).astype(float)
        count = ndimage.correlate(inside, disc, mode=modes.get(edge, edge), cval=float(step == 0))
        total = ndimage.correlate(tones * inside, disc, mode=modes.get(edge, edge))
        fuller = np.round(count) > most  # of steps with as many pixels, the darkest
        best = np.where(fuller, total / np.maximum(count, 1.0), best)
        most = np.where(fuller, np.round(count), most)
    return light_of_tones(best)


def structure(picture: Array, edge: str) -> Array:
    """The structure tensor xx, xy, yy of the Sobel gradient, summed over all channels (Förstner and Gülch 1987)."""

    def difference(x: int, y: int) -> Array:
        return shift_picture(picture, x, y, edge) - shift_picture(picture, -x, -y, edge)

    falling, rising = difference(1, 1), difference(1, -1)
    across = (2.0 * difference(1, 0) + falling + rising) / 4.0
    down = (2.0 * difference(0, 1) + falling - rising) / 4.0
    return np.stack([(a * b).sum(axis=-1) for a, b in ((across, across), (across, down), (down, down))], axis=-1)


def kuwahara_classic(tones: Array, radius: int, edge: str) -> Array:
    """The mean of the quadrant with the least variance (Kuwahara et al. 1976)."""
    best, least = np.zeros_like(tones), np.full((*tones.shape[:2], 1), np.inf)
    for quadrant in range(4):
        total, squares = np.zeros_like(tones), np.zeros_like(tones[..., :1])
        for y in range(radius + 1):
            for x in range(radius + 1):
                other = shift_picture(
                    tones, x - radius * (1 - (quadrant & 1)), y - radius * (1 - (quadrant >> 1)), edge
                )
                total += other - tones
                squares += ((other - tones)[..., :3] ** 2).sum(axis=-1, keepdims=True)
        mean = total / (radius + 1) ** 2
        variance = squares / (radius + 1) ** 2 - (mean[..., :3] ** 2).sum(axis=-1, keepdims=True)
        best, least = np.where(variance < least, mean, best), np.minimum(variance, least)
    return tones + best


def kuwahara_sectors(tones: Array, tensor: Array, radius: float, sharpness: float, stretched: bool, edge: str) -> Array:
    """Eight soft sectors of a disc, which count less the more they vary (Papari et al. 2007).

    The disc is stretched along the strokes of the picture (Kyprianidis et al. 2009), with polynomial weights (2010).
    """
    xx, xy, yy = tensor[..., 0:1], tensor[..., 1:2], tensor[..., 2:3]
    apart = np.hypot(xx - yy, 2.0 * xy)
    has_way = (apart > 1e-12) & stretched
    anisotropy = np.where(has_way, apart / np.where(has_way, xx + yy, 1.0), 0.0)
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    along_x, along_y = np.where(has_way, -np.sin(angle), 1.0), np.where(has_way, np.cos(angle), 0.0)
    long, short = radius * (1.0 + anisotropy), radius / (1.0 + anisotropy)
    zeta, crossing = 2.0 / radius, 0.1875 * np.pi
    eta = (zeta + np.cos(crossing)) / np.sin(crossing) ** 2
    sums = [np.zeros_like(tones) for _ in range(8)]
    squares, totals = ([np.zeros_like(xx) for _ in range(8)] for _ in range(2))
    reach = int(np.ceil(2.0 * radius))
    for y in range(-reach, reach + 1):
        for x in range(-reach, reach + 1):
            u, v = (along_x * x + along_y * y) / long, (-along_y * x + along_x * y) / short
            square = u * u + v * v
            if not (square <= 1.0).any():
                continue
            shares = []
            for k in range(8):
                cos, sin = np.cos(k * np.pi / 4.0), np.sin(k * np.pi / 4.0)
                a, b = cos * u + sin * v, -sin * u + cos * v
                shares.append(np.maximum(a + zeta - eta * b * b, 0.0) ** 2)
            whole = sum(shares)
            weight = np.where(square <= 1.0, np.exp(-3.125 * square) / np.where(whole > 0.0, whole, 1.0), 0.0)
            other = shift_picture(tones, x, y, edge) - tones
            for k, share in enumerate(shares):
                sums[k] += weight * share * other
                squares[k] += weight * share * (other[..., :3] ** 2).sum(axis=-1, keepdims=True)
                totals[k] += weight * share
    result, total = np.zeros_like(tones), np.zeros_like(xx)
    for k in range(8):
        mean = sums[k] / totals[k]
        deviation = np.sqrt(np.maximum(squares[k] / totals[k] - (mean[..., :3] ** 2).sum(axis=-1, keepdims=True), 0.0))
        calm = 1.0 / (1.0 + np.minimum(255.0 * deviation, 1e3) ** sharpness)
        result, total = result + calm * mean, total + calm
    return tones + result / total


def kuwahara(image: Array, kind: str, radius: float, sharpness: float, smoothing: float, edge: Edge) -> Array:
    """The mean of the most even area around each pixel, on sRGB codes: detail goes, edges stay."""
    tones = display_tones(image)
    if kind == "classic":
        return light_of_tones(kuwahara_classic(tones, int(np.ceil(radius - 0.5)), edge))
    tensor = blur_gaussian(structure(tones[..., :3], edge), smoothing, edge)
    return light_of_tones(kuwahara_sectors(tones, tensor, radius, sharpness, kind == "anisotropic", edge))
