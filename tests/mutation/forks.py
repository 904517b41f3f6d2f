"""Runs of pytest that begin in no time: each is a copy of a process that has imported the libraries already.

That process has imported nothing of the tree. So a copy reads the files as they are when it begins, a fault in one of
them included, whoever imports it and by whatever name; programs that tests start, and shaders, are read from the same
files. It never opens a device and never starts a thread of its own, both of which no copy would have.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

LIBRARIES = (
    "pytest", "_pytest.python", "numpy.testing", "scipy.ndimage", "scipy.optimize", "scipy.signal", "scipy.spatial",
    "scipy.interpolate", "cv2", "OpenImageIO", "PyOpenColorIO", "moderngl", "glfw", "imgui_bundle", "msgspec",
    "hypothesis.extra.numpy", "typer.testing", "rich.console", "rich.table", "trimesh", "watchfiles", "uharfbuzz",
    "platformdirs", "jsonschema", "pygments.lexers",
)  # fmt: skip
"""What tests import from outside; what is missing here is left to them."""

LIMIT = 300.0
"""Seconds after which a run is ended: it may loop while it imports, where no limit of a test is counted."""

MEMORY = 12 * 2**30
"""Bytes of data that a run may have: a fault may make a list that never ends."""

UNPLAYED = 70
"""The code of a run that pytest did not get through."""

_WORDS = 1000
"""Letters of an error that are told: more might wait for a reader."""

_STEP = 0.01
"""Seconds between two looks at a run."""


@dataclass(frozen=True)
class Ended:
    """How a run has ended: pytest's code, less than 0 for a signal, the first test or file that has failed, and the
    seconds of processor time that it took with all that it started."""

    code: int
    failed: str = ""
    spent: float = 0.0

    @property
    def passed(self) -> bool:
        """Whether nothing has failed; 5 says that no test was chosen."""
        return self.code in (0, 5)

    @property
    def words(self) -> str:
        """In words, for the list of faults."""
        return self.failed or ("no end" if self.code == -signal.SIGKILL else f"exit code {self.code}")


class Forks:
    """Runs pytest in copies of a process in this folder."""

    def __init__(self, tree: Path, env: Mapping[str, str], libraries: tuple[str, ...] = LIBRARIES) -> None:
        words = [sys.executable, __file__, *libraries]
        self._process = subprocess.Popen(
            words, cwd=tree, env={**env}, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def run(self, *words: str, limit: float = LIMIT, seconds: float = LIMIT) -> Ended:
        """Run pytest with these arguments; it begins no test after `seconds` of processor time, and is ended after
        `limit` seconds."""
        asked, answered = self._process.stdin, self._process.stdout
        assert asked is not None and answered is not None
        print(json.dumps([words, limit, seconds]), file=asked, flush=True)
        if not (line := answered.readline()):
            raise RuntimeError(f"the process that is copied has ended with {self._process.wait()}")
        return Ended(*json.loads(line))

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


@contextmanager
def open_forks(tree: Path, env: Mapping[str, str], libraries: tuple[str, ...] = LIBRARIES) -> Iterator[Forks]:
    """A process to copy, which ends with the block."""
    forks = Forks(tree, env, libraries)
    try:
        yield forks
    finally:
        forks.close()


class _Watch:
    """Notes the first test that fails, or the first file that cannot be read, and stops when the time is over."""

    def __init__(self, seconds: float) -> None:
        self.failed = ""
        self.is_late = False
        self._end = sum(os.times()[:4]) + seconds
        self._session: Any = None

    def pytest_sessionstart(self, session: Any) -> None:
        self._session = session

    def pytest_runtest_logreport(self, report: Any) -> None:
        self._note(report)
        if report.when == "teardown" and sum(os.times()[:4]) > self._end:
            self.is_late = True
            self._session.shouldstop = "enough tests have passed"

    def pytest_collectreport(self, report: Any) -> None:
        self._note(report)

    def _note(self, report: Any) -> None:
        if report.failed:
            self.failed = self.failed or report.nodeid


def serve(libraries: list[str]) -> None:
    """Answer lines of arguments with lines that say how pytest has ended."""
    for name in libraries:
        with suppress(ImportError):
            import_module(name)
    answers = os.fdopen(os.dup(1), "w")
    # As for `python -m pytest`, which processes that tests make by themselves look at too.
    sys.path[0] = str(Path.cwd())
    sys.modules["__main__"].__spec__ = find_spec("pytest.__main__")
    for line in sys.stdin:
        print(json.dumps(_run_copy(*json.loads(line))), file=answers, flush=True)


def _run_copy(words: list[str], limit: float, seconds: float) -> tuple[int, str, float]:
    begun = time.monotonic()
    ours, theirs = os.pipe()
    number = os.fork()
    if number == 0:
        try:
            os.close(ours)
            os._exit(_play(words, theirs, seconds))
        except BaseException as error:
            os.write(theirs, repr(error)[:_WORDS].encode())
            os._exit(UNPLAYED)
    os.close(theirs)
    ended, status, usage = os.wait4(number, os.WNOHANG)
    while not ended and time.monotonic() - begun < limit:
        ended, status, usage = os.wait4(number, os.WNOHANG)
        time.sleep(0.0 if ended else _STEP)
    with suppress(ProcessLookupError):
        os.killpg(number, signal.SIGKILL)
    if not ended:
        _, status, usage = os.wait4(number, 0)
    os.set_blocking(ours, False)  # what the run has left may hold the other end
    with os.fdopen(ours, "rb") as file:
        failed = (file.read() or b"").decode() if ended else ""
    return os.waitstatus_to_exitcode(status), failed, usage.ru_utime + usage.ru_stime


def _play(words: list[str], answer: int, seconds: float) -> int:
    """Run pytest in the copy, as a program of its own: signals reach what it starts, and nobody else."""
    import resource

    import pytest

    os.setsid()
    null = os.open(os.devnull, os.O_RDWR)
    for at in range(3):
        os.dup2(null, at)
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, resource.getrlimit(resource.RLIMIT_DATA)[1]))
    sys.argv[1:] = words
    watch = _Watch(seconds)
    known = "ignore:Module already imported:pytest.PytestAssertRewriteWarning"  # of libraries with plugins for pytest
    code = int(pytest.main(["-W", known, *words], plugins=[watch]))
    os.write(answer, watch.failed.encode())
    return 0 if watch.is_late and not watch.failed else code


if __name__ == "__main__":
    serve(sys.argv[1:])
