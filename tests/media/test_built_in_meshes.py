"""The scenes that are always there: solids against closed forms, and what stands in each of them."""

from __future__ import annotations

import numpy as np
import pytest
from halation.media.meshes.built_in import (
    MeshPart,
    build_blocks,
    build_corner,
    build_stage,
    make_box,
    make_quad,
    make_sphere,
    make_torus,
)


def find_crosses(part: MeshPart) -> np.ndarray:
    """The cross product of two edges of each triangle: twice its area, along its normal."""
    a, b, c = (part.positions[part.triangles[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def measure_area(part: MeshPart) -> float:
    return float(0.5 * np.linalg.norm(find_crosses(part), axis=1).sum())


def measure_volume(part: MeshPart) -> float:
    """By Gauss, of a closed surface."""
    return abs(float((find_crosses(part) * part.positions[part.triangles[:, 0]]).sum() / 6.0))


def check_surface(part: MeshPart) -> None:
    """Normals have length 1 and stand upright on triangles that are not far from flat; places are in the texture."""
    np.testing.assert_allclose(np.linalg.norm(part.normals, axis=1), 1.0, atol=1e-6)
    crosses = find_crosses(part)
    size = np.linalg.norm(crosses, axis=1)
    seen = size > 1e-9
    means = part.normals[part.triangles].mean(axis=1)
    assert (np.abs((crosses * means).sum(1))[seen] > 0.9 * size[seen]).all()
    assert part.uvs.min() == 0.0 and part.uvs.max() == 1.0 and len(part.uvs) == len(part.positions)


def test_a_box_is_the_box_of_its_three_lengths() -> None:
    """Its volume, its area, its place, and each normal away from the middle along one axis."""
    box = make_box(2.0, 3.0, 5.0)
    check_surface(box)
    assert measure_volume(box) == pytest.approx(30.0) and measure_area(box) == pytest.approx(2 * (6 + 10 + 15))
    assert box.positions.min(0).tolist() == [-1.0, -1.5, 0.0] and box.positions.max(0).tolist() == [1.0, 1.5, 5.0]
    away = (box.positions - (0.0, 0.0, 2.5)) / (1.0, 1.5, 2.5)
    np.testing.assert_allclose((away * box.normals).sum(1), 1.0, atol=1e-6)
    sides = {tuple(normal) for normal in np.round(box.normals).astype(int).tolist()}
    assert len(box.positions) == 24 and len(sides) == 6 and len(box.triangles) == 12


@pytest.mark.parametrize("radius", [0.5, 2.0])
def test_a_ball_is_round(radius: float) -> None:
    ball = make_sphere(radius)
    check_surface(ball)
    np.testing.assert_allclose(np.linalg.norm(ball.positions, axis=1), radius)
    np.testing.assert_allclose(ball.positions, radius * ball.normals, atol=1e-9)
    assert measure_volume(ball) == pytest.approx(4.0 / 3.0 * np.pi * radius**3, rel=5e-3)
    assert measure_area(ball) == pytest.approx(4.0 * np.pi * radius**2, rel=5e-3)


def test_a_ring_is_that_of_pappus() -> None:
    """Its volume and area are those of its circle times the way of the circle's middle."""
    ring = make_torus(0.75, 0.2)
    check_surface(ring)
    assert measure_volume(ring) == pytest.approx(2.0 * np.pi * 0.75 * np.pi * 0.2**2, rel=1e-2)
    assert measure_area(ring) == pytest.approx(2.0 * np.pi * 0.75 * 2.0 * np.pi * 0.2, rel=1e-2)
    x, y, z = ring.positions.T
    np.testing.assert_allclose((np.hypot(x, z) - 0.75) ** 2 + y**2, 0.2**2, atol=1e-12)


@pytest.mark.parametrize("pieces", [1, 4])
def test_a_quad_has_the_area_and_the_normal_of_its_edges(pieces: int) -> None:
    quad = make_quad((1.0, 2.0, 3.0), (2.0, 0.0, 0.0), (0.5, 3.0, 0.0), pieces)
    check_surface(quad)
    assert measure_area(quad) == pytest.approx(6.0) and len(quad.triangles) == 2 * pieces**2
    np.testing.assert_allclose(quad.normals, np.tile((0.0, 0.0, 1.0), (len(quad.normals), 1)), atol=1e-9)
    np.testing.assert_allclose(quad.positions, (1, 2, 3) + quad.uvs @ [(2.0, 0.0, 0.0), (0.5, 3.0, 0.0)])


def test_turned_and_moved() -> None:
    """A quarter turn around z takes x to y; a part that is moved keeps its normals."""
    turn = np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])
    box = make_box(2.0, 4.0, 1.0)
    turned = box.rotate(turn).move(1.0, 2.0, 3.0)
    x, y, z = box.positions.T
    np.testing.assert_allclose(turned.positions, np.stack([1.0 - y, 2.0 + x, 3.0 + z], 1))
    np.testing.assert_allclose(turned.normals[:, 1], box.normals[:, 0])


def test_the_corner_is_the_one_that_its_words_describe() -> None:
    floor, back, side, block, ball = build_corner()
    assert [measure_area(part) for part in (floor, back, side)] == pytest.approx([64.0, 32.0, 32.0])
    normals = np.stack([part.normals[0] for part in (floor, back, side)])
    np.testing.assert_allclose(np.abs(normals @ normals.T), np.eye(3), atol=1e-9)  # at right angles
    assert measure_volume(block) == pytest.approx(1.6) and block.positions[:, 2].min() == 0.0
    assert ball.positions[:, 2].min() == pytest.approx(0.0, abs=1e-9) and ball.is_moving and not block.is_moving


@pytest.mark.parametrize("part", build_stage()[1:8])
def test_what_is_on_the_stage_stands_on_something(part: MeshPart) -> None:
    """On the floor at 0, or the small box on the large one."""
    check_surface(part)
    assert part.positions[:, 2].min() == pytest.approx(0.0, abs=1e-9) or part.positions[:, 2].min() == 0.62


def test_the_backdrop_bends_once_and_has_the_length_of_its_parts() -> None:
    """16 wide: 9 of floor, a quarter of a circle of 1.2, and 5 of wall, joined without an edge."""
    backdrop = build_stage()[0]
    check_surface(backdrop)
    assert measure_area(backdrop) == pytest.approx(16.0 * (9.0 + 1.2 * np.pi / 2.0 + 5.0), rel=1e-3)
    assert backdrop.positions.max(0) == pytest.approx([8.0, 9.0 + 1.2 - 6.0, 1.2 + 5.0])
    _, y, z = np.unique(backdrop.positions.round(9), axis=0).T
    bent = (z > 1e-6) & (z < 1.2 - 1e-6)
    np.testing.assert_allclose(np.hypot(y[bent] - 3.0, z[bent] - 1.2), 1.2)


def test_the_town_is_always_the_same() -> None:
    """Its 169 houses stand apart on a floor, with the sizes and colors that the seed gives."""
    floor, *houses = build_blocks()
    assert len(houses) == 13 * 13 and measure_area(floor) == pytest.approx(18.0**2)
    middles = np.array([0.5 * (house.positions.min(0) + house.positions.max(0)) for house in houses])
    sizes = np.array([house.positions.max(0) - house.positions.min(0) for house in houses])
    np.testing.assert_allclose(middles[:, :2], [(1.15 * x, 1.15 * y) for x in range(-6, 7) for y in range(-6, 7)])
    np.testing.assert_allclose(sizes[:, 0], sizes[:, 1])
    assert sizes[:, 0].max() <= 0.85 and sizes[:, 0].min() >= 0.55 and sizes[:, 2].min() >= 0.3
    random = np.random.default_rng(7)
    for size, house in zip(sizes, houses, strict=True):
        height, side = 0.3 + random.gamma(1.6, 0.6), random.uniform(0.55, 0.85)
        red, green, blue = random.uniform(0.35, 0.75), random.uniform(0.9, 1.0), random.uniform(0.8, 1.0)
        assert (size[2], size[0]) == pytest.approx((height, side))
        assert house.albedo == pytest.approx((red, red * green, red * blue))
