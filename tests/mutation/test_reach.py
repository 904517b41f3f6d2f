"""Blocks say that they run, notes of processes become a record, and a fault is shown to the tests that run its line."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from mutation import choice, reach
from mutation.reach import list_blocks, note_blocks, number_block

SOURCE = '''"""A module."""
LIMIT = 3

def choose(x):
    """Words that stay."""
    if x > LIMIT:
        return "much"
    for _ in range(x):
        x += 10
    else:
        x += 1
    return x

class Box:
    side = 2
    def grow(self):
        try:
            return inner()
        except NameError:
            return [self.side for _ in range(2)]
'''
WALK = Path("app/graph/walk.py")


@pytest.fixture(autouse=True)
def forget() -> Iterator[None]:
    """What was read of a record holds for a process; here there are several."""
    clear()
    yield
    clear()


def clear() -> None:
    for cached in (reach.read_record, reach._count_blocks, reach._read_blocks):  # pyright: ignore[reportPrivateUsage]
        cached.cache_clear()


def test_blocks_of_functions_say_that_they_run() -> None:
    seen: list[int] = []
    names: dict = {"_noted": seen.append}
    exec(compile(note_blocks(SOURCE, "a.py"), "a.py", "exec"), names)
    assert not seen, "what a module does when it is imported is not noted"

    def number(name: str, offset: int) -> int:
        return number_block("a.py", name, offset)

    assert names["choose"](5) == "much" and seen == [number(".choose", 1), number(".choose", 3)]
    seen.clear()
    assert names["choose"](1) == 12 and seen == [number(".choose", offset) for offset in (1, 5, 7)]
    seen.clear()
    assert names["Box"]().grow() == [2, 2] and seen == [number(".Box.grow", offset) for offset in (1, 2, 4)]
    assert names["choose"].__doc__ == "Words that stay."


def test_a_block_keeps_its_number_while_other_lines_of_its_file_change() -> None:
    moved = SOURCE.replace("LIMIT = 3\n", "LIMIT = 3\nMORE = 4\n\n")
    before, after = ({(name, offset) for name, offset, *_ in list_blocks(ast.parse(text))} for text in (SOURCE, moved))
    assert before == after and (".choose", 3) in before


def keep(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, **files: str) -> None:
    """Keep the notes of some processes."""
    notes = tmp_path / "notes"
    notes.mkdir(exist_ok=True)
    for old in notes.iterdir():
        old.unlink()
    for name, text in files.items():
        (notes / name).write_text(text)
    monkeypatch.setattr(reach, "RECORD", tmp_path / "reach.npz")
    clear()
    reach._keep(notes)  # pyright: ignore[reportPrivateUsage]
    clear()


def test_notes_of_processes_become_a_record(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    first = "T\n1\nTa.py::one[x]\n5\n6\nS0.5\nT\n9\nTa.py::one[y]\n7\nS0.25\nTb.py::two\n5\nS2.0\n"
    keep(monkeypatch, tmp_path, p1=first, p2="Ta.py::one[x]\n8\n")
    names, seconds, blocks = reach.read_record()
    assert names == ["a.py::one", "b.py::two"] and seconds == {"a.py::one": 0.75, "b.py::two": 2.0}
    assert dict(blocks) == {5: {0, 1}, 6: {0}, 7: {0}, 8: {0}}, "what belongs to no test is left out"
    keep(monkeypatch, tmp_path, p3="Tb.py::two\n6\nS1.0\n")
    _, seconds, blocks = reach.read_record()
    assert seconds == {"a.py::one": 0.75, "b.py::two": 1.0} and blocks[5] == {0} and blocks[6] == {0, 1}


def test_tests_that_are_newer_than_the_record_are_known(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    file = "tests/graph/test_edits.py"
    monkeypatch.setattr(reach, "RECORD", tmp_path / "none.npz")
    clear()
    every = choice.list_fresh_tests([file])
    assert {f"{file}::test_mute_and_what_passes_through", f"{file}::TestSet::test_refuses"} <= {*every}
    keep(monkeypatch, tmp_path, p1=f"T{every[0]}\n5\nS0.5\n")
    assert choice.list_fresh_tests([file]) == every[1:]


def test_a_line_is_shown_to_the_tests_that_run_its_block(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(reach, "RECORD", tmp_path / "none.npz")
    assert reach.list_runners(WALK, 1) == {} and choice.choose_runners(WALK, 1, []) == []
    blocks = reach._read_blocks(WALK)  # pyright: ignore[reportPrivateUsage]
    (first, _, outer), (inner_first, _, inner) = next(
        (a, b) for a, b in pairwise(blocks) if a[0] < b[0] <= b[1] <= a[1]
    )
    text = f"Ttests/far.py::all\n{outer}\n{inner}\n1\n2\nS50.0\nTtests/near.py::head\n{outer}\nS9.0\n"
    keep(monkeypatch, tmp_path, p1=text + f"Ttests/some.py::both\n{outer}\n{inner}\nS20.0\n")
    assert reach.list_runners(WALK, inner_first) == {"tests/far.py::all": 4, "tests/some.py::both": 2}
    assert reach.list_runners(WALK, first) == {
        "tests/far.py::all": 4,
        "tests/near.py::head": 1,
        "tests/some.py::both": 2,
    }
    assert reach.is_outside_functions(WALK, 1) and not reach.is_outside_functions(WALK, inner_first)
    assert {*reach.list_runners(WALK, 1)} == {"tests/far.py::all", "tests/near.py::head", "tests/some.py::both"}
    assert choice.choose_runners(WALK, first, ["tests/near.py"]) == [
        "tests/near.py::head", "tests/some.py::both", "tests/far.py::all",
    ]  # fmt: skip
    monkeypatch.setattr(choice, "RUNNING_SECONDS", 15.0)
    assert choice.choose_runners(WALK, first, ["tests/far.py"]) == ["tests/far.py::all"]
    assert choice.choose_runners(WALK, first, []) == ["tests/near.py::head", "tests/some.py::both"]
