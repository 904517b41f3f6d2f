"""Gaussian blur, and with it the compiler's convolution and decimation, against scipy in 64 bits and closed forms."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from exr_files import write_exr
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.renderer import RenderRequest
from scipy.ndimage import correlate1d, gaussian_filter
from selection import list_cases

PEAKS = {4.2: 3.5e-4, 5.0: 2e-4, 7.0: 2e-4, 8.3: 7e-4, 11.3: 2e-4, 20.0: 3.5e-4, 50.0: 2e-4, 100.0: 2e-4}
"""Sigma of a blur that decimates -> the largest error of a single pixel, relative to what its peak becomes."""

LARGE = tuple(PEAKS)

DIRECT = 4.1
"""Sigmas up to this are convolved directly."""


def blurred(
    image: np.ndarray, sigma: float | tuple[float, float], mode: str = "nearest", truncate: float = 6.0
) -> np.ndarray:
    """By scipy; two sigmas are across and down."""
    across, down = sigma if isinstance(sigma, tuple) else (sigma, sigma)
    return gaussian_filter(image.astype(np.float64), (down, across, 0.0), mode=mode, truncate=truncate)


def impulse(width: int, height: int, x: int, y: int) -> np.ndarray:
    picture = np.zeros((height, width, 4), np.float32)
    picture[y, x] = 1.0
    return picture


@pytest.mark.parametrize("size", [(64, 48), (33, 17), (7, 5), (1, 9), (1, 1)])
@pytest.mark.parametrize("sigma", [1.0, 2.5, 4.0])
def test_small_sigmas_equal_scipy(run, hdr, edge, sigma, size):
    picture = hdr(*size)
    expected = blurred(picture, sigma, edge.scipy, truncate=4.0)
    found = run(GaussianBlur(sigma=sigma, edge=edge.name), {"image": picture})
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-5 * float(np.abs(expected).max()))


@pytest.mark.parametrize("sigma", [0.2, 0.5, 0.8])
def test_sigmas_below_a_pixel_integrate_the_gaussian(run, hdr, edge, sigma):
    picture = hdr(31, 22)
    taps = np.arange(-5, 6)
    cumulative = np.array([math.erf((tap - 0.5) / (sigma * math.sqrt(2.0))) for tap in [*taps, 6]])
    weights = np.diff(cumulative) / 2.0
    expected = picture.astype(np.float64)
    for axis in (0, 1):
        expected = correlate1d(expected, weights, axis, mode=edge.scipy)
    found = run(GaussianBlur(sigma=sigma, edge=edge.name), {"image": picture})
    # The tails that are cut off beyond 4 sigma hold 6e-5 of the light.
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-4 * float(expected.max()))


@pytest.mark.parametrize("sigma", [4.2, 5.0, 7.0, 20.0, 60.0])
@pytest.mark.parametrize("size", [(161, 97), (40, 333), (1, 50), (1, 1)])
def test_large_sigmas_equal_scipy(run, hdr, edge, sigma, size):
    picture = hdr(*size)
    expected = blurred(picture, sigma, edge.scipy)
    error = run(GaussianBlur(sigma=sigma, edge=edge.name), {"image": picture}) - expected
    assert np.abs(error).max() <= 1e-3 * expected.max()
    if min(size) > 1:
        assert np.sqrt((error**2).mean()) <= 3e-4 * np.sqrt((expected**2).mean())


# Sides that small pictures divide (all steps, some, none), where reflect and wrap stay what they are at any size.
@pytest.mark.parametrize("size", [(256, 64), (96, 40), (97, 12)])
@pytest.mark.parametrize("sigma", [30.0, 200.0])
def test_edges_are_right_however_far_it_reaches(run, hdr, edge, sigma, size):
    picture = hdr(*size)
    expected = blurred(picture, sigma, edge.scipy)
    error = run(GaussianBlur(sigma=sigma, edge=edge.name), {"image": picture}) - expected
    assert np.abs(error).max() <= 5e-4 * expected.max()
    for border in (error[:2], error[-2:], error[:, :2], error[:, -2:]):
        assert np.abs(border).max() <= 5e-4 * expected.max()


@pytest.mark.parametrize(
    ("sigma", "scale"),
    [
        (4.0, (1.0, 0.25)),
        (4.0, (0.0, 1.0)),
        (40.0, (1.0, 0.05)),
        (40.0, (0.4, 1.0)),
        (40.0, (1.0, 0.0)),
    ],
)
def test_each_direction_has_its_own_sigma(run, hdr, edge, sigma, scale):
    picture = hdr(71, 48)
    sigmas = (sigma * scale[0], sigma * scale[1])
    expected = blurred(picture, sigmas, edge.scipy, truncate=4.0 if sigma < DIRECT else 6.0)
    error = run(GaussianBlur(sigma=sigma, scale=scale, edge=edge.name), {"image": picture}) - expected
    assert np.abs(error).max() <= (1e-5 if sigma < DIRECT else 1e-3) * expected.max()
    if sigma > DIRECT:
        assert np.sqrt((error**2).mean()) <= 3e-4 * np.sqrt((expected**2).mean())


def test_turning_the_picture_turns_the_scale(run, hdr):
    picture = hdr(61, 44)
    turned = np.ascontiguousarray(picture.transpose(1, 0, 2))
    for sigma in (3.0, 20.0):
        found = run(GaussianBlur(sigma=sigma, scale=(1.0, 0.3)), {"image": picture})
        other = run(GaussianBlur(sigma=sigma, scale=(0.3, 1.0)), {"image": turned}).transpose(1, 0, 2)
        np.testing.assert_allclose(found, other, rtol=1e-5, atol=2e-6 * float(found.max()))


PHASES = ((0, 0), (1, 3), (5, 2))


@pytest.mark.parametrize(
    ("sigma", "phase"),
    list_cases([*product(LARGE[:-1], PHASES), (LARGE[-1], PHASES[1])], product(LARGE[-1:], PHASES[::2])),
)
def test_an_impulse_becomes_a_gaussian(run, sigma, phase):
    reach = int(5.0 * sigma) + 8
    picture = impulse(2 * reach, 2 * reach, reach + phase[0], reach + phase[1])
    expected = blurred(picture, sigma)
    found = run(GaussianBlur(sigma=sigma), {"image": picture})
    assert np.abs(found - expected).max() <= PEAKS[sigma] * expected.max()


@pytest.mark.parametrize("sigma", [2.5, *LARGE])
@pytest.mark.parametrize("offset", [0, 1, 3])
def test_a_step_becomes_the_error_function(run, sigma, offset):
    width = int(12.0 * sigma) + 16
    step = width // 2 + offset
    picture = np.zeros((4, width, 4), np.float32)
    picture[:, step:] = 1.0
    # A sum of samples is an integral whose Gaussian lacks the variance of a pixel's box, 1/12 (midpoint rule).
    position = (np.arange(width) + 0.5 - step) / math.sqrt(2.0 * (sigma * sigma - 1.0 / 12.0))
    expected = np.array([0.5 * (1.0 + math.erf(x)) for x in position])
    found = run(GaussianBlur(sigma=sigma), {"image": picture})
    assert np.abs(found - expected[None, :, None]).max() <= 1e-4


@pytest.mark.parametrize("sigma", [0.3, 2.0, 4.0, *LARGE])
def test_a_flat_picture_stays(run, sigma):
    flat = np.full((37, 53, 4), 3.75, np.float32)
    np.testing.assert_allclose(run(GaussianBlur(sigma=sigma), {"image": flat}), flat, rtol=2e-6)


@pytest.mark.parametrize("sigma", [0.3, 2.0, 4.5, 7.0, 20.0])
def test_no_light_is_lost(run, hdr, sigma):
    margin = int(6.0 * sigma) + 8
    picture = np.pad(hdr(23, 19), ((margin, margin), (margin, margin), (0, 0)))
    found = run(GaussianBlur(sigma=sigma, edge="black"), {"image": picture}).sum(axis=(0, 1), dtype=np.float64)
    np.testing.assert_allclose(found, picture.sum(axis=(0, 1), dtype=np.float64), rtol=1e-4)


@pytest.mark.parametrize(("sigma", "tolerance"), [(2.0, 1e-7), (4.0, 1e-7), (6.9, 3e-4), (20.0, 1e-3)])
def test_an_impulse_spreads_alike_in_all_directions(run, sigma, tolerance):
    side = 2 * int(5.0 * sigma) + 1
    found = run(GaussianBlur(sigma=sigma), {"image": impulse(side, side, side // 2, side // 2)})
    for turned in (found[::-1], found[:, ::-1], found.transpose(1, 0, 2)):
        assert np.abs(turned - found).max() <= tolerance * found.max()


@pytest.mark.parametrize(("sigma", "tolerance"), [(3.0, 1e-6), (20.0, 1e-3)])
def test_moving_the_picture_moves_the_result(run, hdr, sigma, tolerance):
    margin = int(5.0 * sigma) + 8
    picture = np.pad(hdr(17, 13), ((margin, margin), (margin, margin), (0, 0)))
    moved = np.roll(picture, (3, 5), (0, 1))
    still = run(GaussianBlur(sigma=sigma), {"image": picture})
    assert np.abs(np.roll(still, (3, 5), (0, 1)) - run(GaussianBlur(sigma=sigma), {"image": moved})).max() <= (
        tolerance * still.max()
    )


def test_two_blurs_add_their_variances(run):
    picture = impulse(301, 301, 150, 150)
    twice = run(GaussianBlur(sigma=16.0), {"image": run(GaussianBlur(sigma=12.0), {"image": picture})})
    once = run(GaussianBlur(sigma=20.0), {"image": picture})
    assert np.abs(twice - once).max() <= 1e-3 * once.max()


def test_the_work_hardly_grows_with_sigma(renderer, edge):
    """Pixels read by all passes over a large picture: at a sigma of 200, at most 1.5 times those at 20."""
    graph = Graph().add_input("image", Input(Kind.IMAGE, 4)).add_output("out", Output(Kind.IMAGE, 4))
    picture = np.zeros((1080, 1920, 4), np.float32)

    def reads(sigma: float) -> int:
        made = graph.add("blur", GaussianBlur(sigma=sigma, edge=edge.name))
        made = made.connect(Port("inputs", "image"), Port("blur", "image"))
        made = made.connect(Port("blur", "out"), Port("outputs", "out"))
        plan = renderer.compile(made, RenderRequest({"image": picture}))
        sizes = [plan.surfaces[one.targets[0]].size for one in plan.passes]
        return sum(w * h * (len(one.weights) or 4) for one, (w, h) in zip(plan.passes, sizes, strict=True))

    assert reads(200.0) <= 1.5 * reads(20.0)


def test_sigma_zero_changes_nothing(run, hdr):
    assert GaussianBlur(sigma=0.0).identity() == GaussianBlur(scale=(0.0, 0.0)).identity() == "image"
    assert GaussianBlur(scale=(0.0, 1.0)).identity() is None
    picture = hdr(13, 11)
    np.testing.assert_array_equal(run(GaussianBlur(sigma=0.0), {"image": picture}), picture)


@pytest.mark.parametrize("sigma", [0.5, 3.0, 20.0])
@pytest.mark.parametrize("hole", [np.nan, np.inf, -np.inf, 2.0**127, -3.4e38])
def test_a_hole_is_skipped(run, hdr, sigma, hole):
    picture = hdr(45, 39)
    picture[20, 22, 1] = hole
    patched = picture.copy()
    patched[20, 22] = 0.0
    found = run(GaussianBlur(sigma=sigma), {"image": picture})
    np.testing.assert_array_equal(found, run(GaussianBlur(sigma=sigma), {"image": patched}))


@pytest.mark.parametrize("sigma", [0.5, 3.0, 20.0])
@pytest.mark.parametrize(("format", "large"), [("float", 3.4e38), ("half", 65504.0)])
def test_large_numbers_of_files_are_skipped_if_their_sum_may_be_infinite(renderer, tmp_path, hdr, sigma, format, large):
    """A file has no holes, but may have numbers that no mean can be made of; halves are all small enough."""
    picture = hdr(45, 39).astype(np.float16).astype(np.float32)
    picture[20:23, 22:30] = large
    expected = picture.copy()
    expected[20:23, 22:30] = 0.0 if large > 2.0**127 else large
    path = write_exr(tmp_path / "picture.exr", {"Combined": picture}, {"Combined": format})
    graph = Graph().add("blur", GaussianBlur(sigma=sigma)).add_input("image", Input(Kind.IMAGE, color_space="data"))
    graph = graph.add_output("out", Output(Kind.IMAGE)).connect(Port("blur", "out"), Port("outputs", "out"))
    graph = graph.connect(Port("inputs", "image"), Port("blur", "image"))
    found, patched = (renderer.render(graph, RenderRequest({"image": item}))["out"] for item in (str(path), expected))
    np.testing.assert_array_equal(found, patched)


@pytest.mark.parametrize("sigma", [0.5, 3.0, 20.0, 80.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_largest_numbers_that_are_no_holes_stay(run, sigma, sign):
    largest = np.float32(sign * np.nextafter(np.float32(2.0**127), np.float32(0.0)))
    picture = np.full((90, 130, 4), largest)
    np.testing.assert_allclose(run(GaussianBlur(sigma=sigma), {"image": picture}), picture, rtol=1e-5)


@pytest.mark.parametrize(("sigma", "tolerance"), [(4.0, 1e-5), (5.0, 1e-4), (10.0, 3e-4), (50.0, 3e-4)])
def test_a_rendered_frame(run, rendered_frame, sigma, tolerance):
    expected = blurred(rendered_frame, sigma, truncate=4.0 if sigma < DIRECT else 6.0)
    error = run(GaussianBlur(sigma=sigma), {"image": rendered_frame}) - expected
    assert np.sqrt((error**2).mean()) <= tolerance * np.sqrt((expected**2).mean())
