"""Light reflected by surfaces, in double precision by the published formulas: one light at a time, and all."""

from __future__ import annotations

import numpy as np
from geometry import CAMERA
from halation.nodes import Light, LightKind

Array = np.ndarray

POINT, SPOT, SUN, SPHERE = LightKind.POINT, LightKind.SPOT, LightKind.SUN, LightKind.SPHERE

FURNACE = [
    (alpha, mu, share)
    for mu, row in ((1.0, (0.9881, 0.9159, 0.6880, 0.3069)), (0.3, (0.9369, 0.8389, 0.7464, 0.5614)))
    for alpha, share in zip((0.1, 0.25, 0.5, 1.0), row, strict=True)
]
"""Roughness, cosine of the eye, and the share of white light that comes back."""


def unit(v: Array) -> Array:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def dot(a: Array, b: Array) -> Array:
    return np.sum(a * b, axis=-1, keepdims=True)


def sphere_cosine(cosine: Array, square: Array) -> Array:
    """The illuminance of a ball as Lagarde and de Rousiers print it, over that of its middle without the cosine."""
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 1e-30))
    x = np.sqrt(1.0 / square - 1.0)
    y = np.clip(-x * cosine / sine, -1.0, 1.0)
    root = sine * np.sqrt(1.0 - y**2)
    cut = (cosine * np.arccos(y) - x * root) * square + np.arctan(root / x)
    return np.where(cosine**2 > square, np.maximum(cosine, 0.0), np.maximum(cut, 0.0) / (np.pi * square))


def ggx(n: Array, v: Array, to: Array, alpha: Array) -> Array:
    """D V, without Fresnel."""
    h = unit(v + to)
    nh, nl, nv = dot(n, h), np.maximum(dot(n, to), 1e-12), np.maximum(dot(n, v), 1e-4)
    a2 = alpha**2
    facets = a2 / (np.pi * (nh**2 * (a2 - 1.0) + 1.0) ** 2)
    return facets * 0.5 / (nl * np.sqrt(nv**2 * (1.0 - a2) + a2) + nv * np.sqrt(nl**2 * (1.0 - a2) + a2))


def reflected(
    light: Light, model: str, place: Array, n: Array, v: Array, f0: Array, alpha: Array
) -> tuple[Array, Array]:
    """What falls on the surface and what it mirrors, by one light."""
    away = np.array(light.place, float) - place
    distance = np.linalg.norm(away, axis=-1, keepdims=True)
    aim = unit(np.array(light.direction, float))
    if light.kind is SUN:
        to, power, ball = -aim + 0.0 * place, np.full_like(distance, light.intensity), 0.0
    else:
        to, power, ball = away / distance, light.intensity / distance**2, 0.0
        if light.reach > 0.0:
            power = power * np.clip(1.0 - (distance / light.reach) ** 4, 0.0, 1.0) ** 2
    if light.kind is SPOT:
        inner, outer = np.cos(np.radians((min(light.inner, light.outer - 0.5), light.outer)))
        power = power * np.clip((dot(-to, aim) - outer) / (inner - outer), 0.0, 1.0) ** 2
    power = power * np.array(light.color)
    nl = dot(n, to)
    mirror = 2.0 * dot(n, v) * n - v
    if light.kind is SPHERE:
        ball = (light.size / distance) ** 2
        fallen = power * sphere_cosine(nl, np.minimum(ball, 0.999999))
        off = dot(to, mirror) * mirror - to
        to = unit(to + off * np.minimum(1.0, np.sqrt(ball) / np.linalg.norm(off, axis=-1, keepdims=True)))
        nl = dot(n, to)
    else:
        fallen = power * np.maximum(nl, 0.0)
    above, lit = nl > 0.0, np.maximum(nl, 1e-12)
    vh = dot(v, unit(v + to))
    if model == "phong":
        exponent = 0.5 / alpha**2 + 0.5
        lobe = (exponent + 2.0) / (2.0 * np.pi) * np.maximum(dot(mirror, to), 0.0) ** exponent
        mirrored = f0 * lobe * alpha**2 / (alpha**2 + ball * lit / 4.0)
    else:
        mirrored = (f0 + (1.0 - f0) * (1.0 - vh) ** 5) * ggx(n, v, to, alpha)
        mirrored = mirrored * alpha**2 / (alpha**2 + ball / 4.0 / np.maximum(vh, 1e-4))
    return fallen, np.where(above, power * mirrored * lit, 0.0)


def lit(inputs: dict[str, Array], lights: tuple[Light, ...], model: str = "ggx") -> dict[str, Array]:
    """Diffuse and specular light, premultiplied as the albedo is."""
    given = {name: array.astype(np.float64) for name, array in inputs.items()}
    there = given["depth"] < 1e9
    alpha = given["albedo"][there][:, 3:]
    color, place, n = given["albedo"][there][:, :3] / alpha, given["position"][there], unit(given["normal"][there])
    metal, roughness = given["material"][there][:, :1], given["material"][there][:, 1:]
    v = unit(np.array(CAMERA.eye) - place)
    f0 = (1.0 - metal) * 0.04 + metal * color
    fallen, mirrored = np.zeros_like(color), np.zeros_like(color)
    for light in lights:
        more = reflected(light, model, place, n, v, f0, roughness**2)
        fallen, mirrored = fallen + more[0], mirrored + more[1]
    found = {"diffuse": color * (1.0 - metal) / np.pi * fallen, "specular_light": mirrored}
    pictures = {name: np.zeros((*there.shape, 3)) for name in found}
    for name, values in found.items():
        pictures[name][there] = values * alpha
    return pictures
