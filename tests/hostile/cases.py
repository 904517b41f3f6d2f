"""What a hostile case is, and what may come of it."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

EXIT_CODES = frozenset({0, 1, 2, 3, 4, 5, 130})
"""All that the README promises."""

UNFINISHED = re.compile(r"\.halation-|\.[0-9a-f]{8}\.tmp$")
"""Names of files that were begun and not finished."""


CHATTER = re.compile(r"^(lib(png|jpeg|tiff|webp)|_?TIFF|JPEG|OpenEXR|OpenJPEG|Premature|Corrupt|Bogus).*", re.MULTILINE)
"""What libraries print by themselves, beside the sentence of Halation."""


@dataclass(frozen=True)
class Case:
    """One command on files that `prepare` puts into an empty folder. `name` says how to make it again."""

    name: str
    prepare: Callable[[Path], None]
    words: tuple[str, ...]
    seconds: float = 20.0
    """How long it may take."""
    codes: frozenset[int] = EXIT_CODES
    """The exit codes that are right."""
    forbidden: str = ""
    """A folder in that of the case, no file of which may be opened."""


@dataclass(frozen=True)
class Outcome:
    """What came of a case. `code` is None if the process died; `signal` says of what."""

    code: int | None
    signal: int = 0
    seconds: float = 0.0
    peak: int = 0
    timed_out: bool = False


def find_faults(case: Case, outcome: Outcome, folder: Path, most_memory: int) -> list[str]:
    """What is wrong with an outcome, in words; empty if nothing is."""
    faults: list[str] = []
    if outcome.timed_out:
        faults.append(f"hang: not over after {case.seconds:g} s")
    elif outcome.code is None:
        faults.append(f"crash: ended by signal {outcome.signal}")
    elif outcome.code not in case.codes:
        faults.append(f"exit code {outcome.code}")
    if outcome.peak > most_memory:
        faults.append(f"memory: {outcome.peak >> 20} MiB")
    for name in ("stdout.txt", "stderr.txt"):
        path = folder / name
        text = path.read_text("utf-8", "replace") if path.exists() else ""
        if "Traceback (most recent call last)" in text:
            faults.append(f"traceback: {text.strip().splitlines()[-1][:200]}")
        if said := CHATTER.search(text):
            faults.append(f"chatter: {said[0][:200]}")
        if "this is a bug in Halation" in text:
            faults.append(f"bug: {text.strip().splitlines()[-1][:200]}")
    if left := [path.name for path in folder.rglob("*") if UNFINISHED.search(path.name)]:
        faults.append(f"half-written: {', '.join(left[:3])}")
    return faults
