"""Scenes that are built in, and what their meshes are made of."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

Array = np.ndarray
Color = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Piece:
    """One object: places, unit normals [n, 3], triangles [m, 3], uvs [n, 2] and its material. z is up."""

    places: Array
    normals: Array
    triangles: Array
    uvs: Array
    albedo: Color = (0.8, 0.8, 0.8)
    emission: Color = (0.0, 0.0, 0.0)
    metal: float = 0.0
    rough: float = 0.6
    moving: bool = False

    @property
    def material(self) -> tuple[float, ...]:
        """What is the same for objects of one material."""
        return (*self.albedo, *self.emission, self.metal, self.rough)

    def turned(self, rotation: Array) -> Piece:
        """The same object in a turned world."""
        return replace(self, places=self.places @ rotation.T, normals=self.normals @ rotation.T)

    def at(self, *place: float) -> Piece:
        """The same object somewhere else."""
        return replace(self, places=self.places + np.asarray(place))

    def made_of(
        self,
        albedo: Color,
        *,
        emission: Color = (0.0, 0.0, 0.0),
        metal: float = 0.0,
        rough: float = 0.6,
        moving: bool = False,
    ) -> Piece:
        """The same shape of another material."""
        return replace(self, albedo=albedo, emission=emission, metal=metal, rough=rough, moving=moving)


def surface(points: Callable[[Array, Array], Array], across: int, down: int) -> Piece:
    """A smooth surface over the unit square, by the function of its u and v in 0..1; normals by its tangents."""
    v, u = (grid.ravel() for grid in np.mgrid[0 : 1 : (down + 1) * 1j, 0 : 1 : (across + 1) * 1j])
    places, step = points(u, v), 1e-6
    normals = np.cross(points(u + step, v) - points(u - step, v), points(u, v + step) - points(u, v - step))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0.0)
    corner = (np.arange(down)[:, None] * (across + 1) + np.arange(across)).ravel()
    one, two = [corner, corner + 1, corner + across + 2], [corner, corner + across + 2, corner + across + 1]
    return Piece(places, normals, np.concatenate([np.stack(one, 1), np.stack(two, 1)]), np.stack([u, v], 1))


def sphere(radius: float, segments: int = 96) -> Piece:
    """A ball around the origin. Its normals point out, at the poles too."""

    def points(u: Array, v: Array) -> Array:
        turn, tilt = 2.0 * np.pi * u, np.pi * v
        return radius * np.stack([np.cos(turn) * np.sin(tilt), np.sin(turn) * np.sin(tilt), np.cos(tilt)], 1)

    made = surface(points, segments, segments // 2)
    return replace(made, normals=made.places / radius)


def torus(radius: float, thickness: float, segments: int = 96) -> Piece:
    """A ring around the y axis: it stands upright."""

    def points(u: Array, v: Array) -> Array:
        turn, around = 2.0 * np.pi * u, 2.0 * np.pi * v
        away = radius + thickness * np.cos(around)
        return np.stack([away * np.cos(turn), thickness * np.sin(around), away * np.sin(turn)], 1)

    return surface(points, segments, segments // 3)


def quad(corner: Color, along: Color, up: Color, pieces: int = 1) -> Piece:
    """A flat rectangle from a corner along two edges. Its normal is their cross product."""
    return surface(lambda u, v: np.asarray(corner) + np.outer(u, along) + np.outer(v, up), pieces, pieces)


def box(width: float, depth: float, height: float) -> Piece:
    """A block that stands on z = 0, in the middle of x and y."""
    w, d, h = width / 2.0, depth / 2.0, height
    sides = [
        quad((-w, -d, 0.0), (width, 0.0, 0.0), (0.0, 0.0, h)),
        quad((w, d, 0.0), (-width, 0.0, 0.0), (0.0, 0.0, h)),
        quad((w, -d, 0.0), (0.0, depth, 0.0), (0.0, 0.0, h)),
        quad((-w, d, 0.0), (0.0, -depth, 0.0), (0.0, 0.0, h)),
        quad((-w, -d, h), (width, 0.0, 0.0), (0.0, depth, 0.0)),
        quad((-w, d, 0.0), (width, 0.0, 0.0), (0.0, -depth, 0.0)),
    ]
    starts = np.cumsum([0, *(len(side.places) for side in sides[:-1])])
    return Piece(
        np.concatenate([side.places for side in sides]),
        np.concatenate([side.normals for side in sides]),
        np.concatenate([side.triangles + start for side, start in zip(sides, starts, strict=True)]),
        np.concatenate([side.uvs for side in sides]),
    )


def _backdrop() -> Piece:
    """Floor and wall in one, round where they meet, as in a photographer's studio."""

    def points(u: Array, v: Array) -> Array:
        bend, floor, wall = 1.2, 9.0, 5.0
        arc = bend * np.pi / 2.0
        along = v * (floor + arc + wall)
        angle = np.clip((along - floor) / bend, 0.0, np.pi / 2.0)
        y = np.minimum(along, floor) + bend * np.sin(angle)
        z = bend * (1.0 - np.cos(angle)) + np.maximum(along - floor - arc, 0.0)
        return np.stack([16.0 * (u - 0.5), y - 6.0, z], 1)

    return surface(points, 1, 192)


