"""Lamps that light a render again, from its albedo, normals and places."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from .cameras import camera_back, is_place, position_from_depth, tangent_normals
from .coverage import parts_of_pixels, pixels_of
from .pixels import Array, dot, join, length, mix, premultiply_color, rgb, straight
from .render_layers import FAR, nearness


def unit_vectors(vector: Array) -> Array:
    """Vectors with length 1."""
    return vector / np.maximum(length(vector), 1e-30)


def fresnel(f0: Array, cosine: Array) -> Array:
    """The part of light that is reflected (Schlick 1994)."""
    return f0 + (1.0 - f0) * np.clip(1.0 - cosine, 0.0, 1.0) ** 5


def ggx(normal: Array, half: Array, nv: Array, nl: Array, alpha: Array) -> Array:
    """What microfacets reflect, without Fresnel's part (Walter et al. 2007, Heitz 2014)."""
    off = np.cross(normal, half)
    size = (alpha * dot(normal, half)) ** 2 + dot(off, off)
    masked = [np.sqrt(x * x * (1.0 - alpha * alpha) + alpha * alpha) for x in (nv, nl)]
    size = np.maximum(size, 1e-15)
    return alpha * alpha / (np.pi * size * size) * 0.5 / np.maximum(nl * masked[0] + nv * masked[1], 1e-30)


def ggx_of_sky(f0: Array, nv: Array, alpha: Array) -> Array:
    """What microfacets reflect of an even sky: the fit of MaterialX."""
    table = np.array([
        [0.1003, 0.9345, 1.0, 1.0],
        [-0.6303, -2.323, -1.765, 0.2281],
        [9.748, 2.229, 8.263, 15.94],
        [-2.038, -3.748, 11.53, -55.83],
        [29.34, 1.424, 28.96, 13.08],
        [-8.245, -0.7684, -7.507, 41.26],
        [-26.44, 1.436, -36.11, 54.9],
        [19.99, 0.2913, 15.86, 300.2],
        [-5.448, 0.6286, 33.37, -285.1],
    ])  # fmt: skip
    x, y = nv, alpha
    powers = [np.ones_like(x), x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y]
    parts = np.concatenate(powers, axis=-1) @ table
    shares = np.clip(parts[..., :2] / parts[..., 2:], 0.0, 1.0)
    return f0 * shares[..., :1] + shares[..., 1:]


def phong_lobe(cosine: Array, alpha: Array) -> Array:
    """Phong's lobe around the mirrored ray, scaled to keep energy (Lafortune and Willems 1994)."""
    power = 0.5 / alpha**2 + 0.5
    return (power + 2.0) / (2.0 * np.pi) * np.maximum(cosine, 1e-9) ** power


def cosine_of_ball(cosine: Array, square: Array) -> Array:
    """The light of a ball against that of a point straight above: the cosine, but where the horizon cuts it.

    `square` is the squared sine of half its angle (Snyder 1996, as in Lagarde and de Rousiers 2014).
    """
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 1e-30))
    x = np.sqrt(1.0 / np.maximum(square, 1e-30) - 1.0)
    y = np.clip(-x * cosine / sine, -1.0, 1.0)
    root = sine * np.sqrt(1.0 - y**2)
    cut = (cosine * np.arccos(y) - x * root) * square + np.arctan(root / np.maximum(x, 1e-30))
    cut = np.maximum(cut, 0.0) / (np.pi * np.maximum(square, 1e-30))
    return np.where(cosine**2 >= square, np.maximum(cosine, 0.0), cut)


def light_of_lamp(
    lamp: tuple[Any, ...],
    model: str,
    place: Array,
    normal: Array,
    view: Array,
    f0: Array,
    alpha: Array,
) -> tuple[Array, Array]:
    """What falls on the surface from one lamp, and what it mirrors to the camera."""
    kind, middle, aim, color, reach, size, inner, outer = lamp
    way = -np.array(aim) + 0.0 * place if kind == "sun" else np.array(middle) - place
    square = np.maximum(dot(way, way), max(size * size, 1e-8))
    to = way / np.sqrt(square)
    power = np.array(color) / square
    if reach > 0.0 and kind != "sun":
        power = power * np.maximum(1.0 - (square / reach**2) ** 2, 0.0) ** 2
    if kind == "spot":
        edge = max(np.cos(min(inner, outer)) - np.cos(outer), 1e-4)
        power = power * np.clip((dot(-to, np.array(aim)) - np.cos(outer)) / edge, 0.0, 1.0) ** 2
    ball = size * size / square
    fallen = power * cosine_of_ball(dot(normal, to), np.minimum(ball, 0.999999))
    mirror = 2.0 * dot(normal, view) * normal - view
    if size > 0.0:  # the point of the ball nearest to the mirrored ray (Karis 2013)
        off = dot(to, mirror) * mirror - to
        to = unit_vectors(to + off * np.minimum(1.0, np.sqrt(ball) / np.maximum(length(off), 1e-9)))
    nl = dot(normal, to)
    above = np.maximum(nl, 1e-12)
    if model == "phong":
        lobe = f0 * phong_lobe(dot(mirror, to), alpha) * alpha**2 / (alpha**2 + 0.25 * ball * above)
    else:
        half = unit_vectors(view + to)
        vh = np.maximum(dot(view, half), 1e-4)
        nv = np.clip(dot(normal, view), 1e-4, 1.0)
        lobe = fresnel(f0, vh) * ggx(normal, half, nv, above, alpha) * alpha**2 / (alpha**2 + 0.25 * ball / vh)
    return fallen, np.where(nl > 0.0, power * lobe * above, 0.0)


