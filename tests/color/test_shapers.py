"""The curves before tables of colors, which OpenColorIO applies from numbers to places and we undo."""

from __future__ import annotations

import numpy as np
import pytest
from halation.color.lut_files import Shaper, list_lattice
from halation.color.management import load_ocio


@pytest.mark.parametrize("is_log", [False, True])
@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-0.5, 4.0), (0.25, 2.0), (0.0, 1000.0)])
def test_places_are_those_of_opencolorio(low: float, high: float, is_log: bool) -> None:
    """From the lowest number at 0 to the highest at 1."""
    shaper, places = Shaper(low, high, is_log), np.linspace(0.0, 1.0, 33)
    numbers = shaper.decode(places)
    assert (numbers[0], numbers[-1]) == pytest.approx((low, high), rel=1e-12, abs=1e-12)
    steps = np.diff(numbers)
    assert (steps > 0.0).all() and (np.allclose(steps, steps[0]) or is_log)
    api = load_ocio()
    pixels = np.repeat(numbers[:, None], 3, axis=1).astype(np.float32)
    api.Config.CreateRaw().getProcessor(shaper.make_transform()).getDefaultCPUProcessor().applyRGB(pixels)
    np.testing.assert_allclose(pixels, np.repeat(places[:, None], 3, axis=1), atol=2e-5)
    lattice = list_lattice(shaper, 3)
    assert lattice[1, 2, 0] == pytest.approx([numbers[16], high, low], rel=1e-6)
