"""Filling from the border: against Laplace's equation solved by scipy, and against OpenCV's methods."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.matte.edge_extend import EdgeExtend
from halation.nodes.matte.inpaint import Inpaint
from halation.nodes.matte.light_wrap import LightWrap
from scipy import ndimage, sparse
from scipy.sparse.linalg import spsolve
from scipy.special import erf


def solve_membrane(picture: np.ndarray, hole: np.ndarray) -> np.ndarray:
    """Every pixel of the hole as the mean of its neighbors; nothing flows over the border of the picture."""
    height, width = hole.shape
    number = np.arange(height * width).reshape(hole.shape)
    rows, columns, weights = [], [], []
    for way in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        y, x = np.mgrid[:height, :width]
        other = number[np.clip(y + way[0], 0, height - 1), np.clip(x + way[1], 0, width - 1)]
        rows.append(number[hole])
        columns.append(other[hole])
        weights.append(np.full(hole.sum(), -0.25))
    entries = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
    matrix = sparse.csc_matrix(entries, shape=(hole.size, hole.size)) + sparse.identity(hole.size)
    right = np.where(hole[..., None], 0.0, picture.astype(np.float64)).reshape(-1, 4)
    return spsolve(matrix.tocsc(), right).reshape(picture.shape)


def make_holes(width: int, height: int, kind: str) -> np.ndarray:
    """Scratches, blots, a large box, or letters."""
    random, hole = np.random.default_rng(12), np.zeros((height, width), np.uint8)
    if kind == "scratches":
        for _ in range(8):
            ends = [(int(random.integers(width)), int(random.integers(height))) for _ in range(2)]
            cv2.line(hole, *ends, 1, 3)
    elif kind == "blots":
        for _ in range(12):
            center = (int(random.integers(width)), int(random.integers(height)))
            cv2.circle(hole, center, int(random.integers(3, 9)), 1, -1)
    elif kind == "box":
        hole[height // 3 : 2 * height // 3, width // 3 : 2 * width // 3] = 1
    else:
        for line in range(4):
            cv2.putText(hole, "Halation", (4, 26 + 24 * line), cv2.FONT_HERSHEY_SIMPLEX, 1.0, 1, 2)
    return hole.astype(bool)


HOLES = ["scratches", "blots", "box", "letters"]


@pytest.mark.parametrize("kind", HOLES)
@pytest.mark.parametrize("size", [(96, 64), (61, 47)])
def test_holes_are_filled_by_a_membrane(run, kind, size):
    width, height = size
    random = np.random.default_rng(1)
    picture = ndimage.gaussian_filter(random.random((height, width, 4)), (4, 4, 0)).astype(np.float32)
    picture = (picture - picture.min()) / np.ptp(picture)
    hole = make_holes(width, height, kind)
    filled = run(Inpaint(), {"image": picture, "hole": hole})
    np.testing.assert_allclose(filled, solve_membrane(picture, hole), atol=5e-3)
    np.testing.assert_array_equal(filled[~hole], picture[~hole])


def measure_psnr(picture: np.ndarray, truth: np.ndarray, hole: np.ndarray) -> float:
    return float(-10.0 * np.log10(np.mean((picture[hole] - truth[hole]) ** 2)))


@pytest.mark.parametrize("kind", HOLES)
def test_fillings_are_closer_to_the_truth_than_those_of_opencv(run, rendered_frame, kind):
    """The mean PSNR over six parts of a render, against the methods of Telea and Bertalmio (Navier-Stokes)."""
    psnrs = []
    hole = make_holes(144, 112, kind)
    for x, y in ((60, 40), (250, 120), (300, 20), (20, 130), (150, 100), (180, 20)):
        light = rendered_frame[y : y + 112, x : x + 144, :3]
        codes = np.round(255.0 * np.clip(light, 0.0, 1.0) ** 0.4545).astype(np.uint8)
        picture = np.concatenate([codes / 255.0, np.ones_like(light[..., :1])], -1)
        picture[hole] = 1.0
        fillings = [run(Inpaint(), {"image": picture, "hole": hole})[..., :3]]
        for method in (cv2.INPAINT_TELEA, cv2.INPAINT_NS):
            fillings.append(cv2.inpaint(codes, hole.astype(np.uint8), 3.0, method) / 255.0)
        psnrs.append([measure_psnr(filling, codes / 255.0, hole) for filling in fillings])
    ours, telea, navier_stokes = np.mean(psnrs, 0)
    assert ours > max(telea, navier_stokes) + 0.3, (ours, telea, navier_stokes)


def test_a_hole_grows_and_blends(run):
    picture = np.full((32, 32, 4), (0.2, 0.4, 0.6, 1.0), np.float32)
    picture[13:19, 13:19, :3] = 3.0
    small = np.zeros((32, 32), np.float32)
    small[15:17, 15:17] = 1.0
    clean = np.full((32, 32, 4), (0.2, 0.4, 0.6, 1.0), np.float32)
    np.testing.assert_allclose(run(Inpaint(grow=4.0), {"image": picture, "hole": small}), clean, atol=1e-5)
    soft = np.zeros((32, 32), np.float32)
    soft[13:19, 13:19] = 0.25
    blended = run(Inpaint(), {"image": picture, "hole": soft})
    np.testing.assert_allclose(blended, 0.75 * picture + 0.25 * clean, atol=1e-5)


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_a_picture_that_is_all_hole_is_finite(run, share):
    picture = np.full((9, 13, 4), 0.5, np.float32)
    filled = run(Inpaint(opaque=True), {"image": picture, "hole": np.full((9, 13), share, np.float32)})
    expected = (0.0, 0.0, 0.0, 1.0) if share else (0.5, 0.5, 0.5, 0.5)
    np.testing.assert_allclose(filled, np.broadcast_to(np.float32(expected), filled.shape), atol=1e-6)


def make_contaminated() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A soft disc whose edge shows the old background: the picture, the true color everywhere, the coverage."""
    y, x = np.mgrid[:72, :96] / 96.0
    color = np.stack([0.5 + 0.4 * np.sin(9.0 * x), 0.4 + 0.3 * np.cos(7.0 * y), 0.3 + 0.4 * x], -1)
    coverage = np.clip((28.0 - np.hypot(96.0 * x - 47.0, 96.0 * y - 35.0)) / 9.0, 0.0, 1.0)
    shown = coverage[..., None] * color + (1.0 - coverage[..., None]) * np.array((0.1, 0.7, 0.1))
    picture = np.concatenate([coverage[..., None] * shown, coverage[..., None]], -1).astype(np.float32)
    return picture, color, coverage


