"""Colors of the picker: linear light, display numbers, intensity and hexadecimal digits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.color.transforms import decode_srgb
from halation.editor.fields.colors import (
    brighten,
    decode,
    encode,
    from_display,
    from_hexadecimal,
    hexadecimal,
    intensity,
    swatch,
    to_display,
)
from halation.errors import UsageError
from hypothesis import given
from hypothesis import strategies as st


@given(st.floats(-2.0, 2.0))
def test_the_encoding_is_that_of_files(number):
    assert decode(number) == pytest.approx(float(decode_srgb(np.float64(number))), abs=1e-12)
    assert encode(decode(number)) == pytest.approx(number, abs=1e-6)


@given(st.tuples(*[st.floats(0.0, 60.0)] * 3))
def test_bright_colors_survive_the_picker(rgb):
    color = (*rgb, 0.5)
    stops = intensity(color)
    assert from_display(to_display(color, stops), stops, 0.5) == pytest.approx(color, rel=1e-4, abs=1e-6)


def test_intensity():
    assert intensity((4.0, 1.0, 0.0, 1.0)) == 2.0
    assert intensity((0.2, 0.1, 0.0, 1.0)) == 0.0
    assert brighten((1.0, 0.5, 0.0, 1.0), 1.0) == (2.0, 1.0, 0.0, 1.0)
    assert swatch((-1.0, 0.5, 7.0)) == pytest.approx((0.0, encode(0.5), 1.0))


def test_hexadecimal():
    assert hexadecimal((1.0, decode(0.2), 0.0, 1.0)) == "#ff3300"
    assert hexadecimal((1.0, 0.0, 0.0, 0.5)) == "#ff000080"
    assert from_hexadecimal(" #F80 ") == pytest.approx((1.0, decode(0x88 / 255), 0.0, 1.0))
    assert from_hexadecimal("ff000080", 1.0)[3] == 128 / 255
    assert from_hexadecimal("ff0000", 0.25)[3] == 0.25
    with pytest.raises(UsageError, match="'red' is not a color"):
        from_hexadecimal("red")
