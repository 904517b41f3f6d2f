"""The built-in scenes, and the shapes of which they are made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

Array = np.ndarray
Color = tuple[float, float, float]

ROUGH = 0.6
"""Roughness of a material that names none: a broad highlight. glTF's own default is 1. Chosen by judgement."""

_TANGENT_STEP = 1e-6
"""Step of the differences that give tangents. The rounding of doubles, 2e-16, leaves ten digits of it, and what bends
within it is as small."""

_SEGMENTS = 96
"""Sides of round shapes: their outline is off by 5e-4 of the radius (1 - cos(pi / 96)), a pixel for 2000 pixels."""

# All other numbers in this file are the places, sizes and materials of the sample scenes, chosen by eye.


class MeshPart(Struct, frozen=True, eq=False):
    """One object: positions, unit normals [n, 3], triangles [m, 3], uvs [n, 2] and its material. z is up."""

    positions: Array
    normals: Array
    triangles: Array
    uvs: Array
    albedo: Color = (0.8, 0.8, 0.8)
    emission: Color = (0.0, 0.0, 0.0)
    metal: float = 0.0
    rough: float = 0.6
    is_moving: bool = False

    @property
    def material(self) -> tuple[float, ...]:
        """The properties of a material."""
        return (*self.albedo, *self.emission, self.metal, self.rough)

    def rotate(self, rotation: Array) -> MeshPart:
        """The same object, rotated."""
        return replace(self, positions=self.positions @ rotation.T, normals=self.normals @ rotation.T)

    def move(self, *place: float) -> MeshPart:
        """The same object, moved."""
        return replace(self, positions=self.positions + np.asarray(place))

    def with_material(
        self,
        albedo: Color,
        *,
        emission: Color = (0.0, 0.0, 0.0),
        metal: float = 0.0,
        rough: float = ROUGH,
        moving: bool = False,
    ) -> MeshPart:
        """The same shape with another material."""
        return replace(self, albedo=albedo, emission=emission, metal=metal, rough=rough, is_moving=moving)


def make_surface(points: Callable[[Array, Array], Array], across: int, down: int) -> MeshPart:
    """A smooth surface over the unit square, from a function of u and v in 0..1; normals come from its tangents."""
    v, u = (grid.ravel() for grid in np.mgrid[0 : 1 : (down + 1) * 1j, 0 : 1 : (across + 1) * 1j])
    places, step = points(u, v), _TANGENT_STEP
    normals = np.cross(points(u + step, v) - points(u - step, v), points(u, v + step) - points(u, v - step))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0.0)
    corner = (np.arange(down)[:, None] * (across + 1) + np.arange(across)).ravel()
    lower_triangles = [corner, corner + 1, corner + across + 2]
    upper_triangles = [corner, corner + across + 2, corner + across + 1]
    return MeshPart(
        places,
        normals,
        np.concatenate([np.stack(lower_triangles, 1), np.stack(upper_triangles, 1)]),
        np.stack([u, v], 1),
    )


