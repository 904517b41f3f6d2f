"""The table of drivers counts what differs, names what is missing, and measures light by what a screen shows of it."""

from __future__ import annotations

import numpy as np
import pytest
from bench.drivers import compare, draw_pictures, format_rows, measure_difference

BLACK = np.zeros(4)


@pytest.mark.parametrize(
    ("found", "expected", "difference"),
    [
        ([0.5, 0.25], [0.5, 0.0], 0.25),
        ([99.0, 0.0], [100.0, 0.0], 0.01),
        ([np.inf, 1.0], [np.inf, 1.0], 0.0),
        ([np.nan, 1.0], [0.0, 1.0], np.inf),
        ([0.0], [0.0, 1.0], np.inf),
    ],
)
def test_differences_are_those_of_the_larger_of_one_and_the_light(
    found: list[float], expected: list[float], difference: float
) -> None:
    assert measure_difference(np.array(found), np.array(expected)) == pytest.approx(difference)


def test_what_differs_and_what_is_missing_is_named() -> None:
    expected = {"device": "a", "node.x": BLACK, "node.y": BLACK, "node.z": BLACK, "preset.p": BLACK}
    found = {"device": "b", "node.x": BLACK + 0.003, "node.y": "ShaderError: no", "preset.p": BLACK + 0.5}
    row = compare("zink", found, expected)
    assert (row.device, row.nodes, row.presets, row.differing) == ("b", 1, 1, ("preset.p",))
    assert row.failures == ("node.y: ShaderError: no", "node.z: not drawn")
    assert format_rows([row]).splitlines()[-1] == "| zink | 1 | 1 | 1 | 0.5 preset.p |"


def test_pictures_are_drawn_or_say_why_not() -> None:
    drawn = dict(draw_pictures(("node.exposure", "node.none")))
    assert isinstance(drawn["node.exposure"], np.ndarray) and drawn["node.exposure"].size == 48 * 27 * 4
    assert drawn["node.none"] == "KeyError: 'none'"
    assert compare("same", drawn, drawn).largest == 0.0
