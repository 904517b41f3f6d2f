"""Constant, Ramp and Checker against closed forms and OpenImageIO."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.input.checker import Checker
from halation.nodes.input.constant import Constant
from halation.nodes.input.ramp import Ramp

RED, BLUE = (1.0, 0.25, 0.0, 1.0), (0.0, 0.5, 4.0, 0.5)


def oiio_canvas(width: int, height: int) -> oiio.ImageBuf:
    return oiio.ImageBuf(oiio.ImageSpec(width, height, 4, "float"))


def centers(width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    y, x = np.mgrid[:height, :width] + 0.5
    return x, y


def test_constant_fills_the_canvas(run):
    out = run(Constant(color=BLUE), size=(7, 5))
    assert out.shape == (5, 7, 4)
    assert np.all(out == np.array(BLUE, np.float32))


def test_linear_ramp_is_the_gradient_of_openimageio(run):
    width, height = 33, 4
    ends = Ramp(start=(0.5 / width, 0.5), end=(1 - 0.5 / width, 0.5), first=RED, second=BLUE)
    reference = oiio_canvas(width, height)
    oiio.ImageBufAlgo.fill(reference, RED, BLUE, RED, BLUE)
    assert np.abs(run(ends, size=(width, height)) - reference.get_pixels("float")).max() < 1e-6


def test_ramp_runs_along_its_axis_in_pixels(run):
    size, start, end = (40, 20), np.array([0.25, 0.1]), np.array([0.75, 0.9])
    out = run(Ramp(start=tuple(start), end=tuple(end)), size=size, output="value")[..., 0]
    x, y = centers(*size)
    axis = (end - start) * size
    t = ((x - start[0] * size[0]) * axis[0] + (y - start[1] * size[1]) * axis[1]) / (axis @ axis)
    assert np.abs(out - t.clip(0, 1)).max() < 1e-6


def test_radial_ramp_is_round_in_a_wide_picture(run):
    size = (64, 32)
    out = run(Ramp(shape="radial", start=(0.5, 0.5), end=(0.75, 0.5)), size=size, output="value")[..., 0]
    x, y = centers(*size)
    assert np.abs(out - (np.hypot(x - 32, y - 16) / 16).clip(0, 1)).max() < 1e-6


def test_angular_ramp_turns_clockwise_from_the_end(run):
    size = (31, 31)
    out = run(Ramp(shape="angular", start=(0.5, 0.5), end=(0.5, 1.0)), size=size, output="value")[..., 0]
    x, y = centers(*size)
    turn = ((np.arctan2(y - 15.5, x - 15.5) - np.pi / 2) / (2 * np.pi)) % 1.0
    distance = np.abs(out - turn)
    distance[15, 15] = 0.0  # the center has no direction
    assert np.minimum(distance, 1 - distance).max() < 1e-6
    assert out[15, 5] == pytest.approx(0.25, abs=1e-6)  # left comes a quarter turn after down


def test_smooth_ramp_eases_in_and_out(run):
    straight, eased, half = (
        run(Ramp(smoothness=amount), size=(64, 1), output="value")[..., 0] for amount in (0.0, 1.0, 0.5)
    )
    assert np.abs(eased - straight**2 * (3 - 2 * straight)).max() < 1e-6
    assert np.abs(half - 0.5 * (straight + eased)).max() < 1e-6


def test_ramp_mixes_premultiplied_colors(run):
    colors, value = (run(Ramp(first=RED, second=BLUE), size=(16, 2), output=name) for name in ("out", "value"))
    assert np.abs(colors - (np.array(RED) * (1 - value) + np.array(BLUE) * value)).max() < 1e-6


@pytest.mark.parametrize("shape", ["linear", "radial", "angular"])
def test_ramp_without_length_is_finite(run, shape):
    assert np.isfinite(run(Ramp(shape=shape, start=(0.5, 0.5), end=(0.5, 0.5)), size=(9, 9))).all()


@pytest.mark.parametrize("offset", [(0.0, 0.0), (3.0, -5.0)])
def test_checker_is_the_checker_of_openimageio(run, offset):
    reference = oiio_canvas(45, 31)
    oiio.ImageBufAlgo.checker(reference, 8, 8, 1, RED, BLUE, xoffset=int(offset[0]), yoffset=int(offset[1]), zoffset=0)
    out = run(Checker(size=8.0, first=RED, second=BLUE, offset=offset), size=(45, 31))
    assert np.array_equal(out, reference.get_pixels("float"))


def test_checker_shrinks_with_the_proxy(run):
    full, half = (run(Checker(size=8.0, offset=(4.0, 2.0)), size=(64, 48), scale=scale) for scale in (1.0, 0.5))
    assert half.shape == (24, 32, 4)
    assert np.array_equal(half, full[::2, ::2])
