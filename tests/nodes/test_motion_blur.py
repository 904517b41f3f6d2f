"""Motion blur against closed forms and against Cycles with its shutter open."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.lens.motion_blur import MotionBlur
from lens import blender, opaque, psnr
from scipy.ndimage import binary_dilation, binary_erosion, correlate1d, map_coordinates


def motion(width: int, height: int, *velocity: float) -> np.ndarray:
    """The same velocity everywhere; two numbers are the frame after too."""
    return np.broadcast_to(np.float32(velocity * (4 // len(velocity))), (height, width, 4)).copy()


def box(length: float) -> np.ndarray:
    """What of each pixel a box covers that is centered on the middle one, as weights."""
    away = np.abs(np.arange(-40, 41))
    return np.clip(0.5 * length + 0.5 - away, 0.0, min(1.0, length)) / length


def test_what_stands_still_stays(run, hdr):
    picture = hdr(61, 43)
    still = np.zeros((43, 61, 4), np.float32)
    np.testing.assert_array_equal(run(MotionBlur(), {"image": picture, "velocity": still}), picture)
    still[:5, :5] = 30.0
    found = run(MotionBlur(), {"image": picture, "velocity": still, "depth": np.ones((43, 61))})
    np.testing.assert_array_equal(found[20:, 30:], picture[20:, 30:])
    assert MotionBlur(shutter=0.0).identity() == "image" and MotionBlur().identity() is None


@pytest.mark.parametrize("length", [5.0, 11.3, 20.0])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_pan_is_a_box_filter(run, length, axis):
    """On white noise, whatever the depth is."""
    picture = np.random.default_rng(2).random((72, 76, 4)).astype(np.float32)
    velocity = motion(76, 72, *((2.0 * length, 0.0) if axis else (0.0, 2.0 * length)))
    expected = correlate1d(picture.astype(float), box(length), axis)
    inside = slice(12, -12)
    for depth in (np.full((72, 76), 5.0), np.random.default_rng(3).uniform(1.0, 9.0, (72, 76))):
        found = run(MotionBlur(max_length=1.0), {"image": picture, "velocity": velocity, "depth": depth})
        assert np.abs(found - expected)[inside, inside].max() < 2e-6
    found = run(MotionBlur(max_length=1.0), {"image": picture, "velocity": velocity})
    assert np.abs(found - expected)[inside, inside].max() < 2e-6


@pytest.mark.parametrize("angle", [30.0, 45.0, 160.0])
def test_a_pan_in_any_direction_is_a_box_filter(run, angle):
    """Against waves that are integrated along the line in closed form."""
    way = 14.0 * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    y, x = np.mgrid[:64, :64]
    light, expected, bound = np.ones((64, 64)), np.ones((64, 64)), 0.0
    for across, down in ((0.2, 0.13), (-0.1, 0.24), (0.21, -0.2)):
        wave = 0.3 * np.sin(across * x + down * y)
        light += wave
        bound += 0.3 * (across**2 + down**2) / 8.0  # what bilinear interpolation loses at most
        expected += wave * np.sinc((across * way[0] + down * way[1]) / (2.0 * np.pi))
    inputs = {"image": opaque(np.dstack([light] * 3)), "velocity": motion(64, 64, *(2.0 * way))}
    found = run(MotionBlur(max_length=1.0), inputs)
    assert np.abs(found[20:44, 20:44, 0] - expected[20:44, 20:44]).max() < bound < 0.01


@pytest.mark.parametrize("width", [9, 30])
def test_a_moving_bar_is_a_trapezoid(run, width):
    """It covers each place for as long as it is there."""
    length, first = 16.0, 35
    picture, velocity = np.zeros((20, 100, 4), np.float32), np.zeros((20, 100, 4), np.float32)
    depth = np.full((20, 100), 10.0, np.float32)
    bar = slice(first, first + width)
    picture[:, bar], velocity[:, bar, 0::2], depth[:, bar] = 1.0, 2.0 * length, 5.0
    found = run(MotionBlur(max_length=1.0), {"image": picture, "velocity": velocity, "depth": depth})
    expected = correlate1d(picture[0, :, 0].astype(float), box(length), mode="nearest")
    assert np.abs(found - expected[None, :, None]).max() < 1e-5


def test_what_stands_before_a_pan_stays_sharp(run):
    rng = np.random.default_rng(4)
    picture, velocity, depth = rng.random((30, 90, 4)), motion(90, 30, 24.0, 0.0), np.full((30, 90), 1e10)
    post = slice(40, 50)
    velocity[:, post], depth[:, post] = 0.0, 2.0
    found = run(MotionBlur(max_length=1.0), {"image": picture, "velocity": velocity, "depth": depth})
    np.testing.assert_array_equal(found[:, post], picture[:, post].astype(np.float32))
    changed = picture.copy()
    changed[:, post] = 100.0
    again = run(MotionBlur(max_length=1.0), {"image": changed, "velocity": velocity, "depth": depth})
    np.testing.assert_array_equal(np.delete(found, np.r_[post], 1), np.delete(again, np.r_[post], 1))


@pytest.mark.parametrize(("phase", "middle"), [("start", 6.0), ("end", -6.0), ("centered", 0.0)])
def test_the_phase_is_when_the_shutter_opens(run, phase, middle):
    picture = np.zeros((21, 81, 4), np.float32)
    picture[:, 40] = 1.0
    found = run(MotionBlur(phase=phase, max_length=1.0), {"image": picture, "velocity": motion(81, 21, 24.0, 0.0)})[
        10, :, 0
    ].astype(float)
    x = np.arange(81) - 40
    assert found.sum() == pytest.approx(1.0, abs=1e-5) and (found * x).sum() == pytest.approx(middle, abs=1e-4)
    assert (found * (x - middle) ** 2).sum() == pytest.approx(12.0**2 / 12.0, rel=0.02)


def test_paths_are_parabolas(run):
    """Light lies on the curve through the places before, now and after, and nowhere else."""
    picture = np.zeros((61, 61, 4), np.float32)
    picture[30, 30] = 1.0
    velocity = motion(61, 61, 16.0, 12.0, 16.0, -12.0)
    node = MotionBlur(shutter=720.0, max_length=1.0)
    found = run(node, {"image": picture, "velocity": velocity})[..., 0]
    y, x = np.nonzero(found > 1e-3)
    times = np.linspace(-1.0, 1.0, 400)
    curve = np.stack([30.0 + 16.0 * times, 30.0 - 12.0 * times**2], -1)
    away = np.linalg.norm(np.stack([x, y], -1)[:, None] - curve, axis=-1)
    assert away.min(1).max() < 1.0 and away.min(0).max() < 1.0
    straight = run(MotionBlur(shutter=720.0, max_length=1.0, path="straight"), {"image": picture, "velocity": velocity})
    ahead = motion(61, 61, 16.0, 12.0)
    np.testing.assert_array_equal(straight, run(node, {"image": picture, "velocity": ahead}))
    ahead[..., 2:] = 0.0
    np.testing.assert_array_equal(straight, run(node, {"image": picture, "velocity": ahead}))


def test_long_paths_are_shortened(run):
    picture = np.zeros((40, 121, 4), np.float32)
    picture[:, 60] = 1.0
    found = run(MotionBlur(max_length=0.5), {"image": picture, "velocity": motion(121, 40, 500.0, 0.0)})[20, :, 0]
    np.testing.assert_allclose(found, correlate1d(picture[20, :, 0].astype(float), box(20.0)), atol=1e-6)


def test_fewer_samples_keep_the_mean(run):
    picture = np.random.default_rng(5).random((40, 120, 4)).astype(np.float32)
    inputs = {"image": picture, "velocity": motion(120, 40, 60.0, 0.0)}
    full, few = (run(MotionBlur(max_length=1.0, samples=samples), inputs) for samples in (64, 8))
    assert np.abs(full - few).max() > 0.01
    assert np.abs((full - few)[:, 20:-20].mean()) < 2e-3


def naive(picture: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Every pixel blurred along its own velocity, whatever passes by."""
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    times = ((np.arange(32) + 0.5) / 32 - 0.5) * 0.5
    return np.mean(
        [
            [
                map_coordinates(
                    picture[..., c], [y - t * velocity[..., 1], x - t * velocity[..., 0]], order=1, mode="nearest"
                )
                for c in range(3)
            ]
            for t in times
        ],
        0,
    ).transpose(1, 2, 0)