def make_sphere(radius: float, segments: int = _SEGMENTS) -> MeshPart:
    """A ball around the origin. Its normals point outward, at the poles too."""

    def points(u: Array, v: Array) -> Array:
        turn, tilt = 2.0 * np.pi * u, np.pi * v
        return radius * np.stack([np.cos(turn) * np.sin(tilt), np.sin(turn) * np.sin(tilt), np.cos(tilt)], 1)

    ball = make_surface(points, segments, segments // 2)
    return replace(ball, normals=ball.positions / radius)


def make_torus(radius: float, thickness: float, segments: int = _SEGMENTS) -> MeshPart:
    """A ring around the y axis, so it stands upright."""

    def points(u: Array, v: Array) -> Array:
        turn, around = 2.0 * np.pi * u, 2.0 * np.pi * v
        away = radius + thickness * np.cos(around)
        return np.stack([away * np.cos(turn), thickness * np.sin(around), away * np.sin(turn)], 1)

    return make_surface(points, segments, segments // 3)


def make_quad(corner: Color, along: Color, up: Color, pieces: int = 1) -> MeshPart:
    """A flat rectangle from a corner along two edges. Its normal is their cross product."""
    return make_surface(lambda u, v: np.asarray(corner) + np.outer(u, along) + np.outer(v, up), pieces, pieces)


def make_box(width: float, depth: float, height: float) -> MeshPart:
    """A block that stands on z = 0, centered in x and y."""
    w, d, h = width / 2.0, depth / 2.0, height
    sides = [
        make_quad((-w, -d, 0.0), (width, 0.0, 0.0), (0.0, 0.0, h)),
        make_quad((w, d, 0.0), (-width, 0.0, 0.0), (0.0, 0.0, h)),
        make_quad((w, -d, 0.0), (0.0, depth, 0.0), (0.0, 0.0, h)),
        make_quad((-w, d, 0.0), (0.0, -depth, 0.0), (0.0, 0.0, h)),
        make_quad((-w, -d, h), (width, 0.0, 0.0), (0.0, depth, 0.0)),
        make_quad((-w, d, 0.0), (width, 0.0, 0.0), (0.0, -depth, 0.0)),
    ]
    starts = np.cumsum([0, *(len(side.positions) for side in sides[:-1])])
    return MeshPart(
        np.concatenate([side.positions for side in sides]),
        np.concatenate([side.normals for side in sides]),
        np.concatenate([side.triangles + start for side, start in zip(sides, starts, strict=True)]),
        np.concatenate([side.uvs for side in sides]),
    )


def _make_backdrop() -> MeshPart:
    """A floor that bends into a wall, as in a photographer's studio."""

    def points(u: Array, v: Array) -> Array:
        bend, floor, wall = 1.2, 9.0, 5.0
        arc = bend * np.pi / 2.0
        along = v * (floor + arc + wall)
        angle = np.clip((along - floor) / bend, 0.0, np.pi / 2.0)
        y = np.minimum(along, floor) + bend * np.sin(angle)
        z = bend * (1.0 - np.cos(angle)) + np.maximum(along - floor - arc, 0.0)
        return np.stack([16.0 * (u - 0.5), y - 6.0, z], 1)

    return make_surface(points, 1, 192)


def build_stage() -> list[MeshPart]:
    """A still life before a backdrop: metal, plastic, stone and light. The red ball moves."""
    ring = make_torus(0.75, 0.05)
    return [
        _make_backdrop().with_material((0.42, 0.4, 0.38), rough=0.45),
        make_sphere(0.62).move(-0.15, 0.1, 0.62).with_material((0.95, 0.72, 0.35), metal=1.0, rough=0.22),
        make_sphere(0.34).move(0.95, -0.75, 0.34).with_material((0.72, 0.04, 0.03), rough=0.3, moving=True),
        make_sphere(0.24).move(-1.15, -0.95, 0.24).with_material((0.12, 0.35, 0.5), rough=0.15),
        make_torus(0.42, 0.15).move(1.55, 0.55, 0.57).with_material((0.85, 0.85, 0.82), rough=0.35),
        make_box(0.62, 0.62, 0.62).move(-1.7, 0.25, 0.0).with_material((0.28, 0.24, 0.45), rough=0.7),
        make_box(0.4, 0.4, 0.4).move(-1.62, 0.2, 0.62).with_material((0.8, 0.55, 0.2), rough=0.7),
        make_box(0.5, 0.28, 1.5).move(2.6, 1.1, 0.0).with_material((0.6, 0.6, 0.58), rough=0.8),
        ring.move(-1.15, 1.7, 1.35).with_material((0.9, 0.9, 0.9), emission=(7.0, 9.0, 12.0)),
        ring.move(1.3, 1.9, 1.35).with_material((0.9, 0.9, 0.9), emission=(12.0, 3.0, 6.5)),
        make_sphere(0.12).move(0.35, -1.25, 0.12).with_material((0.9, 0.9, 0.9), emission=(9.0, 5.0, 1.5)),
    ]


def build_corner() -> list[MeshPart]:
    """Two walls and a floor at right angles, with a block and a ball: a simple scene for light and shadow."""
    return [
        make_quad((-4.0, -4.0, 0.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0)).with_material((0.7, 0.7, 0.7)),
        make_quad((-4.0, 2.0, 0.0), (8.0, 0.0, 0.0), (0.0, 0.0, 4.0)).with_material((0.7, 0.7, 0.7)),
        make_quad((-2.5, -4.0, 0.0), (0.0, 8.0, 0.0), (0.0, 0.0, 4.0)).with_material((0.6, 0.1, 0.06)),
        make_box(1.0, 1.0, 1.6).move(-1.2, 0.9, 0.0).with_material((0.7, 0.7, 0.7)),
        make_sphere(0.5).move(0.5, -0.1, 0.5).with_material((0.2, 0.45, 0.7), rough=0.3, moving=True),
    ]


def build_blocks() -> list[MeshPart]:
    """A town of many boxes of different heights, always the same."""
    random = np.random.default_rng(7)
    parts = [
        make_quad((-9.0, -9.0, 0.0), (18.0, 0.0, 0.0), (0.0, 18.0, 0.0)).with_material((0.3, 0.3, 0.32), rough=0.35)
    ]
    for x in range(-6, 7):
        for y in range(-6, 7):
            height, side = float(0.3 + random.gamma(1.6, 0.6)), float(random.uniform(0.55, 0.85))
            tone = float(random.uniform(0.35, 0.75))
            shade = (tone, tone * float(random.uniform(0.9, 1.0)), tone * float(random.uniform(0.8, 1.0)))
            parts.append(make_box(side, side, height).move(1.15 * x, 1.15 * y, 0.0).with_material(shade, rough=0.75))
    return parts


BUILT_IN: Mapping[str, Callable[[], list[MeshPart]]] = MappingProxyType(
    {"stage": build_stage, "corner": build_corner, "blocks": build_blocks}
)
