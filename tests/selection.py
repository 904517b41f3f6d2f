"""Which tests run: all but those of the night, only fast ones, those of what has changed, or also those of the night.

`--fast` leaves out the rooms that start programs and the tests that `slow_tests.txt` lists; with `HALATION_RENEW=1`,
`--costs` writes that list anew. `--nightly` repeats more often what kills or draws at random, and runs the cases that
are marked `nightly`.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import pytest
from _pytest.mark import ParameterSet
from changes import covers, is_case_of, list_changes, name_changed_nodes, tries_all_nodes

TESTS = Path(__file__).parent
LIST = TESTS / "slow_tests.txt"

SLOW_ROOMS = ("authoring", "bench", "cli", "cluster", "gui", "hostile", "law", "media", "presets", "regression")
"""Rooms whose tests start programs, write large files or render whole presets, left out by `--fast`."""

_FIRST_PARTS = tuple((room,) for room in SLOW_ROOMS)

SLOW = 0.3
"""Seconds of processor time above which a test is slow, all its cases together. The tests of the other
rooms that are not slow take 110 s together, those that are take 760 s, measured with Mesa 22.3 and its cache warm."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options that choose."""
    group = parser.getgroup("selection", "which tests run")
    group.addoption("--fast", action="store_true", help="only what takes little time: for every save")
    group.addoption("--changed", action="store_true", help="only what covers the files that git says have changed")
    group.addoption("--nightly", action="store_true", help="repeat more often what happens at random")


def pytest_configure(config: pytest.Config) -> None:
    """The mark of cases for the night."""
    config.addinivalue_line("markers", "nightly: run with --nightly only")


def list_seeds(daily: int, nightly: int) -> list[ParameterSet]:
    """Seeds from 0: `daily` ones for each run, and more up to `nightly` for the night."""
    return [pytest.param(seed, marks=() if seed < daily else pytest.mark.nightly) for seed in range(nightly)]


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Do not even import the rooms that `--fast` leaves out."""
    is_slow = collection_path.is_relative_to(TESTS) and collection_path.relative_to(TESTS).parts[:1] in _FIRST_PARTS
    if config.getoption("--changed") and collection_path.name.startswith("test_"):
        is_tried = name_changed_nodes(list_changes()) and tries_all_nodes(collection_path)
        return None if is_tried or covers(collection_path, list_changes()) else True
    return True if config.getoption("--fast") and is_slow else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what is slow, and what is for the night."""
    if not config.getoption("--nightly"):
        _leave_out(config, items, lambda item: item.get_closest_marker("nightly") is not None)
    if config.getoption("--changed"):
        changes = list_changes()
        ids = name_changed_nodes(changes)
        _leave_out(config, items, lambda item: not (covers(item.path, changes) or is_case_of(item.name, ids)))
    if config.getoption("--fast"):
        slow = set(LIST.read_text("utf-8").split("\n"))
        _leave_out(config, items, lambda item: name_function(item.nodeid) in slow)


def _leave_out(config: pytest.Config, items: list[pytest.Item], is_left_out: Callable[[pytest.Item], bool]) -> None:
    left_out = [item for item in items if is_left_out(item)]
    items[:] = [item for item in items if not is_left_out(item)]
    config.hook.pytest_deselected(items=left_out)


def list_cases(daily: Iterable[Any], nightly: Iterable[Any]) -> list[Any]:
    """Cases of each run, then those of the night, where a tuple has the arguments of several names."""
    more = (case if isinstance(case, tuple) else (case,) for case in nightly)
    return [*daily, *(pytest.param(*case, marks=pytest.mark.nightly) for case in more)]


@pytest.fixture(scope="session")
def is_nightly(request: pytest.FixtureRequest) -> bool:
    """True where tests repeat more often what happens at random."""
    return bool(request.config.getoption("--nightly"))


def name_function(test: str) -> str:
    """The name of a test without its case."""
    return test.partition("[")[0]


def list_slow(seconds: Mapping[str, float]) -> list[str]:
    """The tests of the other rooms that take long, by name."""
    totals = defaultdict[str, float](float)
    for test, spent in seconds.items():
        totals[name_function(test)] += spent
    return sorted(name for name, spent in totals.items() if spent > SLOW and name.split("/")[1] not in SLOW_ROOMS)
