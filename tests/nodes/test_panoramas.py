"""Pictures by longitude and latitude: what lies outside is the other side of the world, against numpy's own padding.

A panorama and its other half below it, upside down and half a turn away, repeat in both directions. So the reference
for every filter is a picture that numpy padded from that, filtered and cut.
"""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.blur.box_blur import BoxBlur
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.blur.median import Median
from halation.nodes.distort.resize import Resize
from halation.nodes.distort.transform import Transform
from halation.nodes.glow.bloom import Bloom
from halation.nodes.glow.film_halation import FilmHalation
from halation.nodes.glow.kernel_glare import KernelGlare
from scipy.ndimage import gaussian_filter

MARGIN = 128
"""More than all light here reaches, and a multiple of all levels of bloom."""


def extend(picture: np.ndarray, edge: str, margin: int = MARGIN) -> np.ndarray:
    """The picture with `margin` more pixels on each side, by numpy."""
    if edge != "panorama":
        return np.pad(picture, ((margin, margin), (margin, margin), (0, 0)), "symmetric" if edge == "reflect" else edge)
    height, width, _ = picture.shape
    world = np.concatenate([picture, np.roll(picture[::-1], width // 2, axis=1)])
    return np.pad(world, ((margin, 2 * height + margin), (margin, margin), (0, 0)), "wrap")[: height + 2 * margin]


def cut(picture: np.ndarray, size: tuple[int, int], margin: int = MARGIN) -> np.ndarray:
    return picture[margin : margin + size[1], margin : margin + size[0]]


@pytest.mark.parametrize("sigma", [0.6, 3.0, 9.0, 20.0])
@pytest.mark.parametrize("size", [(64, 32), (90, 45), (38, 21)])
def test_a_blurred_panorama_is_scipys(run, hdr, sigma, size):
    picture = hdr(*size)
    expected = cut(gaussian_filter(extend(picture, "panorama").astype(np.float64), (sigma, sigma, 0.0)), size)
    if sigma < 1.0:  # scipy samples the Gaussian, we integrate it over each pixel
        padded = run(GaussianBlur(sigma=sigma), {"image": extend(picture, "panorama")})
        expected = cut(padded, size).astype(np.float64)
    out = run(GaussianBlur(sigma=sigma, edge="panorama"), {"image": picture})
    assert np.abs(out - expected).max() < 2e-3 * expected.max()
    inner = np.abs(run(GaussianBlur(sigma=sigma), {"image": picture}) - expected).max()
    assert inner > 0.01 * expected.max()  # it matters


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        (BoxBlur, {"radius": 5.0}),
        (BoxBlur, {"radius": 11.0, "kind": "iterated"}),
        (Median, {"window": "5x5"}),
        (Transform, {"position": (9.0, -13.0), "rotation": 20.0, "kernel": "mitchell"}),
        (Resize, {"scale": (0.5, 0.5), "kernel": "lanczos"}),
    ],
    ids=lambda item: item.__name__ if isinstance(item, type) else "",
)
@pytest.mark.parametrize("size", [(44, 22), (30, 18)])
def test_filters_see_the_other_side_of_the_world(run, hdr, kind, values, size):
    picture = hdr(*size)
    padded = run(kind(**values), {"image": extend(picture, "panorama")})
    out = run(kind(**values, edge="panorama"), {"image": picture})
    expected = cut(padded, out.shape[1::-1], MARGIN * out.shape[1] // size[0])
    assert np.abs(out - expected).max() < 1e-4 * np.abs(expected).max()


@pytest.mark.parametrize("edge", ["reflect", "wrap", "panorama"])
@pytest.mark.parametrize("size", [(64, 32), (88, 44), (45, 30), (26, 13)])
def test_glows_go_on_where_the_picture_does(run, hdr, edge, size):
    picture = hdr(*size)
    if edge == "panorama" and size[0] % 2:
        picture = picture[:, :-1]
    height, width, _ = picture.shape
    part = height / (height + 2 * MARGIN)  # of the height of the padded picture
    for kind, values, length in (
        (Bloom, {"scatter": 0.9}, {"radius": 0.2}),
        (Bloom, {"firefly": True, "threshold": 0.5}, {"radius": 0.06}),
        (FilmHalation, {"threshold": (0.2, 0.2, 0.2)}, {"radius": 0.03}),
        (KernelGlare, {"blades": 5}, {"size": 0.8}),
    ):
        lengths = {name: part * number for name, number in length.items()}
        padded = run(kind(**values, **lengths), {"image": extend(picture, edge)}, output="glow")
        expected = cut(padded, (width, height))
        out = run(kind(**values, **length, edge=edge), {"image": picture}, output="glow")
        assert np.abs(out - expected)[..., :3].max() < 2e-4 * np.abs(expected).max(), kind.__name__
