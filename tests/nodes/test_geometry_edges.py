"""Geometry edges: nothing on planes, closed forms at steps and folds, ids exactly, widths by scipy's distances."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import CAMERA, rays, sample_layer
from halation.nodes.geometry.geometry_edges import GeometryEdges
from scipy.ndimage import binary_erosion, distance_transform_edt

FAR = 1e10


def plane(normal, offset: float, width: int = 40, height: int = 30) -> np.ndarray:
    """Planar depth of the plane through `forward * offset`, 0 where the rays miss it."""
    ray = rays(CAMERA, width, height)
    normal = np.array(normal) / np.linalg.norm(normal)
    depth = (np.array(CAMERA.forward) @ normal) * offset / (ray @ normal)
    return np.where(depth > 0.0, depth, FAR)


@pytest.mark.parametrize("tilt", [0.0, 30.0, 60.0, 68.0])
@pytest.mark.parametrize("towards", ["right", "down"])
def test_a_plane_has_no_gaps(run, tilt, towards):
    """However steep it lies, and at the border of the picture too."""
    way, angle = np.array(getattr(CAMERA, towards)), np.radians(tilt)
    depth = plane(np.array(CAMERA.forward) * np.cos(angle) + way * np.sin(angle), 9.0)
    assert (depth < 1e3).all()
    assert run(GeometryEdges(), {"depth": depth}, output="gap").max() < 1e-5


def test_planes_of_a_render_have_no_gaps(run):
    """The floor of the sample, away from what stands on it."""
    floor = binary_erosion(sample_layer("Object Index")[..., 0] == 1.0, iterations=2)
    gap = run(GeometryEdges(), {"depth": sample_layer("Depth")}, output="gap")[..., 0]
    assert floor.sum() > 10000 and gap[floor].max() < 1e-5


@pytest.mark.parametrize(("near", "far"), [(2.0, 2.5), (1.0, 100.0), (3.0, FAR), (3.0, np.inf)])
def test_between_two_surfaces_it_reads_how_much_nearer_one_is(run, near, far):
    depth = np.full((9, 14), far)
    depth[:, :6] = near
    for given, crossed in ((depth, (slice(None), slice(5, 7))), (depth.T, (slice(5, 7), slice(None)))):
        gap = run(GeometryEdges(), {"depth": given}, output="gap")[..., 0]
        np.testing.assert_allclose(gap[crossed], 1.0 - near / far if far < 1e9 else 1.0, rtol=1e-5)
        gap[crossed] = 0.0
        assert gap.max() == 0.0


def test_silhouettes_of_a_render_are_found(run):
    """Every border between objects whose depth differs by more than 30 percent, and nothing within planes."""
    depth, ids = (sample_layer(name)[..., 0] for name in ("Depth", "Object Index"))
    edges = run(GeometryEdges(), {"depth": depth})[..., 0]
    apart = np.minimum(depth[:, 1:], depth[:, :-1]) < 0.7 * np.maximum(depth[:, 1:], depth[:, :-1])
    outline = (apart & (ids[:, 1:] != ids[:, :-1]))[:, 1:-1]
    found = np.maximum(edges[:, 1:], edges[:, :-1])[:, 1:-1]
    assert outline.sum() > 500 and found[outline].min() == 1.0


@pytest.mark.parametrize("angle", [0.01, 1.0, 20.0, 90.0, 170.0])
@pytest.mark.parametrize("shortened", [1.0, 0.25])
def test_a_fold_reads_its_angle(run, angle, shortened):
    normal = np.zeros((7, 8, 3))
    turned = np.radians(37.0), np.radians(37.0 + angle)
    normal[:, :4] = np.cos(turned[0]), 0.0, np.sin(turned[0])
    normal[:, 4:] = np.cos(turned[1]) * shortened, 0.0, np.sin(turned[1]) * shortened
    crease = run(GeometryEdges(), {"normal": normal}, output="crease")[..., 0]
    np.testing.assert_allclose(crease[:, 3:5], angle, rtol=1e-5, atol=2e-5)
    np.testing.assert_allclose(crease[:, [0, 1, 2, 5, 6, 7]], 0.0, atol=1e-5)
    lines = run(GeometryEdges(crease_threshold=15.0, softness=0.0), {"normal": normal})[..., 0]
    np.testing.assert_array_equal(lines[:, 3:5], float(angle > 15.0))


def test_the_background_is_a_fold(run):
    normal = np.zeros((5, 6, 3))
    normal[:, :3] = 0.0, -0.6, 0.8
    normal[:, 3:] = 0.02, 0.05, 0.01
    crease = run(GeometryEdges(), {"normal": normal}, output="crease")[..., 0]
    assert (crease[:, 2:4] == 180.0).all() and (crease[:, [0, 1, 4, 5]] == 0.0).all()


def test_ids_are_exact(run):
    """Neighbors of a random map of large numbers that differ by one, and of tiny ones."""
    ids = np.random.default_rng(2).integers(16777210, 16777213, (19, 23)).astype(np.float32)
    for given in (ids, (ids - 16777200) * np.float32(1e-30)):
        padded = np.pad(given, 1, mode="edge")
        beside = [padded[1:-1, :-2], padded[1:-1, 2:], padded[:-2, 1:-1], padded[2:, 1:-1]]
        expected = np.any([other != given for other in beside], axis=0)
        found = run(GeometryEdges(), {"ids": given}, output="border")[..., 0]
        np.testing.assert_array_equal(found, expected)
        np.testing.assert_array_equal(run(GeometryEdges(), {"ids": given})[..., 0], expected)


def test_the_strongest_line_counts(run):
    ids, depth = np.zeros((9, 9)), np.full((9, 9), 10.0)
    ids[:, 5:], depth[:, 5:] = 1.0, 9.5
    node = GeometryEdges(depth_threshold=0.04, softness=0.5, depth_amount=0.8, id_amount=0.3)
    inputs = {"depth": depth, "ids": ids}
    np.testing.assert_allclose(run(node, inputs)[:, 4:6, 0], 0.8 * (0.05 - 0.04) / 0.02, rtol=1e-4)
    np.testing.assert_allclose(run(node.with_values(id_amount=0.7), inputs)[:, 4:6, 0], 0.7, rtol=1e-6)
    assert (run(GeometryEdges(depth_amount=0.0, id_amount=0.0), inputs) == 0.0).all()


def test_without_links_there_are_no_lines(run):
    assert (run(GeometryEdges(), size=(6, 5)) == 0.0).all()


@pytest.mark.parametrize("width", [2.5, 5.0, 13.0])
def test_wide_lines_lie_evenly_on_the_seams(run, width):
    y, x = np.mgrid[:61, :83]
    ids = ((x - 40) ** 2 + (y - 28) ** 2 < 400) + 2 * (x > 70)
    thin = run(GeometryEdges(), {"ids": ids})[..., 0] > 0.5
    contour = np.where(thin, 0.5 - distance_transform_edt(thin), distance_transform_edt(~thin) - 0.5)
    found = run(GeometryEdges(width=width), {"ids": ids})[..., 0]
    np.testing.assert_allclose(found, np.clip(width / 2.0 - 1.0 - contour + 0.5, 0.0, 1.0), atol=2e-5)


@pytest.mark.parametrize("scale", [1.0, 0.5, 0.25])
@pytest.mark.parametrize("width", [0.0, 1.0, 2.0, 3.0, 8.0])
def test_a_straight_line_is_as_wide_as_asked(run, width, scale):
    ids = np.zeros((16, 64))
    ids[:, 32:] = 1.0
    found = run(GeometryEdges(width=width), {"ids": ids}, scale=scale)[..., 0]
    np.testing.assert_allclose(found.sum(axis=1) / scale, width, atol=1e-4)
