"""Luminance statistics against numpy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.measure.luminance_statistics import LuminanceStatistics

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
NAMES = ("average", "log_average", "maximum", "minimum")


def measured(run, node: LuminanceStatistics, picture: np.ndarray) -> dict[str, float]:
    found = {name: run(node, {"image": picture}, output=name) for name in NAMES}
    assert all(value.size == 1 for value in found.values())
    return {name: float(value.item()) for name, value in found.items()}


def expected(light: np.ndarray, delta: float = 1e-5, weight: np.ndarray | None = None) -> dict[str, float]:
    light = light.astype(np.float64).ravel()
    weight = np.ones_like(light) if weight is None else weight.astype(np.float64).ravel()
    return {
        "average": np.average(light, weights=weight),
        "log_average": np.exp(np.average(np.log(delta + np.maximum(light, 0.0)), weights=weight)),
        "maximum": light[weight > 0.0].max(),
        "minimum": light[weight > 0.0].min(),
    }


def luminance(picture: np.ndarray) -> np.ndarray:
    return picture[..., :3].astype(np.float64) @ WEIGHTS


@pytest.mark.parametrize(
    "size", [(1, 1), (2, 1), (3, 5), (16, 16), (17, 15), (241, 135), (256, 257), (4097, 3), (3, 4097), (1000, 563)]
)
def test_every_pixel_counts_once(run, hdr, size):
    picture = hdr(*size, opaque=True)
    assert measured(run, LuminanceStatistics(), picture) == pytest.approx(expected(luminance(picture)), rel=1e-5)


def test_the_last_pixel_counts_as_much_as_the_first(run):
    for place in ((0, 0), (134, 240), (0, 240), (134, 0), (67, 33)):
        picture = np.zeros((135, 241, 4), np.float32)
        picture[place] = 1000.0
        assert measured(run, LuminanceStatistics(), picture)["average"] == pytest.approx(1000.0 / (241 * 135), rel=1e-5)


@pytest.mark.parametrize("delta", [1e-7, 1e-5, 1e-4, 1e-2])
def test_delta_bounds_what_black_weighs(run, hdr, delta):
    picture = hdr(97, 61, opaque=True)
    picture[:30] = 0.0
    node = LuminanceStatistics(delta=delta)
    assert measured(run, node, picture) == pytest.approx(expected(luminance(picture), delta), rel=1e-5)


def test_holes_are_left_out(run, hdr):
    picture = hdr(71, 53, opaque=True)
    kept = np.ones(picture.shape[:2], bool)
    for place, hole in (((0, 0), np.nan), ((52, 70), np.inf), ((20, 33), -np.inf), ((31, 5), np.nan)):
        picture[place][place[0] % 4] = hole
        kept[place] = False
    assert measured(run, LuminanceStatistics(), picture) == pytest.approx(expected(luminance(picture[kept])), rel=1e-5)


def test_a_picture_of_holes_measures_zero(run):
    nothing = np.full((5, 7, 4), np.nan, np.float32)
    assert measured(run, LuminanceStatistics(), nothing) == dict.fromkeys(NAMES, 0.0)


def test_alpha_weighting_ignores_what_is_empty(run, hdr):
    picture = hdr(83, 47)
    picture[:, :40, 3] = 0.0
    alpha = picture[..., 3:].astype(np.float64)
    straight = luminance(picture[..., :3] / np.where(alpha > 0.0, alpha, 1.0))
    found = measured(run, LuminanceStatistics(alpha_weighted=True), picture)
    assert found == pytest.approx(expected(straight, weight=alpha), rel=1e-5)
    empty = np.zeros((4, 4, 4), np.float32)
    assert measured(run, LuminanceStatistics(alpha_weighted=True), empty) == dict.fromkeys(NAMES, 0.0)


def test_negative_light_counts_in_the_average_and_is_black_to_the_logarithm(run, hdr):
    picture = hdr(33, 21, opaque=True)
    picture[5:9, :, :3] *= -0.3
    assert measured(run, LuminanceStatistics(), picture) == pytest.approx(expected(luminance(picture)), rel=1e-5)


def test_a_rendered_frame(run, rendered_frame):
    assert rendered_frame[..., :3].max() > 100.0
    for picture in (rendered_frame, rendered_frame[:-3, 5:].copy()):
        assert measured(run, LuminanceStatistics(), picture) == pytest.approx(expected(luminance(picture)), rel=1e-5)


def test_a_measurement_drives_a_value(run, hdr):
    picture = hdr(41, 37, opaque=True)
    graph = Graph().add_input("image", Input(Kind.IMAGE)).add_output("out", Output(Kind.IMAGE))
    graph = graph.add("measure", LuminanceStatistics()).add("exposure", Exposure())
    for source, target in (
        ("inputs.image", "measure.image"),
        ("inputs.image", "exposure.image"),
        ("measure.log_average", "exposure.stops"),
        ("exposure.out", "outputs.out"),
    ):
        graph = graph.connect(Port.parse(source), Port.parse(target))
    factor = 2.0 ** expected(luminance(picture))["log_average"]
    np.testing.assert_allclose(run(graph, {"image": picture})[..., :3], picture[..., :3] * factor, rtol=1e-5)
