"""Transform against scipy and OpenImageIO."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.distort.transform import Transform
from oiio_pictures import buffer
from scipy.ndimage import map_coordinates

KERNELS = Transform.values["kernel"].choices
MOVES = [
    {"position": (3.3, -1.7)}, {"rotation": 27.0}, {"scale": (1.7, 1.2), "pivot": (0.2, 0.9)},
    {"rotation": -133.0, "scale": (1.5, -1.1), "position": (2.0, 4.5), "pivot": (0.7, 0.4)},
]


def forward(node: Transform, size: tuple[int, int]) -> np.ndarray:
    """The 3 x 3 matrix that takes image positions to result positions."""
    x, y = node.pivot[0] * size[0], node.pivot[1] * size[1]
    turn = np.radians(node.rotation)
    to_pivot = np.array([[1, 0, -x], [0, 1, -y], [0, 0, 1.0]])
    scale = np.diag([*node.scale, 1.0])
    spin = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1.0]])
    back = np.array([[1, 0, x + node.position[0]], [0, 1, y + node.position[1]], [0, 0, 1.0]])
    return back @ spin @ scale @ to_pivot


def sampled(picture: np.ndarray, matrix: np.ndarray, mode: str) -> np.ndarray:
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]] + 0.5
    where = np.einsum("ij,jyx->iyx", np.linalg.inv(matrix), np.stack([x, y, np.ones_like(x)])) - 0.5
    channels = np.moveaxis(picture.astype(np.float64), -1, 0)
    return np.stack([map_coordinates(c, where[1::-1], order=1, mode=mode) for c in channels], -1)


@pytest.mark.parametrize("move", MOVES, ids=str)
@pytest.mark.parametrize("size", [(31, 22), (3, 2), (1, 1)])
def test_bilinear_is_scipys(run, hdr, edge, move, size):
    picture, node = hdr(*size), Transform(kernel="triangle", edge=edge.name, **move)
    expected = sampled(picture, forward(node, size), edge.scipy_map)
    assert np.abs(run(node, {"image": picture}) - expected).max() < 1e-5 * picture.max()


@pytest.mark.parametrize(("kernel", "name"), [
    ("triangle", "triangle"), ("catmull-rom", "catmull-rom"), ("mitchell", "mitchell"), ("lanczos", "lanczos3"),
])
def test_turned_it_is_openimageios(run, hdr, kernel, name):
    picture = hdr(48, 40)
    node = Transform(rotation=20.0, position=(2.25, -3.5), kernel=kernel)
    matrix = tuple(float(part) for part in forward(node, (48, 40)).T.ravel())
    expected = oiio.ImageBufAlgo.warp(buffer(picture), matrix, name, wrap="black").get_pixels("float")
    error = np.abs(run(node, {"image": picture}) - expected)[12:-12, 12:-12]
    assert error.max() < 1e-5 * picture.max()


@pytest.mark.parametrize("kernel", KERNELS)
def test_whole_steps_and_quarter_turns_are_exact(run, hdr, kernel):
    picture = hdr(24, 24)
    if kernel != "mitchell":  # which softens even where nothing moves
        moved = run(Transform(position=(3.0, -5.0), edge="wrap", kernel=kernel), {"image": picture})
        assert np.abs(moved - np.roll(picture, (-5, 3), (0, 1))).max() < 1e-5 * picture.max()
        turned = run(Transform(rotation=90.0, kernel=kernel), {"image": picture})
        assert np.abs(turned - np.rot90(picture, -1)).max() < 1e-5 * picture.max()
        mirrored = run(Transform(scale=(-1.0, 1.0), kernel=kernel), {"image": picture})
        assert np.abs(mirrored - picture[:, ::-1]).max() < 1e-5 * picture.max()


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("scale", [0.05, 0.3, 2.5])
def test_an_even_picture_stays_even(run, kernel, scale):
    node = Transform(scale=(scale, scale), rotation=33.0, kernel=kernel, edge="clamp")
    taps = (6 / min(scale, 1.0)) ** 2  # each of which rounds
    assert np.abs(run(node, {"image": np.full((13, 17, 4), 0.37)}) - 0.37).max() < 6e-8 * 0.37 * taps + 1e-7


@pytest.mark.parametrize("kernel", [kernel for kernel in KERNELS if kernel != "nearest"])
def test_shrinking_does_not_alias(run, kernel):
    """Stripes finer than the result's pixels become their average."""
    stripes = np.zeros((64, 64, 4), np.float32)
    stripes[:, ::2] = 1.0
    out = run(Transform(scale=(0.25, 0.25), rotation=10.0, kernel=kernel, edge="wrap"), {"image": stripes})
    assert np.abs(out - 0.5).max() < 0.02


def test_inverse_is_the_inverse_matrix():
    pivot = (12.0, 9.0)
    node = Transform(position=(5.0, -3.0), rotation=40.0, scale=(1.5, 0.7), pivot=(0.3, 0.3)).working(1.0, 30)
    matrices = []
    for direction in ("forward", "inverse"):
        (a, b, c, d), (x, y) = node.changed(direction=direction).backward(pivot)
        matrices.append(np.array([[a, b, x], [c, d, y], [0, 0, 1]]))
    assert np.abs(matrices[0] @ matrices[1] - np.eye(3)).max() < 1e-12


def test_a_proxy_moves_as_far(run):
    y, x = np.mgrid[:64, :64] + 0.5
    picture = np.repeat(np.exp(-((x - 20) ** 2 / 60 + (y - 26) ** 2 / 150))[..., None], 4, -1)
    node = Transform(position=(16.0, 8.0), rotation=90.0)
    full, half = (run(node, {"image": picture}, scale=scale)[..., 3] for scale in (1.0, 0.5))
    assert np.abs(half - full.reshape(32, 2, 32, 2).mean((1, 3))).max() < 0.02


def test_standing_still_vanishes():
    assert Transform().identity() == "image" and Transform(rotation=1.0).identity() is None
