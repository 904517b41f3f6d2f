"""Faults are seen by whoever runs the tree, are taken out again, and what fails for another reason notices nothing."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from mutation import trials
from mutation.forks import Ended, open_forks
from mutation.mutants import Mutant, list_mutants
from mutation.trials import PYTEST, Trial, Trials, rate
from source_trees import import_from

SUMS = '''"""Sums."""
LIMIT = 10

def add(a, b):
    return min(a + b, LIMIT)

def count(end, step=1):
    at = 0
    while at < end:
        at += step
    return at

if __name__ == "__main__":
    print(add(2, 2))
'''
TESTS = """
import subprocess, sys
from functools import partial
from pathlib import Path
from halation.sums import LIMIT, add, count

HELD = partial(add, 2)

def test_by_name(): assert add(1, 2) == 3
def test_held_since_the_file_was_read(): assert HELD(2) == 4
def test_constant(): assert LIMIT == 10
def test_count(): assert count(3) == 3
def test_program():
    words = [sys.executable, "-m", "halation.sums"]
    assert subprocess.run(words, capture_output=True, text=True).stdout == "4\\n"
def test_shader():
    import halation
    text = Path(halation.__file__).parents[1].joinpath("shaders/white.glsl").read_text()
    assert text == "float white = 1.0;"
def test_that_always_fails(): assert False
"""
FILES = {
    "app/__init__.py": "",
    "app/sums.py": SUMS,
    "app/regression/__init__.py": "",
    "app/regression/plugin.py": "",
    "shaders/white.glsl": "float white = 1.0;",
    "tests/test_sums.py": TESTS,
    "pyproject.toml": '[tool.pytest.ini_options]\naddopts = "--import-mode=importlib"\n',
}
HERE = "tests/test_sums.py"
ADD = Path("app/sums.py")


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small tree with tests."""
    root = tmp_path_factory.mktemp("small") / "tree"
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


@pytest.fixture
def small(tree: Path) -> Iterator[Trials]:
    """Trials in that tree, by copies of a process."""
    with open_forks(tree, import_from(tree), ("pytest",)) as forks:
        yield Trials(tree, forks)


def fault(old: str, new: str, file: str = "app/sums.py") -> Mutant:
    """A fault that stands where this text stands first."""
    start = FILES[file].index(old)
    return Mutant(Path(file), start, start + len(old), new)


@pytest.mark.parametrize(
    ("mutant", "test"),
    [
        (fault("+", "-"), "test_by_name"),
        (fault("min", "max"), "test_held_since_the_file_was_read"),
        (fault("10", "11"), "test_constant"),
        (fault("add(2, 2)", "add(2, 3)"), "test_program"),
        (fault("a + b", "a - b"), "test_program"),
        (fault("1.0", "2.0", "shaders/white.glsl"), "test_shader"),
        (fault("LIMIT = 10", "LIMIT = missing"), ""),
    ],
)
def test_a_fault_is_seen_however_it_is_reached(small: Trials, tree: Path, mutant: Mutant, test: str) -> None:
    trial = small.try_mutant(mutant, [[f"{HERE}::{test}" if test else HERE]])
    assert trial.was_noticed and trial.words == (f"{HERE}::{test}" if test else HERE)
    assert (tree / mutant.path).read_text() == FILES[str(mutant.path)], "the fault was taken out again"


def test_faults_of_one_length_in_one_second_are_different(small: Trials) -> None:
    """What Python compiled of one fault is not taken for the next, nor for the file without any."""
    found = [small.try_mutant(fault("+", new), [[f"{HERE}::test_by_name"]]).was_noticed for new in "-|*^&|"]
    assert found == [True, False, True, False, True, False], "1 | 2 and 1 ^ 2 are 1 + 2"


def test_an_equivalent_survives(small: Trials) -> None:
    assert not small.try_mutant(fault("at < end", "at < 0 + end"), [[HERE]]).was_noticed
    assert f"{HERE}::test_that_always_fails" in small.broken
    assert small.try_mutant(fault("+", "-"), [[HERE]]).was_noticed, "the others of the file still say something"