def test_edges_lose_the_color_of_the_old_background(run):
    picture, color, coverage = make_contaminated()
    out = run(EdgeExtend(solid=0.999, inset=0.0), {"image": picture})
    np.testing.assert_allclose(out[..., 3], picture[..., 3], atol=1e-6)
    edge = (coverage > 0.0) & (coverage < 0.999)
    truth = coverage[..., None] * color
    errors = [np.sqrt(((colors - truth)[edge] ** 2).mean()) for colors in (out[..., :3], picture[..., :3])]
    assert errors[0] < 0.5 * errors[1]


def test_an_inset_takes_color_from_farther_inside(run):
    picture, _, coverage = make_contaminated()
    opaque = run(EdgeExtend(solid=0.5, inset=6.0, alpha="opaque"), {"image": picture})
    np.testing.assert_array_equal(opaque[..., 3], 1.0)
    y, x = np.mgrid[-6:7, -6:7]
    inside = ndimage.grey_erosion(coverage, footprint=x * x + y * y <= 36, mode="nearest") >= 0.5
    np.testing.assert_allclose(opaque[inside], picture[inside] / coverage[inside][:, None], atol=2e-5)
    straight = np.where(inside[..., None], picture / np.maximum(coverage, 1e-6)[..., None], 0.0)
    np.testing.assert_allclose(opaque[..., :3], solve_membrane(straight, ~inside)[..., :3], atol=1e-2)


def test_a_wrap_is_the_error_function(run):
    """At a straight edge before a uniform background, the light that reaches inside is half an error function."""
    picture = np.zeros((8, 120, 4), np.float32)
    picture[:, 60:] = (0.2, 0.2, 0.2, 1.0)
    background = np.full((8, 120, 4), (0.8, 0.6, 0.4, 1.0), np.float32)
    light = run(LightWrap(width=20.0, intensity=1.5), {"image": picture, "background": background}, output="light")
    away = np.arange(120) + 0.5 - 60.0
    share = np.where(away > 0.0, 0.75 * (1.0 - erf(away / (10.0 * np.sqrt(2.0)))), 0.0)
    np.testing.assert_allclose(light[4, :, :3], share[:, None] * (0.8, 0.6, 0.4), atol=4e-3)
    out = run(LightWrap(width=20.0, intensity=1.5), {"image": picture, "background": background})
    np.testing.assert_allclose(out[..., :3], picture[..., :3] + light[..., :3], atol=1e-6)
    np.testing.assert_array_equal(out[..., 3], picture[..., 3])