@pytest.mark.parametrize("samples", [64, 8])
def test_cycles_with_its_shutter_open(run, samples):
    """A cube flies by before a wall, a ball across; in the bands outside and inside of what moves, too."""
    data = blender()
    picture, expected = opaque(data["motion_image"]), data["motion_blurred"]
    velocity, depth = data["motion_velocity"] * (-1.0, 1.0, -1.0, 1.0), data["motion_depth"]
    found = run(MotionBlur(samples=samples), {"image": picture, "velocity": velocity, "depth": depth})
    moving = np.abs(velocity[..., :2]).max(-1) > 0.01
    outer, inner = binary_dilation(moving, iterations=5) & ~moving, moving & ~binary_erosion(moving, iterations=5)
    plain, cube = naive(picture, velocity), np.arange(picture.shape[1]) >= 95
    assert psnr(found, expected) > 47.9 > 38.0 > psnr(plain, expected)
    assert psnr(found, expected, outer) > 47.5 and psnr(found, expected, inner) > 38.5 > psnr(plain, expected, inner)
    assert psnr(found, expected, outer & cube) > 50.0 and psnr(found, expected, inner & cube) > 42.0


def test_cycles_with_a_camera_that_moves_too(run):
    """A box turns and a ball rolls by over fine tiles, on bent paths. Finer pictures come nearer: 44 dB at three times
    the size, averaged."""
    data = blender("travel")
    picture, expected = opaque(data["travel_image"]), data["travel_blurred"]
    velocity, depth = data["travel_velocity"] * (-1.0, 1.0, -1.0, 1.0), data["travel_depth"]
    found = run(MotionBlur(), {"image": picture, "velocity": velocity, "depth": depth})
    jumps = [np.ptp(np.stack([np.roll(1.0 / depth, step, axis), 1.0 / depth]), 0) for axis, step in ((0, 1), (1, 1))]
    edge = (np.maximum(*jumps) > 0.1 / depth) & (np.minimum(np.indices(depth.shape)[0], np.indices(depth.shape)[1]) > 0)
    band, plain = binary_dilation(edge, iterations=5), naive(picture, velocity)
    assert psnr(found, expected) > 39.9 > 36.5 > psnr(plain, expected)
    assert psnr(found, expected, band) > 36.0 > 32.0 > psnr(plain, expected, band)


