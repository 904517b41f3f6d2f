"""Layers of renders: depth, numbers of objects, light."""

from __future__ import annotations

import re

import numpy as np

from .hashing import pcg3d, unit
from .pixels import Array, join, largest, length, luminance_of, mix, premultiply_color, straight
from .places import shift_picture
from .tone import with_hue

FAR = 1e9  # larger depths are background, which renderers write as 1e10 or infinity


def nearness(depth: Array) -> Array:
    """1 / depth, which is linear on every plane; 0 on the background."""
    is_surface = np.isfinite(depth) & (depth > 0.0) & (depth < FAR)
    return np.where(is_surface, 1.0 / np.where(is_surface, depth, 1.0), 0.0)


def positive_share(value: Array, slopes: tuple[Array, Array]) -> Array:
    """The part of a pixel on the positive side of a line, from the value at its center and the slopes."""
    steep = [np.abs(slope) for slope in slopes]
    most, least = np.maximum(*steep), np.minimum(*steep)
    corner, away = 0.5 * (most + least), np.abs(value)
    straight_cut = 0.5 - away / np.maximum(most, 1e-30)
    corner_cut = 0.5 * (corner - away) ** 2 / np.maximum(most * least, 1e-30)
    rest = np.where(away <= 0.5 * (most - least), straight_cut, corner_cut)
    rest = np.where((away >= corner) | (most <= 0.0), 0.0, rest)
    return np.where(value > 0.0, 1.0 - rest, rest)


def depth_merge(a: Array, a_depth: Array, b: Array, b_depth: Array, antialias: bool) -> tuple[Array, Array]:
    """The nearer of two pictures over the other one, and its depth; edges where they cut are antialiased."""
    lead = nearness(a_depth) - nearness(b_depth)
    if antialias:
        slopes = []
        for right, down in ((1, 0), (0, 1)):  # on the side that shows the same two surfaces
            ahead, behind = shift_picture(lead, right, down) - lead, lead - shift_picture(lead, -right, -down)
            slopes.append(np.where(np.abs(ahead) < np.abs(behind), ahead, behind))
        share = positive_share(lead, (slopes[0], slopes[1]))
    else:
        share = np.where(lead > 0.0, 1.0, 0.0)
    front = a + b * (1.0 - np.clip(a[..., 3:], 0.0, 1.0))
    back = b + a * (1.0 - np.clip(b[..., 3:], 0.0, 1.0))
    near = np.maximum(nearness(a_depth), nearness(b_depth))
    depth = np.where(near > 0.0, 1.0 / np.where(near > 0.0, near, 1.0), 1e10)
    return share * front + (1.0 - share) * back, depth


def id_mask(ids: Array, pick: str, invert: bool) -> tuple[Array, Array]:
    """Where objects have one of the numbers that a text names, such as 1, 4, 7-9; and a color for each number."""
    number = r"(-?\d+(?:\.\d+)?)"
    mask = np.zeros_like(ids)
    for first, last in re.findall(rf"(?<![\w.]){number}(?:\s*-\s*{number})?(?![\w.])", pick):
        mask = np.where((ids >= float(first)) & (ids <= float(last or first)), 1.0, mask)
    bits = ids.astype(np.float32).view(np.uint32)
    chance = unit(pcg3d(np.concatenate([bits, np.full_like(bits, 16), np.full_like(bits, 12)], axis=-1)))
    pale = np.concatenate([np.ones_like(ids), 0.05 + 0.3 * chance[..., 1:2], np.full_like(ids, 0.5)], axis=-1)
    color = np.where(ids == 0.0, 0.0, with_hue(pale, chance[..., :1]) * (0.3 + 0.7 * chance[..., 2:]))
    return 1.0 - mask if invert else mask, join(color, np.ones_like(ids))


def material_from_glossy(matte: Array, shiny: Array) -> tuple[Array, Array]:
    """The color of surfaces, and how much of them is metal, of their diffuse and glossy colors.

    A surface of color b of which x is no metal has the diffuse color b x and the glossy color b (1 - x) + 0.04 x.
    """
    total = np.maximum(matte, 0.0) + np.maximum(shiny, 0.0)
    channel = total.argmax(axis=-1)[..., None]
    both = np.take_along_axis(total, channel, axis=-1)
    diffuse = np.maximum(np.take_along_axis(matte, channel, axis=-1), 0.0)
    root = np.sqrt(np.maximum(both * both - 4.0 * 0.04 * diffuse, 0.0))
    less, more = (both - root) / 0.08, (both + root) / 0.08
    plain = np.where(both > 0.0, np.clip(np.where(more <= 1.0, more, less), 0.0, 1.0), 1.0)
    return np.clip(total - 0.04 * plain, 0.0, 1.0), 1.0 - plain


