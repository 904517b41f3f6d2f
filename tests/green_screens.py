"""Plates before a green or blue screen, whose coverage and colors are known, and the errors of mattes.

The screens are lit unevenly and noisy. The subjects have strands of hair, soft borders and motion blur.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

WIDTH, HEIGHT, SAMPLES = 144, 96, 4
NOISE = 0.008
BACKGROUND = (0.4, 0.25, 0.1)
"""What subjects are put before."""


@dataclass(frozen=True)
class Subject:
    """Who stands before which screen: the colors of its lower and upper half, and how far it moves."""

    screen: tuple[float, float, float]
    unevenness: float
    body: tuple[float, float, float]
    hair: tuple[float, float, float]
    travel: int


GREEN, BLUE = (0.07, 0.48, 0.11), (0.05, 0.12, 0.55)
SUBJECTS = {
    "dark hair": Subject(GREEN, 0.25, (0.55, 0.32, 0.24), (0.05, 0.035, 0.025), 0),
    "blond hair": Subject(GREEN, 0.25, (0.62, 0.42, 0.33), (0.5, 0.36, 0.16), 0),
    "gray cloth": Subject(GREEN, 0.15, (0.3, 0.3, 0.31), (0.6, 0.6, 0.6), 0),
    "moving": Subject(GREEN, 0.25, (0.5, 0.2, 0.2), (0.12, 0.07, 0.05), 10),
    "blue screen": Subject(BLUE, 0.25, (0.6, 0.38, 0.28), (0.3, 0.2, 0.1), 0),
    "moving before blue": Subject(BLUE, 0.35, (0.25, 0.3, 0.2), (0.7, 0.6, 0.45), 8),
}


@dataclass(frozen=True)
class Plate:
    """A picture before a screen, [h, w, 4], and what it is made of: coverage, the subject's color, the screen."""

    picture: np.ndarray
    coverage: np.ndarray
    color: np.ndarray
    screen: np.ndarray
    screen_color: tuple[float, float, float]
    """The mean color of the pixels that the subject does not cover, as the user picks it."""


def draw_coverage(travel: int, seed: int) -> np.ndarray:
    """The coverage of a head with hair: the mean of 4 x 4 samples in a pixel, along the way that it moves."""
    random = np.random.default_rng(seed)
    y, x = (np.mgrid[: HEIGHT * SAMPLES, : WIDTH * SAMPLES] + 0.5) / SAMPLES
    inside = ((x - 72.0) / 27.0) ** 2 + ((y - 44.0) / 30.0) ** 2 < 1.0
    inside |= (np.abs(x - 72.0) < 12.0 + 0.6 * np.maximum(y - 66.0, 0.0)) & (y > 60.0)
    for angle in np.radians(random.uniform(160.0, 380.0, 70)):
        bend, length, width = random.normal(0.0, 0.02), random.uniform(6.0, 18.0), random.uniform(0.3, 0.9)
        along = (x - 72.0) * np.cos(angle) + (y - 44.0) * np.sin(angle) - 25.0
        across = (y - 44.0) * np.cos(angle) - (x - 72.0) * np.sin(angle) - bend * along * along
        inside |= (along > 0.0) & (along < length) & (np.abs(across) < 0.5 * width * (1.0 - along / length / 2.0))
    samples = inside.astype(np.float64)
    if travel:
        samples = ndimage.uniform_filter1d(samples, travel * SAMPLES, axis=1, mode="constant")
    return samples.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES).mean((1, 3))


def make_plate(name: str) -> Plate:
    """The plate of one of SUBJECTS; the same on every call."""
    subject, seed = SUBJECTS[name], sorted(SUBJECTS).index(name)
    random = np.random.default_rng(100 + seed)
    coverage = draw_coverage(subject.travel, seed)
    y, x = np.mgrid[:HEIGHT, :WIDTH] / np.array([HEIGHT, WIDTH]).reshape(2, 1, 1)
    texture = ndimage.gaussian_filter(random.normal(size=(HEIGHT, WIDTH)), 2.0)
    upper = np.clip(4.0 * (0.55 - y), 0.0, 1.0)[..., None]
    color = upper * np.array(subject.hair) + (1.0 - upper) * np.array(subject.body)
    color = color * (1.0 + 0.8 * texture)[..., None]
    light = 1.0 + subject.unevenness * (0.9 - 2.0 * np.hypot(x - 0.35, 0.8 * (y - 0.4)))
    screen = np.array(subject.screen) * light[..., None]
    mixed = coverage[..., None] * color + (1.0 - coverage[..., None]) * screen
    picture = np.ones((HEIGHT, WIDTH, 4), np.float32)
    picture[..., :3] = mixed + random.normal(0.0, NOISE, mixed.shape)
    red, green, blue = picture[coverage == 0.0, :3].astype(np.float64).mean(0)
    return Plate(picture, coverage, color, screen, (float(red), float(green), float(blue)))


def measure_matte(matte: np.ndarray, coverage: np.ndarray) -> tuple[float, float, float]:
    """The errors of a matte by Rhemann et al. 2009: the sum of absolute differences in thousands, the mean squared
    difference, and the squared difference of the gradients of a Gaussian with sigma 1.4, in thousands."""
    difference = matte.astype(np.float64) - coverage
    steepness = [ndimage.gaussian_gradient_magnitude(alpha.astype(np.float64), 1.4) for alpha in (matte, coverage)]
    gradient = np.sum((steepness[0] - steepness[1]) ** 2)
    return float(np.abs(difference).sum() / 1e3), float((difference**2).mean()), float(gradient / 1e3)


def measure_composite(subject: np.ndarray, plate: Plate) -> float:
    """The PSNR, in decibels with a peak of 1, of a premultiplied subject [h, w, 4] over BACKGROUND."""
    background, cover = np.array(BACKGROUND), plate.coverage[..., None]
    composite = subject[..., :3].astype(np.float64) + (1.0 - subject[..., 3:].astype(np.float64)) * background
    error = composite - (cover * plate.color + (1.0 - cover) * background)
    return float(-10.0 * np.log10((error**2).mean()))
