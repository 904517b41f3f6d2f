"""Difference of Gaussians against the published formula with scipy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.edge.difference_of_gaussians import DifferenceOfGaussians
from scipy.ndimage import gaussian_filter, map_coordinates, sobel
from scipy.special import ndtr


def encoded(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decoded(code: np.ndarray) -> np.ndarray:
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def blurs(picture: np.ndarray, sigma: float, ratio: float, mode: str) -> tuple[np.ndarray, np.ndarray]:
    straight = picture[..., :3].astype(np.float64) / picture[..., 3:]
    tone = encoded(straight @ [0.2126, 0.7152, 0.0722])
    return gaussian_filter(tone, sigma, mode=mode), gaussian_filter(tone, sigma * ratio, mode=mode)


@pytest.mark.parametrize("size", [(37, 22), (5, 1)])
@pytest.mark.parametrize(("sigma", "ratio", "p"), [(1.0, 1.6, 20.0), (2.2, 3.0, 4.0)])
def test_xdog_equals_the_paper(run, hdr, edge, size, sigma, ratio, p):
    picture = hdr(*size)
    picture[..., 3] = picture[..., 3] * 0.9 + 0.1
    fine, coarse = blurs(picture, sigma, ratio, edge.scipy)
    sharp = (1.0 + p) * fine - p * coarse
    expected = np.where(sharp >= 0.7, 1.0, 1.0 + np.tanh(0.8 * (sharp - 0.7)))
    node = DifferenceOfGaussians(sigma=sigma, ratio=ratio, strength=p, epsilon=0.7, phi=0.8, edge=edge.name)
    found = run(node, {"image": picture}, output="value")[..., 0]
    assert np.abs(found - expected).max() <= 1e-5 * max(1.0, float(np.abs(sharp).max()))
    ink = run(node, {"image": picture})
    np.testing.assert_allclose(ink[..., 0], decoded(found) * picture[..., 3], rtol=1e-5, atol=1e-6)
    np.testing.assert_array_equal(ink[..., 3], picture[..., 3])


@pytest.mark.parametrize(("sigma", "ratio"), [(1.0, 1.6), (3.0, 2.0)])
def test_dog_is_the_difference(run, hdr, edge, sigma, ratio):
    picture = hdr(33, 20, opaque=True)
    fine, coarse = blurs(picture, sigma, ratio, edge.scipy)
    node = DifferenceOfGaussians(kind="dog", sigma=sigma, ratio=ratio, strength=2.0, edge=edge.name)
    found = run(node, {"image": picture})
    expected = 2.0 * (fine - coarse)
    for channel in range(3):
        assert np.abs(found[..., channel] - expected).max() <= 1e-5 * float(fine.max())


def test_a_flat_picture_is_paper_or_ink(run):
    for light, expected in ((0.5, 1.0), (0.001, 0.0)):
        flat = np.full((9, 12, 4), light, np.float32)
        flat[..., 3] = 1.0
        found = run(DifferenceOfGaussians(phi=50.0, epsilon=0.5), {"image": flat})
        np.testing.assert_allclose(found[..., :3], expected, atol=1e-5)
        found = run(DifferenceOfGaussians(kind="dog", sigma=6.0), {"image": flat})
        np.testing.assert_allclose(found[..., :3], 0.0, atol=2e-5)


def test_turning_the_picture_turns_the_lines(run, hdr):
    picture = hdr(19, 19, opaque=True)
    still, turned = (
        run(DifferenceOfGaussians(), {"image": view.copy()}, output="value") for view in (picture, np.rot90(picture))
    )
    np.testing.assert_allclose(turned, np.rot90(still), atol=1e-4)


def tone_picture(tone: np.ndarray) -> np.ndarray:
    """A gray picture that shows these tones."""
    picture = np.ones((*tone.shape, 4), np.float32)
    picture[..., :3] = decoded(np.asarray(tone, np.float64))[..., None]
    return picture


def across_of(tensor: np.ndarray) -> np.ndarray:
    """The eigenvector of the larger eigenvalue of [..., (xx, xy, yy)]; 0 where there is none."""
    values, vectors = np.linalg.eigh(tensor[..., [0, 1, 1, 2]].reshape(*tensor.shape[:-1], 2, 2))
    return np.where(values[..., 1:] - values[..., :1] > 1e-12, vectors[..., 1], 0.0)


class Flow:
    """Flow-guided blurs in 64 bits, of all pixels at once; what lies outside is laid out around the picture."""

    def __init__(self, tone: np.ndarray, smoothing: float, edge, around: int = 30):
        self.size, self.around, self.edge, self.tone = tone.shape, around, edge, tone
        x, y = (sobel(tone, axis, mode=edge.scipy) / 4.0 for axis in (1, 0))
        self.tensor = [gaussian_filter(one, smoothing, mode=edge.scipy) for one in (x * x, x * y, y * y)]

    def wide(self, plane: np.ndarray) -> np.ndarray:
        return np.pad(plane, self.around, mode=self.edge.numpy)

    def read(self, plane: np.ndarray, at: np.ndarray) -> np.ndarray:
        """At positions [y, x, (x, y)], where pixel centers are whole."""
        return map_coordinates(self.wide(plane), (at + self.around).transpose(2, 0, 1)[::-1], order=1)

    def across(self, at: np.ndarray) -> np.ndarray:
        return across_of(np.stack([self.read(one, at) for one in self.tensor], axis=-1))

    def blurs(self, sigma: float, ratio: float, stroke: float) -> list[np.ndarray]:
        here = np.stack(np.mgrid[: self.size[0], : self.size[1]][::-1], axis=-1).astype(np.float64)
        across, planes = self.across(here), []
        for width in (sigma, ratio * sigma):
            away = np.arange(1, int(3.0 * ratio * sigma + 0.5) + 1)
            weights = np.exp(-0.5 * (away / width) ** 2)
            pairs = [self.read(self.tone, here + i * across) + self.read(self.tone, here - i * across) for i in away]
            planes.append((self.tone + np.tensordot(weights, pairs, 1)) / (1.0 + 2.0 * weights.sum()))
        sums, total = [plane.copy() for plane in planes], 1.0
        for side in (-1.0, 1.0):
            at, way = here, side * self.along(across)
            for i in range(1, int(3.0 * stroke + 0.5) + 1):
                way = self.onward(at + 0.5 * way, way)
                at, weight = at + way, np.exp(-0.5 * (i / stroke) ** 2)
                sums = [one + weight * self.read(plane, at) for one, plane in zip(sums, planes, strict=True)]
                total += weight
        return [one / total for one in sums]

    @staticmethod
    def along(across: np.ndarray) -> np.ndarray:
        return np.stack([-across[..., 1], across[..., 0]], axis=-1)

    def onward(self, at: np.ndarray, before: np.ndarray) -> np.ndarray:
        along = self.along(self.across(at))
        along = np.where((along * before).sum(-1, keepdims=True) < 0.0, -along, along)
        return np.where((along == 0.0).all(-1, keepdims=True), before, along)


def wavy(height: int, width: int) -> np.ndarray:
    """Tones whose lines bend without ends or crossings, so that no rounding sends a line elsewhere."""
    y, x = np.mgrid[:height, :width]
    return 0.5 + 0.4 * np.sin(0.45 * x + 0.28 * y + 0.9 * np.sin(0.11 * x - 0.13 * y))


@pytest.mark.parametrize(("sigma", "ratio", "smoothing", "stroke"), [(1.0, 1.6, 2.5, 3.0), (1.7, 2.0, 1.0, 5.0)])
def test_guided_by_the_flow_it_equals_the_formula(run, edge, sigma, ratio, smoothing, stroke):
    tone = wavy(19, 26)
    fine, coarse = Flow(tone, smoothing, edge).blurs(sigma, ratio, stroke)
    node = DifferenceOfGaussians(
        kind="dog",
        guide="flow",
        sigma=sigma,
        ratio=ratio,
        smoothing=smoothing,
        stroke=stroke,
        strength=1.0,
        edge=edge.name,
    )
    found = run(node, {"image": tone_picture(tone)}, output="value")[..., 0]
    assert np.abs(fine - coarse).max() > 0.05
    np.testing.assert_allclose(found, fine - coarse, atol=2e-6)


@pytest.mark.parametrize("angle", [0.0, 17.0, 45.0, 62.0, 90.0])
def test_across_a_straight_edge_it_is_the_difference_of_two_edges(run, angle):
    """A Gaussian edge, blurred across by a Gaussian, is one again; blurred along, it stays."""
    y, x = np.mgrid[:44, :44] - 21.6
    away = x * np.cos(np.radians(angle)) + y * np.sin(np.radians(angle))
    tone = 0.1 + 0.8 * ndtr(away / 3.0)
    node = DifferenceOfGaussians(kind="dog", guide="flow", sigma=1.5, ratio=2.0, strength=1.0, stroke=2.0)
    found = run(node, {"image": tone_picture(tone)}, output="value")[12:32, 12:32, 0]
    sigmas = [np.hypot(3.0, one) for one in (1.5, 3.0)]
    expected = 0.8 * (ndtr(away / sigmas[0]) - ndtr(away / sigmas[1]))[12:32, 12:32]
    # Cut at 3 sigma; and where it is slanted, read between pixels.
    assert np.abs(found - expected).max() <= (5e-4 if angle % 90.0 == 0.0 else 1.5e-3)


def test_without_bends_it_equals_the_round_blurs(run):
    """Where the picture changes one way only, blurring the other way does nothing. The line blurs end at 3 sigma."""
    row = np.random.default_rng(5).random(31)
    tone = np.tile(0.2 + 0.6 * row, (14, 1))
    for turn in (tone, tone.T):
        round_, flow = (
            run(DifferenceOfGaussians(kind="dog", guide=guide, strength=1.0), {"image": tone_picture(turn)})[..., 0]
            for guide in ("none", "flow")
        )
        assert np.abs(round_).max() > 0.05
        np.testing.assert_allclose(flow, round_, atol=2e-4)


@pytest.mark.parametrize("stroke", [2.0, 10.0])
def test_lines_are_followed_around_bends(run, stroke):
    """All is alike along circles: drawing together along them changes no more than reading between pixels does."""
    y, x = np.mgrid[:96, :96] - 47.5
    tone = 0.5 + 0.4 * np.sin(0.25 * np.hypot(x, y))
    still, drawn = (
        run(DifferenceOfGaussians(kind="dog", guide="flow", sigma=2.0, stroke=s), {"image": tone_picture(tone)})[..., 0]
        for s in (0.0, stroke)
    )
    ring = (np.hypot(x, y) > 8.0) & (np.hypot(x, y) < 40.0)
    assert np.abs(drawn - still)[ring].max() <= 0.01 * np.abs(still).max()


def test_strokes_calm_a_noisy_line(run):
    tone = np.where(np.abs(np.mgrid[:48, :48][1] - 23.5) < 2.0, 0.2, 0.8)
    noisy = tone_picture(tone + 0.1 * np.random.default_rng(3).standard_normal(tone.shape))
    spread = [
        run(DifferenceOfGaussians(kind="dog", guide="flow", strength=1.0, stroke=stroke), {"image": noisy})[
            8:40, 22:26, 0
        ]
        .std(0)
        .max()
        for stroke in (0.0, 2.0, 6.0)
    ]
    assert spread[0] > 1.5 * spread[1] > 1.5 * 1.2 * spread[2]


@pytest.mark.parametrize("turn", [np.rot90, np.fliplr, np.flipud])
def test_turning_the_picture_turns_the_strokes(run, turn):
    tone = wavy(24, 24)
    node = DifferenceOfGaussians(guide="flow")
    still, turned = (
        run(node, {"image": np.ascontiguousarray(one)}, output="value")
        for one in (tone_picture(tone), turn(tone_picture(tone)))
    )
    np.testing.assert_allclose(turned, turn(still), atol=2e-5)


def test_where_nothing_changes_nothing_is_drawn(run):
    flat = tone_picture(np.full((9, 11), 0.6))
    found = run(DifferenceOfGaussians(kind="dog", guide="flow", strength=50.0), {"image": flat}, output="value")
    np.testing.assert_allclose(found, 0.0, atol=1e-5)
