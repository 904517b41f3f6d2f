"""The keyer against its formula in 64 bits, and against Blender's Keying node on plates of known coverage."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from commands import make_cli
from green_screens import NOISE, SUBJECTS, make_plate, measure_composite, measure_matte
from halation.nodes.matte.difference_key import DifferenceKey
from halation.nodes.matte.keyer import Keyer
from halation.nodes.matte.screen_clean_plate import ScreenCleanPlate
from scipy import ndimage

BLENDER = Path(__file__).parents[1] / "data" / "blender_keying.npz"

SETTINGS = {
    "dark hair": {"balance": 0.25, "black": 0.06, "white": 0.9},
    "blond hair": {"balance": 0.5, "black": 0.03, "white": 0.9},
    "gray cloth": {"balance": 0.25, "black": 0.06, "white": 0.9},
    "moving": {"balance": 0.0, "black": 0.03, "white": 1.0, "soften": 0.3},
    "blue screen": {"balance": 0.25, "black": 0.06, "white": 1.2},
    "moving before blue": {"balance": 1.0, "black": 0.03, "white": 1.2, "soften": 0.3},
}
"""How a user would set the keyer for each plate."""


@pytest.mark.parametrize("name", SUBJECTS)
def test_mattes_are_closer_to_the_truth_than_blenders(run, name):
    """SAD, MSE and gradient error (Rhemann et al. 2009) against the best that Blender 5.0.1 reaches with any of 480
    settings, chosen for each error alone: see tests/data/make_blender_keying.py."""
    plate = make_plate(name)
    screen = (*plate.screen_color, 1.0)
    clean = run(ScreenCleanPlate(screen=screen), {"image": plate.picture})
    inputs = {"image": plate.picture, "clean_plate": clean}
    matte = run(Keyer(screen=screen, **SETTINGS[name]), inputs, output="matte")[..., 0]
    errors, limits = measure_matte(matte, plate.coverage), np.load(BLENDER)[name]
    assert (np.array(errors) < limits).all(), errors / limits


@pytest.mark.parametrize("name", SUBJECTS)
def test_composites_are_closer_to_the_truth_than_blenders(run, name):
    """Over a new background, without spill, by PSNR: against the best of Blender's 480 mattes with each of 25 despills,
    with the setting that the mattes above have. The error is not far above the noise of the plate."""
    plate = make_plate(name)
    screen = (*plate.screen_color, 1.0)
    clean = run(ScreenCleanPlate(screen=screen), {"image": plate.picture})
    out = run(Keyer(screen=screen, **SETTINGS[name]), {"image": plate.picture, "clean_plate": clean})
    decibels = measure_composite(out, plate)
    assert decibels > np.load(BLENDER)[f"{name} composite"] + 4.0
    assert decibels > -20.0 * np.log10(3.0 * NOISE)


@pytest.mark.parametrize("name", SUBJECTS)
def test_a_clean_plate_is_the_screen(run, name):
    """Compared with one color for the whole screen."""
    plate = make_plate(name)
    clean = run(ScreenCleanPlate(screen=(*plate.screen_color, 1.0)), {"image": plate.picture})[..., :3]
    error = np.abs(clean - plate.screen)
    assert error.mean() < 0.4 * np.abs(np.array(plate.screen_color) - plate.screen).mean()
    assert error[plate.coverage == 0.0].mean() < 0.5 * NOISE


def test_a_picture_without_a_screen_gets_its_color(run):
    gray = np.full((20, 30, 4), (0.3, 0.3, 0.3, 1.0), np.float32)
    clean = run(ScreenCleanPlate(screen=(0.1, 0.5, 0.2, 1.0)), {"image": gray})
    np.testing.assert_allclose(clean, np.broadcast_to(np.float32((0.1, 0.5, 0.2, 1.0)), clean.shape), atol=1e-6)


def excess(rgb: np.ndarray, balance: float) -> np.ndarray:
    """How far green exceeds a mix of the other two channels."""
    low, high = np.minimum(rgb[..., 0], rgb[..., 2]), np.maximum(rgb[..., 0], rgb[..., 2])
    return rgb[..., 1] - (1.0 - balance) * low - balance * high


def key_plainly(node: Keyer, inputs: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """The subject and its matte, by NumPy and scipy."""
    image, plate = inputs["image"].astype(np.float64), inputs["clean_plate"].astype(np.float64)
    matte = 1.0 - excess(image[..., :3], node.balance) / excess(plate[..., :3], node.balance)
    matte = np.clip((matte - node.black) / (node.white - node.black), 0.0, 1.0)
    y, x = np.mgrid[-2:3, -2:3]
    matte = ndimage.grey_erosion(matte, footprint=x * x + y * y <= 4, mode="nearest")
    cover = np.maximum(matte, inputs["core"]) * (1.0 - inputs["garbage"])
    subject = image[..., :3] - (1.0 - cover)[..., None] * plate[..., :3]
    subject[..., 1] -= node.spill * np.maximum(excess(subject, node.spill_balance), 0.0)
    subject = np.where(cover[..., None] > 0.0, np.maximum(subject, 0.0), 0.0)
    return np.concatenate([subject, (cover * image[..., 3])[..., None]], -1), cover * image[..., 3]


def test_all_settings_are_their_formula(run):
    random = np.random.default_rng(5)
    image = random.random((24, 31, 4)).astype(np.float32)
    plate = np.empty_like(image)
    plate[:] = (0.1, 0.6, 0.2, 1.0)
    plate[..., 1] += 0.2 * random.random((24, 31))
    core, garbage = (np.maximum(random.random((24, 31)) * 4.0 - 3.0, 0.0).astype(np.float32) for _ in range(2))
    inputs = {"image": image, "clean_plate": plate, "core": core, "garbage": garbage}
    node = Keyer(balance=0.3, black=0.1, white=1.3, shrink=2.0, spill=0.7, spill_balance=0.9)
    subject, matte = key_plainly(node, inputs)
    assert np.ptp(matte) > 0.5
    np.testing.assert_allclose(run(node, inputs, output="matte")[..., 0], matte, atol=1e-5)
    np.testing.assert_allclose(run(node, inputs), subject, atol=2e-5)


@pytest.mark.parametrize(("key", "screen"), [(0, (0.7, 0.1, 0.2)), (1, (0.1, 0.5, 0.2)), (2, (0.05, 0.1, 0.6))])
def test_a_white_above_one_recovers_colors_opposite_to_the_screen(run, key, screen):
    """A subject whose channel of the screen is below the others looks too solid where it is thin: by a factor that
    white takes back."""
    cover = np.linspace(0.0, 1.0, 41)[None, :, None]
    subject = np.full(3, 0.6)
    subject[key] = 0.2
    picture = np.ones((1, 41, 4), np.float32)
    picture[..., :3] = cover * subject + (1.0 - cover) * np.array(screen)
    others = np.delete(np.array(screen), key)
    white = 1.0 + 0.4 / (screen[key] - others.min())
    # Compared with the smaller channel of the screen, which is the smaller one of every mix as well.
    node = Keyer(screen=(*screen, 1.0), balance=0.0, white=white)
    matte = run(node, {"image": picture}, output="matte")[..., 0]
    np.testing.assert_allclose(matte, cover[..., 0], atol=1e-5)


def test_mattes_get_softer_and_larger(run):
    picture = np.full((40, 40, 4), (0.06, 0.5, 0.1, 1.0), np.float32)
    picture[10:30, 10:30, :3] = 0.3
    hard = run(Keyer(), {"image": picture}, output="matte")[..., 0]
    np.testing.assert_allclose(hard[10:30, 10:30], 1.0, atol=1e-6)
    larger = run(Keyer(shrink=-3.0), {"image": picture}, output="matte")[..., 0]
    y, x = np.mgrid[-3:4, -3:4]
    disc = x * x + y * y <= 9
    np.testing.assert_allclose(larger, ndimage.grey_dilation(hard, footprint=disc, mode="nearest"), atol=1e-5)
    soft = run(Keyer(soften=2.0), {"image": picture}, output="matte")[..., 0]
    np.testing.assert_allclose(soft, ndimage.gaussian_filter(hard, 2.0, mode="nearest"), atol=2e-3)


@pytest.mark.parametrize("measure", ["average", "largest", "distance"])
def test_a_difference_is_its_formula(run, measure):
    """The average is what Blender's Difference Key node computes."""
    random = np.random.default_rng(6)
    image, plate = (random.random((9, 14, 4)).astype(np.float32) for _ in range(2))
    apart = np.abs(image[..., :3].astype(np.float64) - plate[..., :3])
    reduced = {"average": apart.mean(-1), "largest": apart.max(-1), "distance": np.linalg.norm(apart, axis=-1)}[measure]
    cover = np.clip((reduced - 0.2) / 0.3, 0.0, 1.0)
    node = DifferenceKey(measure=measure, tolerance=0.2, falloff=0.3)
    inputs = {"image": image, "clean_plate": plate}
    np.testing.assert_allclose(run(node, inputs), cover[..., None] * image, atol=1e-6)
    np.testing.assert_allclose(run(node, inputs, output="matte")[..., 0], cover * image[..., 3], atol=1e-6)


def test_a_clean_plate_takes_few_passes(capfd):
    """Four for each of eight sizes down to a pixel: with the exact solution there were 200."""
    passes = make_cli(capfd)("explain", "green_screen", "--size", "256x144", "--json").json["passes"]
    drawn = [step for step in passes if any("diffusion" in name for name in step["functions"])]
    assert 16 < len(drawn) <= 4 * 8
