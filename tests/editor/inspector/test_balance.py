"""The numbers behind color wheels and the kelvin of the picker."""

from __future__ import annotations

import colorsys
import math

import pytest
from halation.editor.fields.balance import find_temperature, join_balance, set_temperature, split_balance
from hypothesis import given
from hypothesis import strategies as st

PARTS = st.floats(-8.0, 8.0)


@given(PARTS, PARTS, PARTS, st.floats(0.0, 1.0))
def test_a_wheel_gives_back_the_color_that_it_shows(red: float, green: float, blue: float, alpha: float) -> None:
    level, x, y = split_balance((red, green, blue, alpha))
    assert level == pytest.approx((red + green + blue) / 3.0, abs=1e-9)
    assert join_balance(level, x, y, alpha) == pytest.approx((red, green, blue, alpha), abs=1e-9)


@pytest.mark.parametrize("sixth", range(6))
def test_the_angle_is_the_hue(sixth: int) -> None:
    angle = sixth * math.pi / 3.0
    color = join_balance(0.5, 0.2 * math.cos(angle), 0.2 * math.sin(angle))
    hue, _, _ = colorsys.rgb_to_hsv(*color[:3])
    assert math.cos(2.0 * math.pi * hue - angle) == pytest.approx(1.0, abs=1e-9)


@given(st.floats(2000.0, 15000.0))
def test_a_temperature_is_found_again(kelvin: float) -> None:
    color = set_temperature((0.3, 0.5, 0.1, 0.25), kelvin)
    assert find_temperature(color) == pytest.approx(kelvin, rel=1e-6)
    luminance = 0.2126729 * color[0] + 0.7151522 * color[1] + 0.0721750 * color[2]
    assert luminance == pytest.approx(0.2126729 * 0.3 + 0.7151522 * 0.5 + 0.0721750 * 0.1, rel=1e-6)
    assert color[3] == 0.25


def test_the_light_of_a_bulb_is_that_of_illuminant_a() -> None:
    """CIE 15: x, y = 0.44758, 0.40745, through the matrix of IEC 61966-2-1."""
    x, y = 0.44758, 0.40745
    big_x, big_z = x / y, (1.0 - x - y) / y
    light = (
        3.2406 * big_x - 1.5372 - 0.4986 * big_z,
        -0.9689 * big_x + 1.8758 + 0.0415 * big_z,
        0.0557 * big_x - 0.2040 + 1.0570 * big_z,
    )
    assert find_temperature((*light, 1.0)) == pytest.approx(2856.0, abs=8.0)
    assert set_temperature((1.0, 1.0, 1.0, 1.0), 2856.0)[:3] == pytest.approx(light, abs=0.004)


def test_black_gets_a_light_of_its_own() -> None:
    assert max(set_temperature((0.0, 0.0, 0.0, 1.0), 3200.0)[:3]) > 0.5
    assert find_temperature((0.0, 0.0, 0.0, 1.0)) == 6504.0