def light_of_lamps(
    lamps: tuple[tuple[Any, ...], ...], model: str, place: Array, normal: Array, view: Array, f0: Array, alpha: Array
) -> tuple[Array, Array]:
    """What falls on the surface from all lamps, and what it mirrors to the camera."""
    fallen = mirrored = np.zeros_like(f0)
    for lamp in lamps:
        more = light_of_lamp(lamp, model, place, normal, view, f0, alpha)
        fallen, mirrored = fallen + more[0], mirrored + more[1]
    return fallen, mirrored


def places_of_surfaces(depth: Array, position: Array | None, camera: Array | None) -> tuple[Array, Array]:
    """The place of each pixel, and its nearness: 1 / depth, or without a depth 1 / distance; 0 on the background."""
    matrix = np.eye(3, 4) if camera is None else camera
    eye = np.zeros(3) if camera is None else camera_back(camera)[:, 3]
    if position is None:
        place = position_from_depth(depth, matrix) if camera is not None else np.zeros((*depth.shape[:2], 3))
        return place, nearness(depth)
    there = is_place(position) & (np.abs(position) < FAR).all(axis=-1, keepdims=True)
    place = np.where(there, position, 0.0)
    near = np.where(nearness(depth) > 0.0, nearness(depth), 1.0 / np.maximum(length(place - eye), 1e-9))
    return place, np.where(there, near, 0.0)


def deferred_lighting(
    albedo: Array,
    model: Literal["ggx", "phong"],
    roughness: float,
    metal: float,
    specular: float,
    lamps: tuple[tuple[Any, ...], ...],
    intensity: float,
    ambient: tuple[float, ...],
    ambient_intensity: float,
    width: int,
    height: int,
    normal: Array | None = None,
    depth: Array | None = None,
    position: Array | None = None,
    camera: Array | None = None,
    material: Array | None = None,
    emission: Array | None = None,
    occlusion: Array | None = None,
) -> tuple[Array, Array, Array]:
    """Light a render again: all light, the diffuse and the specular one.

    A lamp is its kind, place, aim, color times intensity, reach, radius, and the angles of its inner and outer cone.
    """
    blank = np.zeros((height, width, 1))
    color, depth = albedo + 0.0 * blank, blank if depth is None else depth
    place, near = places_of_surfaces(depth, position, camera)
    if normal is None:
        normal = 0.0 * place if camera is None else tangent_normals(depth, camera)
    given = np.concatenate([blank + metal, blank + roughness], axis=-1) if material is None else material
    open_sky = blank + 1.0 if occlusion is None else np.clip(occlusion, 0.0, 1.0)
    matte, shiny = np.zeros((height, width, 3)), np.zeros((height, width, 3))
    for at, part, there, facing, turned in parts_of_pixels(color, normal, near, place, camera):
        straight_color, alpha = straight(part)
        metallic, rough = np.moveaxis(np.clip(pixels_of(given, at), 0.0, 1.0)[..., None], -2, 0)
        view = facing if camera is None else unit_vectors(camera_back(camera)[:, 3] - there)
        f0, alphas = mix(np.full(3, 0.08 * specular), straight_color, metallic), np.maximum(rough * rough, 0.0016)
        sky = ambient_intensity * ambient[3] * rgb(ambient) * pixels_of(open_sky, at)
        fallen, mirrored = light_of_lamps(lamps, model, there, facing, view, f0, alphas)
        mirrored = intensity * mirrored + sky * ggx_of_sky(f0, np.clip(dot(facing, view), 1e-4, 1.0), alphas)
        scattered = straight_color * (1.0 - metallic) * (sky + intensity * turned * fallen / np.pi)
        lit = (pixels_of(near, at) > 0.0) & (length(facing) > 0.0) & (part != 0.0).any(axis=-1, keepdims=True)
        matte = matte + np.where(lit, premultiply_color(scattered, alpha)[..., :3], 0.0)
        shiny = shiny + np.where(lit, premultiply_color(mirrored, alpha)[..., :3], 0.0)
    glow = np.zeros(4) if emission is None else emission
    whole = matte + shiny + glow[..., :3]
    return join(whole, color[..., 3:]), join(matte, color[..., 3:]), join(shiny, color[..., 3:])
