"""Runs cases in worker processes, several at a time, and notices those that die or never answer."""

from __future__ import annotations

import contextlib
import json
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from queue import SimpleQueue

from cases import Case, Outcome, find_faults
from opened import OpenWatch

Result = tuple[Case, Outcome, list[str]]

WORKER = Path(__file__).with_name("worker.py")
CASES_PER_WORKER = 400
"""A worker is replaced after so many cases: what a library leaks is no fault of the case that comes last."""

MOST_MEMORY = 3 << 30
"""Bytes that a worker may take: half of what a small build machine has."""


@dataclass
class Worker:
    """One process, started again whenever it has died."""

    _process: subprocess.Popen[str] | None = None
    _served: int = 0

    def run(self, case: Case, folder: Path) -> Outcome:
        """Run a case in its folder."""
        process = self._start()
        assert process.stdin and process.stdout
        began = time.monotonic()
        process.stdin.write(json.dumps({"folder": str(folder), "words": case.words}) + "\n")
        process.stdin.flush()
        answered, _, _ = select.select([process.stdout], [], [], case.seconds)
        seconds = time.monotonic() - began
        if not answered:
            self.close()
            return Outcome(None, seconds=seconds, timed_out=True)
        line = process.stdout.readline()
        if not line:
            code = process.wait()
            self.close()
            return Outcome(None, max(-code, 0), seconds)
        self._served += 1
        answer = json.loads(line)
        if self._served >= CASES_PER_WORKER or answer["peak"] > MOST_MEMORY:
            self.close()
        return Outcome(answer["code"], 0, seconds, answer["peak"])

    def close(self) -> None:
        """End the process and everything that it started."""
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        self._process, self._served = None, 0

    def _start(self) -> subprocess.Popen[str]:
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, str(WORKER)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                start_new_session=True,
                env={**os.environ, "LP_NUM_THREADS": "1"},
            )
        return self._process


@dataclass
class Tally:
    """What came of all cases of a kind."""

    count: int = 0
    seconds: float = 0.0
    slowest: float = 0.0
    peak: int = 0
    codes: dict[int, int] = field(default_factory=dict[int, int])
    faults: list[tuple[str, str]] = field(default_factory=list[tuple[str, str]])


def run_cases(cases: Iterable[Case], jobs: int, keep: Path | None, patience: float = 1.0) -> Tally:
    """Run all; the folder of each case that went wrong is copied to `keep`. `patience` multiplies their times."""
    tally, idle = Tally(), SimpleQueue[Worker]()
    workers = [Worker() for _ in range(jobs)]
    for worker in workers:
        idle.put(worker)

    def run(case: Case) -> Result:
        worker = idle.get()
        folder = Path(tempfile.mkdtemp(prefix="hostile-"))
        try:
            case.prepare(folder)
            patient = replace(case, seconds=case.seconds * patience)
            watch = OpenWatch(folder / case.forbidden) if case.forbidden else None
            outcome = worker.run(patient, folder)
            faults = find_faults(patient, outcome, folder, MOST_MEMORY)
            if watch:
                faults += [f"escape: {name} was opened" for name in sorted(watch.names())]
                watch.close()
            if faults and keep:
                shutil.copytree(
                    folder, keep / case.name.replace("/", "_"), ignore=_list_special, dirs_exist_ok=True, symlinks=True
                )
            return case, outcome, faults
        finally:
            shutil.rmtree(folder, ignore_errors=True)
            idle.put(worker)

    try:
        with ThreadPoolExecutor(jobs) as threads:
            for case, outcome, faults in _in_turn(threads, run, cases, 4 * jobs):
                tally.count += 1
                tally.seconds += outcome.seconds
                tally.slowest, tally.peak = max(tally.slowest, outcome.seconds), max(tally.peak, outcome.peak)
                if outcome.code is not None:
                    tally.codes[outcome.code] = tally.codes.get(outcome.code, 0) + 1
                for fault in faults:
                    tally.faults.append((case.name, fault))
                    print(f"{case.name}: {fault}", flush=True)
    finally:
        for worker in workers:
            worker.close()
    return tally


def _in_turn(
    threads: ThreadPoolExecutor, run: Callable[[Case], Result], cases: Iterable[Case], ahead: int
) -> Iterator[Result]:
    """Outcomes in the order of the cases, of which only a few are prepared before their turn."""
    waiting, rest = [], iter(cases)
    for case in islice(rest, ahead):
        waiting.append(threads.submit(run, case))
    while waiting:
        yield waiting.pop(0).result()
        waiting += [threads.submit(run, case) for case in islice(rest, 1)]


def _list_special(folder: str, names: list[str]) -> list[str]:
    """What nobody can copy: FIFOs and sockets."""
    paths = (Path(folder, name) for name in names)
    return [path.name for path in paths if not (path.is_symlink() or path.is_file() or path.is_dir())]
