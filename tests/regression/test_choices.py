"""How many processes share cases, and what a node is shown that should not read it."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import pytest
from halation.compiler import Region
from halation.nodes import Image, Pointwise, Slider
from halation.regression import parallel, read_areas

ENOUGH = 64 << 30


class Lengths(Pointwise):
    """Values of which some are lengths."""

    image = Image()
    radius: Annotated[float, Slider(0.0, 50.0, unit="px", minimum=0.0)] = 2.0
    wide: Annotated[float, Slider(0.0, 50.0, unit="px", minimum=0.0)] = 9.0
    short: Annotated[float, Slider(0.0, 3.0, unit="px", minimum=0.0, maximum=3.0)] = 1.0
    high: Annotated[float, Slider(0.0, 1.0, unit="height", minimum=0.0)] = 0.01
    share: Annotated[float, Slider(0.0, 1.0, unit="ratio", minimum=0.0)] = 0.01
    count: Annotated[int, Slider(0, 9, unit="count", minimum=0)] = 1


@pytest.mark.parametrize(
    ("cores", "memory", "cases", "processes"),
    [(8, ENOUGH, 1000, 8), (1, ENOUGH, 1000, 1), (8, 3 << 29, 1000, 3), (8, 0, 1000, 1), (8, float("inf"), 1000, 8),
     (8, ENOUGH, 0, 1), (8, ENOUGH, 1, 1)],
)  # fmt: skip
def test_processes_are_as_many_as_there_are_cores_memory_and_work_for(
    monkeypatch: pytest.MonkeyPatch, cores: int, memory: float, cases: int, processes: int
) -> None:
    monkeypatch.setattr(parallel, "available_cores", lambda: cores)
    monkeypatch.setattr(parallel, "available_memory", lambda: memory)
    assert parallel.choose_processes(cases) == processes


def test_each_process_has_some_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parallel, "available_cores", lambda: 8)
    monkeypatch.setattr(parallel, "available_memory", lambda: float(ENOUGH))
    least = parallel._LEAST_CASES  # pyright: ignore[reportPrivateUsage]
    assert [parallel.choose_processes(least * 3 + more) for more in (-1, 0, least - 1, least)] == [2, 3, 3, 4]


def test_what_is_not_needed_is_poisoned() -> None:
    pictures = {"a": np.full((40, 60, 4), 0.5, np.float32), "b": np.full((40, 60, 1), 0.25, np.float32)}
    found = read_areas.poison(pictures, {"a": Region(10, 5, 20, 15)})
    assert (found["a"][5:20, 10:30] == 0.5).all() and {name: part.shape for name, part in found.items()} == {
        "a": (40, 60, 4), "b": (40, 60, 1),
    }  # fmt: skip
    outside = np.ones((40, 60), bool)
    outside[5:20, 10:30] = False
    for poisoned in (found["a"][outside], found["b"]):
        assert 0.07 < np.isnan(poisoned).mean() < 0.13
        assert 8e3 < np.nanstd(poisoned) < 1.2e4 and not (poisoned == 0.5).any()
    assert (pictures["a"] == 0.5).all() and (pictures["b"] == 0.25).all(), "the pictures stay"


def test_lengths_are_made_longer_than_what_was_declared_for_one() -> None:
    """4.6 pixels of a picture of 83 rows, within the limits of the value, and only where that is longer."""
    found = read_areas._lengthen(Lengths)  # pyright: ignore[reportPrivateUsage]
    assert found == {"radius": 4.6, "short": 3.0, "high": pytest.approx(4.6 / 83)}
