"""The page of a fit, the light that is compared, and libraries that are missing."""

from __future__ import annotations

import base64
import re
import sys
from typing import Any

import cv2
import numpy as np
import pytest
from halation.errors import UsageError
from halation.fit.libraries import check_fit_libraries, has_fit_libraries, load_fit_library
from halation.fit.report import describe_errors, make_fit_page, make_strip
from halation.fit.results import FitResult, FittedValue
from halation.fit.shown_output import cover_with_alpha
from halation.graph import Graph


def result(**changes: Any) -> FitResult:
    """A gain that was found, and an offset that the picture says little about."""
    values = (
        FittedValue("grade.gain<1>", 1.0, 1.23456789, 0.0, 4.0, 12.345678, True),
        FittedValue("grade.offset", 0.5, 0.25, -1.0, 1.0, 0.0123456, False),
    )
    pictures = [np.full((27, 48, 3), light, np.float32) for light in (0.0, 2.0, 0.25)]
    facts: dict[str, Any] = {
        "graph": Graph(), "settings": {}, "values": values, "errors": (9.0, 1.5), "delta_e": (12.345, 0.678),
        "renders": 42, "before": pictures[0], "after": pictures[1], "reference": pictures[2],
        "seconds": 3.14159, "stopped": "",
    }  # fmt: skip
    return FitResult(**(facts | changes))


def test_errors_are_color_differences_or_those_of_looks() -> None:
    assert describe_errors(result()).startswith("mean color difference 12.35 -> 0.68 (CIEDE2000")
    assert describe_errors(result(delta_e=None)) == "difference of looks 9.00 -> 1.50"


def test_the_page_has_all_values_and_its_pictures() -> None:
    page = make_fit_page(result(), "A & B")
    assert page.count("A &amp; B") == 2 and "; 42 renders in 3.1 s" in page and "/*" not in page
    rows = re.findall(
        r"<tr( class=weak)?><td>(.*?)</td><td>(.*?)</td><td>(.*?)</td><td>(.*?)</td><td>(.*?)</td></tr>", page
    )
    assert rows == [
        ("", "grade.gain&lt;1&gt;", "1", "1.2346", "0 to 4", "12.3"),
        (" class=weak", "grade.offset", "0.5", "0.25", "-1 to 1", "0.0123, weak"),
    ]
    (strip,) = re.findall(r"data:image/png;base64,([\w+/=]+)", page)
    picture = cv2.imdecode(np.frombuffer(base64.b64decode(strip), np.uint8), cv2.IMREAD_UNCHANGED)
    assert picture is not None and picture.shape[1] > 4 * 48 and picture.ndim == 3


def test_the_strip_has_the_wanted_picture_in_the_middle_and_what_is_left() -> None:
    strip = make_strip(result())
    assert strip.min() >= 0.0 and strip.max() <= 1.0
    cell = strip.shape[1] // 4
    middle = [strip[strip.shape[0] // 2, round((at + 0.5) * cell)] for at in range(4)]
    assert np.allclose(middle[0], 0.0) and np.allclose(middle[1], 0.25, atol=0.01) and np.allclose(middle[2], 1.0)
    looks = make_strip(result(delta_e=None))
    assert round(strip.shape[1] / looks.shape[1], 1) == pytest.approx(4 / 3, abs=0.05)


def test_light_is_covered_by_its_alpha_over_black() -> None:
    light = np.float32([[[1.0, 0.5, 2.0]] * 4])
    pixels = np.concatenate([light, np.float32([[[0.0], [0.25], [1.0], [3.0]]])], axis=2)
    expected = np.float32([0.0, 0.25, 1.0, 1.0])[None, :, None] * light
    assert np.array_equal(cover_with_alpha(light, pixels), expected)
    assert np.array_equal(cover_with_alpha(light, light), light), "no alpha covers all"
    odd = np.float32([[[np.nan, np.inf, -np.inf]]])
    assert cover_with_alpha(odd, odd).tolist() == [[[0.0, 65504.0, -65504.0]]]


@pytest.mark.parametrize("name", ["cma", "scipy"])
def test_a_missing_library_is_named(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    assert has_fit_libraries() and hasattr(load_fit_library("scipy"), "least_squares")
    assert hasattr(load_fit_library("cma"), "CMAEvolutionStrategy")
    check_fit_libraries()
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(UsageError, match=r"pip install 'halation\[fit\]'"):
        check_fit_libraries()