def test_antialiased_edges_are_pieces_of_what_is_in_front(run):
    """A bar that covers parts of pixels, over another that stands still, with light and velocity filtered alike: the
    same as a far finer picture, averaged."""
    fine, length, width = 16, 12.0, 70
    x = (np.arange(width * fine) + 0.5) / fine
    bar = (x > 25.3) & (x < 41.85)
    ground = 0.5 + 0.02 * np.floor(x)
    light, velocity = np.where(bar, 2.0, ground), np.where(bar, 2.0 * length, 0.0)
    coarse = [one.reshape(width, fine).mean(1) for one in (light, velocity)]
    times = (np.arange(960) + 0.5) / 960 - 0.5
    covered = np.mean([(x - t * length > 25.3) & (x - t * length < 41.85) for t in times], 0)
    expected = (2.0 * covered + ground * (1.0 - covered)).reshape(width, fine).mean(1)
    depth = np.where(bar.reshape(width, fine)[:, fine // 2], 3.0, 9.0)
    rows = np.ones((15, 1))
    motion = np.zeros((15, width, 4))
    motion[..., 0::2] = (rows * coarse[1])[..., None]
    inputs = {"image": opaque(np.dstack([rows * coarse[0]] * 3)), "velocity": motion, "depth": rows * depth}
    found = run(MotionBlur(max_length=1.0), inputs)[7, :, 0]
    assert np.abs(found - expected).max() < 0.03


def test_bent_paths_are_integrals_along_parabolas(run):
    """Waves summed along the curve through the places before, now and after."""
    times = (np.arange(4000) + 0.5) / 4000 - 0.5
    before, after = np.array([18.0, 9.0]), np.array([14.0, -12.0])
    place = 0.5 * times[:, None] * (before + after + times[:, None] * (after - before))
    y, x = np.mgrid[:64, :64]
    light, expected = np.ones((64, 64)), np.ones((64, 64))
    for across, down in ((0.2, 0.13), (-0.1, 0.24), (0.21, -0.2)):
        light += 0.3 * np.sin(across * x + down * y)
        expected += 0.3 * np.mean([np.sin(across * (x - dx) + down * (y - dy)) for dx, dy in place[::8]], 0)
    inputs = {"image": opaque(np.dstack([light] * 3)), "velocity": motion(64, 64, *before, *after)}
    found = run(MotionBlur(shutter=360.0, max_length=1.0), inputs)
    error = (found[..., 0] - expected)[20:44, 20:44]
    assert np.abs(error).max() < 0.004 and np.sqrt((error**2).mean()) < 0.0015


def test_half_size_moves_half_as_many_pixels(run):
    y, x = np.mgrid[:60, :80]
    light = 1.0 + np.sin(0.2 * x) * np.cos(0.15 * y)
    inputs = {"image": opaque(np.dstack([light] * 3)), "velocity": motion(80, 60, 30.0, 10.0)}
    full, half = (run(MotionBlur(max_length=1.0), inputs, scale=scale) for scale in (1.0, 0.5))
    assert np.abs(half - full.reshape(30, 2, 40, 2, 4).mean((1, 3)))[8:-8, 8:-8].max() < 0.02