def material_from_light(matte: Array, light: Array, emitted: Array, reflectance: float) -> tuple[Array, Array]:
    """The same where the light of a black surface, but for what it emits, tells that it mirrors, and its hue."""
    mirrored = np.maximum(light - np.maximum(emitted, 0.0), 0.0)
    whole, left = luminance_of(np.maximum(light, 0.0)), luminance_of(mirrored)
    black = 1.0 - np.clip((luminance_of(matte) - 0.02) / 0.08, 0.0, 1.0)
    metal = black * black * (3.0 - 2.0 * black)
    metal = metal * np.where(whole > 0.0, np.minimum(left / np.where(whole > 0.0, whole, 1.0), 1.0), 1.0)
    color = np.where(left > 0.0, reflectance * mirrored / np.where(left > 0.0, left, 1.0), 0.0)
    return mix(matte, color, metal), metal


def material_of_edges(matte: Array, color: Array, metal: Array) -> tuple[Array, Array]:
    """The same where a renderer has filtered the edge of a metal: its diffuse color is that of the surface on the other
    side, made darker by as much as the metal covers.
    """
    found, share = color, metal
    least = np.full_like(metal, 0.1)
    for far in (1, 2):
        for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)):
            shining, sure = (shift_picture(data, x * far, y * far) for data in (color, metal))
            plain, other = (shift_picture(data, -x * far, -y * far) for data in (color, metal))
            size = np.maximum((plain * plain).sum(axis=-1, keepdims=True), 1e-20)
            part = (matte * plain).sum(axis=-1, keepdims=True) / size
            misfit = length(matte - part * plain) / np.sqrt(size)
            fits = (share < 0.9) & (sure >= 0.9) & (other <= 0.1) & (part < 1.0) & (misfit < least)
            least = np.where(fits, misfit, least)
            found, share = np.where(fits, matte + (1.0 - part) * shining, found), np.where(fits, 1.0 - part, share)
    return found, share


def material_from_colors(
    diffuse_color: Array,
    glossy_color: Array,
    beauty: Array,
    emission: Array,
    roughness: Array | float,
    metals: str,
    reflectance: float,
    roughen: float,
    polish: float,
) -> tuple[Array, Array]:
    """The color of surfaces, and how much of them is metal and how rough they are."""
    (matte, alpha), (shiny, _) = straight(diffuse_color), straight(glossy_color)
    if metals == "glossy color":
        albedo, metal = material_from_glossy(matte, shiny)
    else:
        light, _ = straight(beauty)
        matte, alpha = straight(join(diffuse_color[..., :3], np.clip(beauty[..., 3:], 0.0, 1.0)))
        emitted, _ = straight(join(emission[..., :3], beauty[..., 3:]))
        albedo, metal = material_of_edges(matte, *material_from_light(matte, light, emitted, reflectance))
    rough = np.clip(roughness + roughen - metal * polish, 0.0, 1.0)
    return premultiply_color(albedo, alpha), np.concatenate([metal, rough], axis=-1)


def rebuild_beauty(
    beauty: Array | None = None,
    diffuse_color: Array | float = 1.0,
    diffuse_direct: Array | None = None,
    diffuse_indirect: Array | None = None,
    glossy_color: Array | float = 1.0,
    glossy_direct: Array | None = None,
    glossy_indirect: Array | None = None,
    transmission_color: Array | float = 1.0,
    transmission_direct: Array | None = None,
    transmission_indirect: Array | None = None,
    volume_direct: Array | None = None,
    volume_indirect: Array | None = None,
    emission: Array | None = None,
    environment: Array | None = None,
    other: Array | None = None,
) -> tuple[Array, Array, Array]:
    """The sum of light passes, as Cycles has it; where it differs from the picture, and the largest difference."""
    lobes = (
        (diffuse_color, diffuse_direct, diffuse_indirect),
        (glossy_color, glossy_direct, glossy_indirect),
        (transmission_color, transmission_direct, transmission_indirect),
    )
    lights = [(1.0, light) for light in (volume_direct, volume_indirect, emission, environment, other)]
    lights += [(color, light) for color, *both in lobes for light in both]
    total, alpha = np.zeros((1, 1, 3)), np.zeros((1, 1, 1))
    for color, light in lights:
        if light is not None:
            factor = color[..., :3] if isinstance(color, np.ndarray) else color
            total, alpha = total + factor * light[..., :3], np.maximum(alpha, light[..., 3:])
    if beauty is None:
        return join(total, alpha), np.zeros((1, 1, 1)), np.zeros((1, 1, 1))
    difference = largest(np.abs(total - beauty[..., :3]))
    return join(total, beauty[..., 3:]), difference, difference.max(keepdims=True)


def unit_normals(normal: Array) -> Array:
    """Normals with length 1, which antialiasing may have shortened; 0 on the background."""
    size = length(normal)
    there = (size > 0.1) & (size < FAR)
    return np.where(there, normal / np.where(there, size, 1.0), 0.0)
