"""Every test has a time limit, and a test that exceeds it is named while the others go on.

pytest-timeout reads the limits: `timeout` in pyproject.toml, or the mark `timeout(seconds)` of a test that needs more.
What happens then is decided here, because neither of its own methods does in all cases. An exception from a signal
cannot end a test that is stuck in C, and Hypothesis takes the failure of pytest for a bug of the example and tries
the example again, for ever. Ending the process says too little where no other process reports it.

So there are two steps. At the limit a signal raises `Overrun`, which neither Hypothesis nor the product catches. Where
that has no effect, a thread of faulthandler, which needs no lock of Python, prints the stacks of all threads and ends
the process `timeout_grace` seconds later; pytest-xdist then reports the test and starts another process for the rest.
"""

from __future__ import annotations

import faulthandler
import os
import signal
from collections.abc import Generator
from types import FrameType
from typing import Any

import pytest
from recycling import has_children

GRACE = 60
"""Seconds that a test has to end itself after its limit: fixtures may have to end processes and devices."""

AFTER_ALL = 300.0
"""Seconds that a worker may take to end when all its tests have run."""

_ERRORS = pytest.StashKey[int]()


class Overrun(BaseException):
    """A test has not ended in time."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option that tests of the limits shorten."""
    parser.addini("timeout_grace", "seconds between the time limit of a test and the end of its process", default=GRACE)


def pytest_configure(config: pytest.Config) -> None:
    """Keep the real standard error, which tests replace while they run."""
    config.stash[_ERRORS] = os.dup(2)


@pytest.hookimpl(optionalhook=True)
def pytest_timeout_set_timer(item: pytest.Item, settings: Any) -> bool:
    """Start the two timers of a test, in the process that runs it."""
    if has_children(item.config):
        return True
    seconds = float(settings.timeout)

    def stop(_: int, frame: FrameType | None) -> None:
        raise Overrun(f"{item.nodeid} has not ended after {seconds:g} seconds")

    if hasattr(signal, "SIGALRM"):
        signal.signal(signal.SIGALRM, stop)
        signal.setitimer(signal.ITIMER_REAL, seconds)
    end_later(item.config, seconds + float(item.config.getini("timeout_grace")))
    return True


@pytest.hookimpl(optionalhook=True)
def pytest_timeout_cancel_timer(item: pytest.Item) -> bool:
    """Stop the signal. The process keeps its limit, because what tidies up after a failure may be stuck too."""
    if hasattr(signal, "SIGALRM"):
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    return True


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """End the limit of a process with its test."""
    try:
        return (yield)
    finally:
        faulthandler.cancel_dump_traceback_later()


def pytest_enter_pdb() -> None:
    """Give somebody who debugs a test all the time in the world."""
    if hasattr(signal, "SIGALRM"):
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    faulthandler.cancel_dump_traceback_later()


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Limit how long threads and devices keep a worker after its last test."""
    if hasattr(session.config, "workerinput"):
        end_later(session.config, AFTER_ALL)


def end_later(config: pytest.Config, seconds: float) -> None:
    """Print the stacks of all threads and end this process after that many seconds."""
    faulthandler.dump_traceback_later(seconds, exit=True, file=config.stash[_ERRORS])