def stage() -> list[Piece]:
    """A still life before a backdrop: metal, plastic, stone and light. The red ball moves."""
    ring = torus(0.75, 0.05)
    return [
        _backdrop().made_of((0.42, 0.4, 0.38), rough=0.45),
        sphere(0.62).at(-0.15, 0.1, 0.62).made_of((0.95, 0.72, 0.35), metal=1.0, rough=0.22),
        sphere(0.34).at(0.95, -0.75, 0.34).made_of((0.72, 0.04, 0.03), rough=0.3, moving=True),
        sphere(0.24).at(-1.15, -0.95, 0.24).made_of((0.12, 0.35, 0.5), rough=0.15),
        torus(0.42, 0.15).at(1.55, 0.55, 0.57).made_of((0.85, 0.85, 0.82), rough=0.35),
        box(0.62, 0.62, 0.62).at(-1.7, 0.25, 0.0).made_of((0.28, 0.24, 0.45), rough=0.7),
        box(0.4, 0.4, 0.4).at(-1.62, 0.2, 0.62).made_of((0.8, 0.55, 0.2), rough=0.7),
        box(0.5, 0.28, 1.5).at(2.6, 1.1, 0.0).made_of((0.6, 0.6, 0.58), rough=0.8),
        ring.at(-1.15, 1.7, 1.35).made_of((0.9, 0.9, 0.9), emission=(7.0, 9.0, 12.0)),
        ring.at(1.3, 1.9, 1.35).made_of((0.9, 0.9, 0.9), emission=(12.0, 3.0, 6.5)),
        sphere(0.12).at(0.35, -1.25, 0.12).made_of((0.9, 0.9, 0.9), emission=(9.0, 5.0, 1.5)),
    ]


def corner() -> list[Piece]:
    """Two walls and a floor at right angles, with a block and a ball: light and shade in their plainest form."""
    return [
        quad((-4.0, -4.0, 0.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0)).made_of((0.7, 0.7, 0.7)),
        quad((-4.0, 2.0, 0.0), (8.0, 0.0, 0.0), (0.0, 0.0, 4.0)).made_of((0.7, 0.7, 0.7)),
        quad((-2.5, -4.0, 0.0), (0.0, 8.0, 0.0), (0.0, 0.0, 4.0)).made_of((0.6, 0.1, 0.06)),
        box(1.0, 1.0, 1.6).at(-1.2, 0.9, 0.0).made_of((0.7, 0.7, 0.7)),
        sphere(0.5).at(0.5, -0.1, 0.5).made_of((0.2, 0.45, 0.7), rough=0.3, moving=True),
    ]


def blocks() -> list[Piece]:
    """A town of many boxes of different heights, always the same."""
    random = np.random.default_rng(7)
    found = [quad((-9.0, -9.0, 0.0), (18.0, 0.0, 0.0), (0.0, 18.0, 0.0)).made_of((0.3, 0.3, 0.32), rough=0.35)]
    for x in range(-6, 7):
        for y in range(-6, 7):
            height, side = float(0.3 + random.gamma(1.6, 0.6)), float(random.uniform(0.55, 0.85))
            tone = float(random.uniform(0.35, 0.75))
            shade = (tone, tone * float(random.uniform(0.9, 1.0)), tone * float(random.uniform(0.8, 1.0)))
            found.append(box(side, side, height).at(1.15 * x, 1.15 * y, 0.0).made_of(shade, rough=0.75))
    return found


BUILT_IN: Mapping[str, Callable[[], list[Piece]]] = MappingProxyType(
    {"stage": stage, "corner": corner, "blocks": blocks}
)
