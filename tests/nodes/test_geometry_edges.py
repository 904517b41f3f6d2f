"""Geometry edges: none on planes, closed forms at steps and folds, exact ids, coverage by distances at 8 x 8."""

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
    diagonal = 1.5 - np.sqrt(0.5)  # a band of two pixels, from the middle of a pixel that lies beside a diagonal
    assert outline.sum() > 500 and found[outline].min() > diagonal - 1e-5 and np.median(found[outline]) == 1.0


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
        assert run(GeometryEdges(), {"ids": given})[..., 0][expected].min() > 0.75


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


def shapes(width: int, height: int, samples: int) -> dict[str, np.ndarray]:
    """Discs, an ellipse, a turned box, a rod and half planes, with `samples` x `samples` for each pixel."""
    y, x = (np.mgrid[: height * samples, : width * samples] + 0.5) / samples
    u, v = ((x - 48.0) * np.cos(0.3) + (y - 36.0) * np.sin(0.3), (y - 36.0) * np.cos(0.3) - (x - 48.0) * np.sin(0.3))
    half_planes = {
        f"{angle} degrees": (x - 47.3) * np.cos(np.radians(angle)) + (y - 35.6) * np.sin(np.radians(angle)) < 0.0
        for angle in (10, 20, 33, 60, 77)
    }
    return half_planes | {
        "disc": np.hypot(x - 47.1, y - 36.4) < 24.3,
        "large disc": np.hypot(x - 48.4, y - 35.8) < 31.9,
        "box": (abs(u) < 22.2) & (abs(v) < 14.7),
        "rod": abs(v) < 2.3,
    }


@pytest.mark.parametrize("layer", ["ids", "normal", "depth"])
@pytest.mark.parametrize("width", [1.0, 1.6, 2.5, 6.0, 13.0])
def test_lines_cover_pixels_as_distances_at_eight_times_the_size(run, width, layer):
    """From a layer without antialiasing, within 0.1 (RMS over all pixels that either line touches).

    The staircase itself, without the line through it, is 0.2 to 0.3 off.
    """
    across, down, samples = 96, 72, 8
    for name, inside in shapes(across, down, samples).items():
        away = np.where(inside, distance_transform_edt(inside), distance_transform_edt(~inside)) - 0.5
        expected = (away / samples < width / 2.0).reshape(down, samples, across, samples).mean((1, 3))
        pixels = inside[samples // 2 :: samples, samples // 2 :: samples]
        given = {
            "ids": pixels * 1.0,
            "normal": np.where(pixels[..., None], np.float32([0.6, 0.0, 0.8]), np.float32([0.0, -0.8, 0.6])),
            "depth": np.where(pixels, 4.0, 7.0),
        }
        found = run(GeometryEdges(width=width), {layer: given[layer]})[..., 0]
        inner = np.s_[2:-2, 2:-2]  # beyond the border of the picture nothing is known
        touched = ((expected > 0.0) | (found > 0.0))[inner]
        error = ((found - expected)[inner][touched] ** 2).mean() ** 0.5
        assert error < (0.115 if width == 1.0 else 0.1), name


def test_filtered_normals_have_one_edge(run):
    """A pixel between two surfaces has the mean of their normals, which is no edge on both of its sides."""
    samples, inside = 8, shapes(96, 72, 8)["disc"]
    share = inside.reshape(72, samples, 96, samples).mean((1, 3))[..., None]
    one, other = np.array([0.9, 0.0, np.sqrt(0.19)]), np.array([-0.9, 0.0, np.sqrt(0.19)])
    away = np.where(inside, distance_transform_edt(inside), distance_transform_edt(~inside)) - 0.5
    expected = (away / samples < 0.8).reshape(72, samples, 96, samples).mean((1, 3))
    found = run(GeometryEdges(width=1.6), {"normal": share * one + (1.0 - share) * other})[..., 0]
    touched = (expected > 0.0) | (found > 0.0)
    assert ((found - expected)[touched] ** 2).mean() ** 0.5 < 0.1
    assert 0.97 < found.sum() / expected.sum() < 1.03


@pytest.mark.parametrize("scale", [1.0, 0.5, 0.25])
@pytest.mark.parametrize("width", [0.0, 1.0, 2.0, 3.0, 8.0])
def test_a_straight_line_is_as_wide_as_asked(run, width, scale):
    ids = np.zeros((16, 64))
    ids[:, 32:] = 1.0
    found = run(GeometryEdges(width=width), {"ids": ids}, scale=scale)[..., 0]
    np.testing.assert_allclose(found.sum(axis=1) / scale, width, atol=1e-4)


@pytest.mark.parametrize("width", [5.0, 8.0, 13.0])
def test_a_wide_line_along_a_fold_ends_round(run, width):
    """As far from the nearest pixel of the fold as scipy measures; it fades out in the middle of the picture."""
    y, x = np.mgrid[:24, :37]
    depth = 1.0 / (1.0 + 0.02 * np.abs(x - 18) * np.clip((32.0 - y) / 20.0 - 0.3, 0.0, 1.0))
    fold = run(GeometryEdges(width=1.0, depth_threshold=0.02, softness=0.5), {"depth": depth})[..., 0] >= 0.5
    assert fold[:, 18].any() and not fold[-6:].any() and not np.delete(fold, 18, 1).any()
    expected = np.clip(0.5 * width + 0.5 - distance_transform_edt(~fold), 0.0, 1.0)
    np.testing.assert_allclose(
        run(GeometryEdges(width=width, depth_threshold=0.02, softness=0.5), {"depth": depth})[..., 0],
        expected,
        atol=1e-5,
    )
