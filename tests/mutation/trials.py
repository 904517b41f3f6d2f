"""Shows faults to tests: puts each into the copied tree, lets pytest run, and takes it out again.

A test that fails says something only if it fails again with the fault and passes without it. A full machine may fail a
test that has nothing to do with the fault, and so may what another test has left.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from mutation.forks import LIMIT, UNPLAYED, Ended
from mutation.mutants import Mutant

PATIENCE = 60
"""Seconds after which a test that sees a fault has failed: few need more, and those fail without the fault too."""

SECONDS = 120.0
"""Seconds of processor time for the tests that see a fault."""

PYTEST = ("-q", "-x", "-p", "no:cacheprovider", "--tb=no", f"--timeout={PATIENCE}")
"""What every run of pytest is told."""


class Runner(Protocol):
    """Runs pytest, as `Forks` does."""

    def run(self, *words: str, seconds: float) -> Ended:
        """How pytest ends with these arguments; it begins no test after so many seconds of processor time."""
        ...


@dataclass(frozen=True)
class Trial:
    """A fault and what the tests said."""

    mutant: Mutant
    room: str
    was_noticed: bool
    words: str


def room_of(path: Path) -> str:
    """The room of a file, as scores are counted: a folder of `app`, the nodes, or the shaders."""
    top, room, *_ = path.parts
    return room.removesuffix(".py") if top == "app" else top


class Trials:
    """Tries faults in one tree, and remembers which tests fail there without any."""

    def __init__(self, tree: Path, runner: Runner, seconds: float = SECONDS) -> None:
        self._tree, self._runner, self._seconds = tree, runner, seconds
        self._count = 0
        self._left = seconds
        self.broken = set[str]()
        """Tests, and files of tests, that say nothing: they fail without a fault, or not always with it."""

    def try_mutant(self, mutant: Mutant, selections: Sequence[Sequence[str]]) -> Trial:
        """Show a fault to these choices of tests, one after the other, until one fails because of it."""
        room, self._left = room_of(mutant.path), self._seconds
        for selection in selections:
            if words := self._find_failure(mutant, selection):
                return Trial(mutant, room, True, words)
            if self._left < 0.0:
                return Trial(mutant, room, False, f"{self._seconds:.0f} s of tests pass")
        files = {word.partition("::")[0] for words in selections for word in words if not word.startswith("-")}
        count = len({file for file in files if file.endswith(".py")})
        return Trial(mutant, room, False, f"{count} files of tests pass" if selections else "no test is near the file")

    def try_test(self, mutant: Mutant, room: str, test: str) -> Trial:
        """Show a fault to one test, which passes without it."""
        with self._put(mutant):
            ended = self._run(test)
        # A test that is not there, or a tree that cannot be imported, says nothing about the fault.
        return Trial(mutant, room, ended.code == 1, ended.words)

    def _find_failure(self, mutant: Mutant, selection: Sequence[str]) -> str:
        """What fails because of the fault; "" if nothing does."""
        while words := self._leave_out_broken(selection):
            with self._put(mutant):
                ended = self._run(*words, seconds=self._left)
                self._left -= ended.spent
                if ended.passed:
                    return ""
                asked = self._name_culprit(ended, words)
                fails_again = not ended.failed or not self._run(*asked).passed
            alone = self._run(*asked)
            if alone.code == UNPLAYED:
                raise RuntimeError(f"pytest does not run without the fault either: {alone.words}")
            if fails_again and (alone.passed or (not ended.failed and alone.code == 1)):
                return ended.words
            if not ended.failed or ended.failed in self.broken:
                return ""
            self.broken.add(ended.failed)
        return ""

    def _name_culprit(self, ended: Ended, words: Sequence[str]) -> list[str]:
        """What is asked again: the test that failed, or what could not be read.

        A run that was ended, or that has crashed, names no test: then it is all of it.
        """
        if "::" in ended.failed:
            return [ended.failed]
        return [*words] if ended.code < 0 else [*([ended.failed] if ended.failed else words), "--collect-only"]

    def _leave_out_broken(self, selection: Sequence[str]) -> list[str]:
        kept = [word for word in selection if not self.broken & {word, word.partition("::")[0]}]
        if not any(word.partition("::")[0].endswith(".py") and not word.startswith("-") for word in kept):
            return []
        return [*kept, *(f"--deselect={name}" for name in sorted(self.broken) if "::" in name)]

    def _run(self, *words: str, seconds: float = LIMIT) -> Ended:
        return self._runner.run(*PYTEST, *words, seconds=seconds)

    @contextmanager
    def _put(self, mutant: Mutant) -> Iterator[None]:
        """The file with the fault, at a time of its own: Python takes what it compiled for a file of the same time."""
        path = self._tree / mutant.path
        source, times = path.read_text("utf-8"), path.stat()
        self._count += 1
        _write(path, mutant.apply(source), times.st_mtime_ns + self._count * 10**9)
        try:
            yield
        finally:
            _write(path, source, times.st_mtime_ns)


def _write(path: Path, text: str, time: int) -> None:
    path.write_text(text, "utf-8")
    os.utime(path, ns=(time, time))


def rate(trials: Iterable[Trial]) -> dict[str, tuple[int, int]]:
    """Faults that were noticed, and all faults, by room."""
    scores = dict[str, tuple[int, int]]()
    for trial in trials:
        noticed, count = scores.get(trial.room, (0, 0))
        scores[trial.room] = noticed + trial.was_noticed, count + 1
    return dict(sorted(scores.items()))