def test_an_endless_loop_ends(small: Trials, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trials, "PYTEST", (*PYTEST[:-1], "--timeout=1"))
    begun = time.monotonic()
    trial = small.try_mutant(fault("step=1", "step=0"), [[f"{HERE}::test_count"]])
    assert trial.was_noticed and trial.words.endswith("test_count") and time.monotonic() - begun < 60


def test_a_loop_while_importing_ends(tree: Path) -> None:
    """No limit of a test is counted there: the whole run is ended, and names no test."""
    with open_forks(tree, import_from(tree), ("pytest",)) as forks:

        class Short:
            def run(self, *words: str, seconds: float) -> Ended:
                return forks.run(*words, limit=6.0, seconds=seconds)

        trial = Trials(tree, Short()).try_mutant(fault("LIMIT = 10", "while 1: 2"), [[f"{HERE}::test_count"]])
        assert trial.was_noticed and trial.words == "no end"


def test_no_test_begins_when_the_time_is_over(tree: Path) -> None:
    with open_forks(tree, import_from(tree), ("pytest",)) as forks:
        assert forks.run(*PYTEST, HERE, seconds=0.0).passed, "only the first one ran"
        ended = forks.run(*PYTEST, HERE)
        assert not ended.passed and ended.failed.endswith("test_that_always_fails") and ended.spent > 0.0
        assert Trials(tree, forks).try_test(fault("+", "-"), "all", f"{HERE}::test_by_name").was_noticed
        assert not Trials(tree, forks).try_test(fault("+", "-"), "all", f"{HERE}::test_of_no_name").was_noticed


class Played:
    """Answers for pytest: `ends` says how a run ends, by the text of the file and the words."""

    def __init__(self, path: Path, ends) -> None:
        self.path, self.ends, self.seen = path, ends, list[str]()

    def run(self, *words: str, seconds: float) -> Ended:
        self.seen.append(self.path.read_text())
        return self.ends(self.seen[-1], words)


@pytest.mark.parametrize("fails_again", [True, False])
@pytest.mark.parametrize("passes_without", [True, False])
def test_a_failure_counts_if_it_comes_and_goes_with_the_fault(
    tmp_path: Path, fails_again: bool, passes_without: bool
) -> None:
    (tmp_path / ADD).parent.mkdir(parents=True)
    (tmp_path / ADD).write_text("a < b")

    def end(text: str, words: tuple[str, ...]) -> Ended:
        if "--deselect=a.py::test" in words:
            return Ended(0)
        fails = (fails_again if text == "a <= b" else not passes_without) if "a.py::test" in words else True
        return Ended(int(fails), "a.py::test" if fails else "")

    played = Played(tmp_path / ADD, end)
    tried = Trials(tmp_path, played)
    trial = tried.try_mutant(Mutant(ADD, 2, 3, "<="), [["a.py"]])
    is_due = fails_again and passes_without
    assert trial.was_noticed is is_due and tried.broken == (set() if is_due else {"a.py::test"})
    assert {*played.seen} == {"a <= b", "a < b"} and (tmp_path / ADD).read_text() == "a < b"
    assert rate([trial, Trial(trial.mutant, "media", True, "")]) == {"media": (1, 1), "sums": (int(is_due), 1)}


@pytest.mark.parametrize("crashes_without", [True, False])
def test_a_crash_counts_if_nothing_crashes_without_the_fault(tmp_path: Path, crashes_without: bool) -> None:
    (tmp_path / ADD).parent.mkdir(parents=True)
    (tmp_path / ADD).write_text("a < b")
    played = Played(tmp_path / ADD, lambda text, _: Ended(-11 if "=" in text or crashes_without else 0))
    trial = Trials(tmp_path, played).try_mutant(Mutant(ADD, 2, 3, "<="), [["a.py"]])
    assert trial.was_noticed is not crashes_without


def test_all_faults_of_a_function_that_is_tested_are_noticed(small: Trials) -> None:
    """Every fault of `add` and of the constant, by tests that say what they do."""
    faults = [mutant for mutant in list_mutants(ADD, SUMS) if mutant.start < SUMS.index("def count")]
    tests = [f"{HERE}::{name}" for name in ("test_by_name", "test_constant", "test_program")]
    assert len(faults) >= 3 and all(small.try_mutant(mutant, [tests]).was_noticed for mutant in faults)
