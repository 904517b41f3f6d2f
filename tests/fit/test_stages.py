"""Which stages a search has: by small pictures first, then by whole ones, and what is left when its budget is spent."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.fit import fitting
from halation.fit.search import BudgetSpent

SMALL, WHOLE = np.array([1.0]), np.array([2.0])


class Search:
    """A search whose slopes at a point are ten times the point, as long as there is budget."""

    def __init__(self, point: np.ndarray, name: str, log: list[object], has_budget: bool = True) -> None:
        self.best_point, self.name, self.log, self.has_budget = point, name, log, has_budget
        self.scale, self.share, self.slopes = 0.5, 0.25, None

    def measure(self, point: np.ndarray, *, is_last: bool) -> None:
        self.log.append(("measure", self.name, float(point[0]), is_last))

    def measure_central_slopes(self, point: np.ndarray) -> np.ndarray:
        assert self.share == 1.0, "every pixel counts for what is reported"
        if not self.has_budget:
            raise BudgetSpent
        return 10.0 * point


@pytest.fixture
def search(monkeypatch: pytest.MonkeyPatch):
    """`search(shrink, ...)`: the slopes, and what was done."""

    def run(shrink: float, *, is_spent: bool = False, has_budget: bool = True, slopes: Any = None):
        log: list[object] = []
        proxy, full = Search(SMALL, "small", log, has_budget), Search(WHOLE, "whole", log, has_budget)
        proxy.slopes, full.slopes = np.array([7.0]), slopes
        renders: list[float] = []
        output = SimpleNamespace(render=lambda graph, scale: renders.append(scale))
        task: Any = SimpleNamespace(space=SimpleNamespace(start=SMALL, graph=None), output=output)
        meter: Any = SimpleNamespace(count=0, is_spent=is_spent, note_end=lambda: log.append("end"))
        monkeypatch.setattr(fitting, "_start_search", lambda *words: (proxy, 0.0))
        monkeypatch.setattr(fitting, "_improve", lambda search, start: log.append(("improve", search.name)))
        monkeypatch.setattr(
            fitting, "descend", lambda search, start, tolerance: log.append(("descend", search.name, float(start[0])))
        )
        found = fitting._search(task, meter, full, shrink)  # pyright: ignore[reportArgumentType]
        assert meter.count == len(renders) and all(scale == full.scale * shrink for scale in renders)
        return float(found[0]), log

    return run


def test_a_large_picture_is_searched_by_a_small_one_and_then_whole(search) -> None:
    slopes, log = search(0.2)
    assert log == [("improve", "small"), ("measure", "whole", 1.0, True), ("descend", "whole", 1.0)]
    assert slopes == 20.0, "at the best point of the whole picture"


def test_a_small_picture_is_searched_whole_at_once(search) -> None:
    assert search(1.0) == (20.0, [("improve", "whole")])


def test_a_spent_budget_measures_what_the_small_picture_found(search) -> None:
    assert search(0.2, is_spent=True)[1] == [("improve", "small"), ("measure", "whole", 1.0, True)]


def test_without_budget_for_slopes_those_that_were_found_count(search) -> None:
    assert search(0.2, has_budget=False)[0] == 7.0
    assert search(0.2, has_budget=False, slopes=np.array([9.0]))[0] == 9.0
