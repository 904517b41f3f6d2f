"""Depth of field against closed forms, discs of our own making, and Cycles with a lens."""

from __future__ import annotations

from importlib import resources

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.lens.depth_of_field import DepthOfField
from lens import blender, opaque, psnr
from scipy.signal import fftconvolve

SIZE = 129


def lens(width: int, coc: float, **values) -> DepthOfField:
    """In focus at 5; the circle of confusion is so many pixels across at depth 10, and as many at 10 / 3, before it."""
    fit = {"focal": 100.0, "sensor": 100.0, "f_number": 0.1 * width * 0.1 / coc, "max_blur": 0.5}
    return DepthOfField(**{"focus": "distance", "focus_distance": 5.0, "convention": "pinhole"} | fit | values)


def deep(depth: float, width: int = SIZE, height: int = SIZE) -> np.ndarray:
    return np.full((height, width), depth, np.float32)


def disc(radius: float, corners: int = 0, turned: float = 0.0, cells: int = 16) -> np.ndarray:
    """What of each pixel a disc or a polygon covers, by counting; of sum 1."""
    half = int(radius) + 2
    at = (np.arange((2 * half + 1) * cells) + 0.5) / cells - half - 0.5
    x, y = np.meshgrid(at, -at)
    inside = np.hypot(x, y) <= radius
    for i in range(corners):
        angle = turned + 2.0 * np.pi * (i + 0.5) / corners
        inside &= x * np.cos(angle) + y * np.sin(angle) <= radius * np.cos(np.pi / corners)
    cover = inside.reshape(2 * half + 1, cells, 2 * half + 1, cells).mean((1, 3))
    return cover / cover.sum()


