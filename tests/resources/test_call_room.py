"""Calls take no memory from the system, however deep they are nested."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from halation.resources.call_room import call_with_room

counts_pages = pytest.mark.skipif(sys.platform == "win32", reason="this system has no count of pages")
CALLS = 64

PROGRAM = """
import sys
sys.path.insert(0, {folder!r})
from halation import cli
from halation.cli import program
from test_call_room import faults_of_calls
program.run_process = lambda words: max(map(faults_of_calls, range(600)))
cli.main()
"""
"""The program with a command that ends with the most faults of a depth as its exit code."""


def faults_of_calls(depth: int) -> int:
    """Pages that the system hands out while a function at this depth calls another one that often."""
    if depth:
        return faults_of_calls(depth - 1)
    before = count_faults()
    for number in range(CALLS):
        abs_of(number)
    return count_faults() - before


def count_faults() -> int:
    """Pages that the system has handed out to this process."""
    import resource  # Windows has none

    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt


def abs_of(number: int) -> int:
    return number if number >= 0 else -number


def in_a_thread(function: Callable[[], object]) -> list[object]:
    """A thread has frames of its own, so that what pytest has called before does not count."""
    found: list[object] = []
    thread = threading.Thread(target=lambda: found.append(function()))
    thread.start()
    thread.join()
    return found


@counts_pages
def test_a_call_at_any_depth_takes_no_page() -> None:
    (faults,) = in_a_thread(lambda: call_with_room(lambda: [faults_of_calls(depth) for depth in range(900)]))
    assert isinstance(faults, list)
    assert max(faults) < CALLS / 2


def test_results_and_errors_pass_through() -> None:
    assert call_with_room(divmod, 7, 2) == (3, 1)
    assert call_with_room(sorted, [2, 3, 1], reverse=True) == [3, 2, 1]
    with pytest.raises(ZeroDivisionError):
        call_with_room(divmod, 1, 0)


@counts_pages
def test_the_program_is_called_with_room() -> None:
    """Each command, so that no module is imported at the end of a piece."""
    ended = subprocess.run([sys.executable, "-c", PROGRAM.format(folder=str(Path(__file__).parent))], check=False)
    assert ended.returncode < CALLS / 2