def bokeh(run, node: DepthOfField, depth: float = 10.0, at: int = SIZE // 2) -> np.ndarray:
    """What becomes of a single pixel."""
    picture = np.zeros((SIZE, SIZE, 4), np.float32)
    picture[at, at] = 1.0
    return run(node, {"image": picture, "depth": deep(depth)})[..., 0].astype(float)


@pytest.mark.parametrize("convention", ["thin lens", "pinhole"])
@pytest.mark.parametrize("focus", ["point", "distance"])
def test_the_circle_of_confusion(run, convention, focus):
    depth = np.random.default_rng(1).uniform(1.0, 50.0, (9, 16)).astype(np.float32)
    depth[0, :4] = np.inf, 1e10, np.nan, -1.0
    depth[5, 10] = 4.0
    node = DepthOfField(
        convention=convention,
        focus=focus,
        focus_distance=4.0,
        focus_point=(10.0 / 15.0, 5.0 / 8.0),
        max_blur=0.5,
        f_number=0.2,
        focal=60.0,
        sensor=24.0,
        meters=0.5,
    )
    found = run(node, {"image": np.ones((9, 16, 4)), "depth": depth}, output="coc")[..., 0]
    near = np.where(np.isfinite(depth) & (depth > 0.0) & (depth < 1e9), 1.0 / (0.5 * depth.astype(float)), 0.0)
    sharp, focal = 2.0, 0.06
    expected = focal / 0.2 * (60.0 / 24.0) * 16.0 * (1.0 / sharp - near)
    if convention == "thin lens":
        expected *= sharp / (sharp - focal)
    np.testing.assert_allclose(found, np.clip(expected, -4.5, 4.5), rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize(
    ("coc", "quality", "depth"),
    [
        (10.0, "normal", 10.0),
        (20.0, "normal", 10.0),
        (20.0, "normal", 10.0 / 3.0),
        (40.0, "normal", 10.0),
        (50.0, "high", 10.0 / 3.0),
        (30.0, "exact", 10.0),
        (12.0, "draft", 10.0),
        (12.0, "draft", 10.0 / 3.0),
    ],
)
def test_a_point_of_light_becomes_a_disc(run, coc, quality, depth):
    found = bokeh(run, lens(SIZE, coc, quality=quality), depth)
    y, x = np.mgrid[:SIZE, :SIZE] - SIZE // 2
    energy = found.sum()
    diameter = np.sqrt(8.0 * (found * (x * x + y * y)).sum() / energy)
    assert energy == pytest.approx(1.0, abs=2e-3) and diameter == pytest.approx(coc, rel=0.02)
    assert np.abs(found).min() == 0.0 and np.hypot((found * x).sum(), (found * y).sum()) < 0.06 * coc


@pytest.mark.parametrize(
    ("coc", "quality", "limit"),
    [
        (9.0, "normal", 0.01),
        (17.0, "exact", 0.01),
        (20.0, "high", 0.01),
        (20.0, "normal", 0.01),
    ],
)
def test_a_plane_is_convolved_with_the_disc(run, rendered_frame, coc, quality, limit):
    picture = rendered_frame[100:229, 200:329].copy()
    picture = np.minimum(picture, 4.0)
    found = run(lens(SIZE, coc, quality=quality), {"image": picture, "depth": deep(10.0)})
    kernel = disc(coc / 2.0)
    expected = np.dstack([fftconvolve(picture[..., c].astype(float), kernel, "same") for c in range(4)])
    inside = slice(24, -24)
    error = np.sqrt(((found - expected)[inside, inside] ** 2).mean() / (expected[inside, inside] ** 2).mean())
    assert error < limit


@pytest.mark.parametrize("coc", [13.0, 24.0])
def test_the_rim_is_that_of_a_disc(run, coc):
    found, kernel = bokeh(run, lens(SIZE, coc, quality="exact")), disc(coc / 2.0)
    half = kernel.shape[0] // 2
    middle = slice(SIZE // 2 - half, SIZE // 2 + half + 1)
    error = np.sqrt(((found[middle, middle] - kernel) ** 2).mean()) / kernel.max()
    assert error < 0.02


def test_what_is_in_focus_stays(run, hdr):
    picture = hdr(61, 43)
    depth = np.random.default_rng(2).uniform(4.0, 7.0, (43, 61))
    node = lens(61, 0.45 / (0.2 / 0.1) * 2.0, quality="normal")
    coc = run(node, {"image": picture, "depth": depth}, output="coc")
    assert 0.2 < np.abs(coc).max() < 0.5
    np.testing.assert_array_equal(run(node, {"image": picture, "depth": depth}), picture)
    far = run(lens(61, 20.0), {"image": picture, "depth": deep(10.0, 61, 43), "mask": np.zeros((43, 61))})
    np.testing.assert_array_equal(far, picture)
    assert DepthOfField(max_blur=0.0).identity() == "image"


@pytest.mark.parametrize("coc", [8.0, 22.0, 40.0])
def test_the_background_does_not_leak(run, coc):
    """A sharp half plane before one that is out of focus: each keeps its own light, right up to the edge."""
    depth, light = deep(10.0), np.full((SIZE, SIZE, 4), 0.25, np.float32)
    depth[:, :60], light[:, :60] = 5.0, 3.0
    found = run(lens(SIZE, coc), {"image": light, "depth": depth})
    assert np.abs(found[:, :60] - 3.0).max() < 1e-6
    assert np.abs(found[:, 60:] - 0.25).max() < 1e-5


@pytest.mark.parametrize("coc", [8.0, 40.0])
@pytest.mark.parametrize("bright", [30.0, 0.01])
def test_antialiased_edges_of_what_is_sharp_stay(run, coc, bright):
    """Pixels that a lamp in focus covers in part, with the depth of what is behind, throw no halo of its light."""
    depth, light = deep(10.0), np.full((SIZE, SIZE, 4), 0.25, np.float32)
    depth[:, :60], light[:, :60], light[:, 60] = 5.0, bright, 0.4 * bright + 0.6 * 0.25
    found = run(lens(SIZE, coc), {"image": light, "depth": depth})
    np.testing.assert_allclose(found, light, rtol=1e-5)


@pytest.mark.parametrize(("coc", "quality"), [(10.0, "normal"), (22.0, "normal"), (40.0, "normal"), (22.0, "exact")])
def test_the_near_spreads_over_what_is_in_focus(run, coc, quality):
    """At an edge, the part of a disc that is cut off by it: in front and behind, both flat."""
    depth, light = deep(5.0), np.full((SIZE, SIZE, 4), 0.25, np.float32)
    depth[:, :60], light[:, :60] = 10.0 / 3.0, 3.0
    found = run(lens(SIZE, coc, quality=quality), {"image": light, "depth": depth})[SIZE // 2, :, 0]
    t = np.clip((np.arange(SIZE) + 0.5 - 60.0) / (coc / 2.0), -1.0, 1.0)
    covered = (np.arccos(t) - t * np.sqrt(1.0 - t * t)) / np.pi
    error = np.abs(found - (0.25 + 2.75 * covered)) / 2.75
    assert error.max() < 0.03 and np.sqrt((error[50:70] ** 2).mean()) < 0.015


@pytest.mark.parametrize("corners", [3, 5, 6])
def test_blades_make_polygons(run, corners):
    node = lens(SIZE, 30.0, quality="exact", aperture="blades", blades=corners, rotation=20.0)
    found, expected = bokeh(run, node), disc(15.0, corners, np.radians(20.0))
    half = expected.shape[0] // 2
    middle = slice(SIZE // 2 - half, SIZE // 2 + half + 1)
    area = 0.5 * corners * np.sin(2.0 * np.pi / corners) * 15.0**2
    assert found.sum() == pytest.approx(1.0, abs=1e-4) and 1.0 / found.max() == pytest.approx(area, rel=0.002)
    error = np.sqrt(((found[middle, middle] - expected) ** 2).mean()) / expected.max()
    assert error < 0.01
    upside_down = bokeh(run, node, 10.0 / 3.0)
    np.testing.assert_allclose(upside_down[::-1, ::-1], found, atol=1e-7)
    round_again = lens(SIZE, 30.0, quality="exact", aperture="blades", blades=corners, roundness=1.0)
    np.testing.assert_allclose(bokeh(run, round_again), bokeh(run, lens(SIZE, 30.0, quality="exact")), atol=1e-6)


@pytest.mark.parametrize(("quality", "off"), [("normal", 0.045), ("exact", 0.01)])
@pytest.mark.parametrize("ratio", [2.0, 0.5])
def test_anamorphic_bokeh_is_taller_than_wide(run, quality, off, ratio):
    found = bokeh(run, lens(SIZE, 32.0, ratio=ratio, quality=quality))
    y, x = np.mgrid[:SIZE, :SIZE] - SIZE // 2
    wide, tall = (np.sqrt(16.0 * (found * at * at).sum() / found.sum()) for at in (x, y))
    assert found.sum() == pytest.approx(1.0, abs=1e-5) and tall / wide == pytest.approx(ratio, rel=off)
    assert max(tall, wide) == pytest.approx(32.0, rel=off)


def test_cat_s_eyes_are_in_the_corners(run):
    node = lens(SIZE, 12.0, cat_eye=1.0, quality="exact")
    middle, corner = bokeh(run, node), bokeh(run, node, at=20)
    assert np.corrcoef(middle.ravel(), bokeh(run, lens(SIZE, 12.0, quality="exact")).ravel())[0, 1] > 0.999
    # What two discs have in common that are moved apart towards the middle, by how far out the pixel is.
    out = (2 * 20 + 1 - SIZE) / (SIZE * np.sqrt(2.0)) * 6.0 / 2.0
    y, x = (np.mgrid[:800, :800] + 0.5) / 50.0 - 8.0
    both = (np.hypot(x - out, y - out) < 6.0) & (np.hypot(x + out, y + out) < 6.0)
    expected = [((x + sign * y)[both] ** 2).mean() for sign in (1, -1)]
    y, x = np.mgrid[:SIZE, :SIZE] - 20
    across, along = ((corner * (x + sign * y) ** 2).sum() / corner.sum() for sign in (1, -1))
    assert across / along == pytest.approx(expected[0] / expected[1], rel=0.01) and across < 0.65 * along
    assert (across, along) == pytest.approx(tuple(expected), rel=0.025)  # a pixel widens it by a twelfth
    assert corner.sum() == pytest.approx(1.0, abs=1e-3)


def test_it_is_linear_in_light(run, hdr):
    """Highlights are kept: no light is weighed down for being bright."""
    picture, rng = hdr(64, 48), np.random.default_rng(3)
    depth = np.where(rng.random((48, 64)) < 0.05, 10.0 / 3.0, rng.uniform(5.0, 20.0, (48, 64)))
    a, b = (run(lens(64, 14.0), {"image": one, "depth": depth}) for one in (picture, 4096.0 * picture))
    np.testing.assert_allclose(b, 4096.0 * a, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize(("name", "quality"), [("far", "normal"), ("near", "normal"), ("near", "exact")])
def test_cycles_with_a_lens(run, name, quality):
    data = blender()
    node = DepthOfField(
        focus="distance",
        focus_distance=7.0,
        f_number=0.036 / 0.5,
        focal=36.0,
        sensor=36.0,
        convention="pinhole",
        max_blur=0.5,
        quality=quality,
    )
    picture, expected = opaque(data[f"{name}_image"]), data[f"{name}_blurred"]
    found = run(node, {"image": picture, "depth": data[f"{name}_depth"]})
    assert psnr(found, expected) > 42.5 > 28.0 > psnr(picture, expected)


def moments(light: np.ndarray, x: float, y: float, reach: int) -> tuple[float, float]:
    """The energy of a lamp before a dark sky, and the diameter of an even disc that is as wide."""
    left, top = round(x) - reach, round(y) - reach
    lamp = (light[top : top + 2 * reach, left : left + 2 * reach, :3].astype(float) - (0.02, 0.02, 0.03)).sum(-1)
    v, u = np.mgrid[: 2 * reach, : 2 * reach]
    energy = lamp.sum()
    wide = sum((lamp * (at - (lamp * at).sum() / energy) ** 2).sum() for at in (u, v)) / energy
    return energy, np.sqrt(8.0 * wide)


@pytest.mark.parametrize(("quality", "least"), [("normal", 43.5), ("exact", 48.0)])
def test_cycles_with_lamps_far_out_of_focus(run, quality, least):
    """Small lamps, hardly more than their antialiased edges, behind the focus and close to the camera: each keeps its
    energy, and is as wide as the circle of confusion says, to two percent."""
    data = blender("travel")
    node = DepthOfField(
        focus="distance",
        focus_distance=5.2,
        f_number=0.036 / 0.4,
        focal=36.0,
        sensor=36.0,
        convention="pinhole",
        max_blur=0.5,
        quality=quality,
    )
    picture, expected = opaque(data["lamps_image"]), data["lamps_blurred"]
    found = run(node, {"image": picture, "depth": data["lamps_depth"]})
    assert psnr(found, expected) > least > 20.0 > psnr(picture, expected)
    for x, y, deep, reach in (
        (32.0, 22.3, 22.0, 9),
        (76.0, 14.3, 22.0, 9),
        (139.2, 28.7, 22.0, 9),
        (57.2, 18.7, 2.4, 10),
        (113.7, 20.2, 2.4, 11),
    ):
        coc = 0.4 * 176.0 * abs(1.0 / 5.2 - 1.0 / deep)
        sharp, made, real = (moments(light, x, y, reach) for light in (picture, found, expected))
        assert made[0] == pytest.approx(sharp[0], rel=0.02) and made[0] == pytest.approx(real[0], rel=0.02)
        assert made[1] == pytest.approx(np.hypot(sharp[1], coc), rel=0.02)
        assert made[1] == pytest.approx(real[1], rel=0.02)


def test_a_slope_has_no_seams(run):
    """Light of 1 stays 1 however its discs are shared out between levels, and a ramp stays smooth."""
    depth = np.broadcast_to(np.geomspace(2.0, 60.0, SIZE, dtype=np.float32)[:, None], (SIZE, SIZE))
    light = np.ones((SIZE, SIZE, 4), np.float32)
    light[..., 0] = np.linspace(1.0, 2.0, SIZE)[:, None]
    found = run(lens(SIZE, 30.0), {"image": light, "depth": depth})
    assert np.abs(found[..., 3] - 1.0).max() < 1e-5
    assert np.abs(np.diff(found[:, 64, 0])).max() < 4.0 / SIZE


def test_a_dark_ear_before_a_lamp_turns_no_darker(run):
    """Edge pixels of a lamp behind something hold less light than the lamp: nobody pays for that."""
    with resources.as_file(resources.files("halation.presets") / "samples" / "neon.exr") as path:
        parts = [oiio.ImageBuf(str(path), part, 0) for part in range(oiio.ImageBuf(str(path)).nsubimages)]
    layers = {part.spec().getattribute("oiio:subimagename"): part.get_pixels(oiio.FLOAT) for part in parts}
    image, depth = (next(item for name, item in layers.items() if name.endswith(end)) for end in ("Combined", "Depth"))
    node = DepthOfField(
        focus_point=(0.46, 0.38),
        f_number=1.8,
        max_blur=0.08,
        meters=0.1,
        quality="high",
        aperture="blades",
        roundness=0.35,
        rotation=12.0,
        cat_eye=0.55,
    )
    found = run(node, {"image": image, "depth": depth[..., 0]})[..., :3].max(2)
    ear = np.s_[108:126, 148:170]
    assert found[ear].min() > 0.1
