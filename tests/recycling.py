"""A worker runs its tests in a child, and takes another child when that one has grown.

Windows, drivers and fragments of memory make a process that runs tests larger from file to file, to several gigabytes,
and a worker cannot begin anew: it takes 40 seconds to collect all tests. Its children can. Each is a copy of the worker
as it was when nothing but tests had been read: it runs files of tests until it is large, and tells the worker what came
of them. A child that crashes, or that a time limit ends, costs its own test and no more.

A copy has no thread but the one that made it, and would wait for the locks of others for ever. So the worker itself
opens no picture and no device: numpy's library ends its threads before it is copied, and the thread that listens to
the process in charge holds no lock that a test needs.
"""

from __future__ import annotations

import os
import sys
import traceback
import warnings
from contextlib import suppress
from multiprocessing.connection import Connection, Pipe, wait
from pathlib import Path
from typing import Any

import pytest
from _pytest.runner import runtestprotocol
from children import MARK, end_process, list_marked

LARGE = 680
"""MiB of memory of a child above which another one runs the next file of tests. Half a gigabyte of it is what the
worker has read."""

MARGIN = 150
"""More MiB, above which another one runs the rest of a file, where it makes anew what the tests of the file share."""

_RUNNER = pytest.StashKey["ChildRunner"]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option that tests of the children lower."""
    parser.addini("child_memory", "MiB of a child above which another one runs the next file", default=LARGE)


def pytest_configure(config: pytest.Config) -> None:
    """Workers have children on Linux. A process without workers runs its tests itself, for whoever debugs them."""
    config.addinivalue_line("markers", "large: takes hundreds of MiB, so it begins in a small process")
    if hasattr(config, "workerinput") and sys.platform == "linux":
        config.stash[_RUNNER] = ChildRunner(config)
        config.pluginmanager.register(config.stash[_RUNNER])


def has_children(config: pytest.Config) -> bool:
    """Whether the tests of this process run in another one."""
    runner = config.stash.get(_RUNNER, None)
    return runner is not None and not runner.is_child


class ChildRunner:
    """Runs tests in the child of the moment; in the child, runs them."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._places: dict[pytest.Item, int] = {}
        self._child: TestChild | None = None
        self._reports: list[pytest.TestReport] = []
        self.is_child = False

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item, nextitem: pytest.Item | None) -> bool:
        """Run a test and report it."""
        if self.is_child:
            self._reports = runtestprotocol(item, log=False, nextitem=nextitem)
            return True
        item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
        for report in self._run_in_child(item, nextitem):
            item.ihook.pytest_runtest_logreport(report=report)
        item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
        return True

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self) -> None:
        """End the last child, with what its tests share."""
        if self._child:
            self._child.end()

    def _run_in_child(self, item: pytest.Item, nextitem: pytest.Item | None) -> list[pytest.TestReport]:
        self._places = self._places or {each: place for place, each in enumerate(item.session.items)}
        self._child = self._child or self._start_child(item.session)
        answer = self._child.ask(self._places[item], self._places[nextitem] if nextitem else None)
        if isinstance(answer, str):
            code = self._child.end()
            self._child = None
            for number in list_marked(os.environ[MARK]):
                end_process(number)
            return [_make_crash_report(item, code, answer)]
        reports, is_last = answer
        if is_last:
            self._child.end()
            self._child = None
        read = self._config.hook.pytest_report_from_serializable
        return [read(config=self._config, data=report) for report in reports]

    def _start_child(self, session: pytest.Session) -> TestChild:
        ours, theirs = Pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of threads: see above
            number = os.fork()
        if number:
            theirs.close()
            return TestChild(number, ours)
        ours.close()
        code = 1
        try:
            self._serve(session, theirs)
            code = 0
        except BaseException:
            theirs.send(traceback.format_exc())
        finally:
            os._exit(code)

    def _serve(self, session: pytest.Session, worker: Connection) -> None:
        """Be the child: run what the worker asks for."""
        self.is_child = True
        for plugin in self._config.pluginmanager.get_plugins():
            if hasattr(plugin, "sendevent"):  # only the worker talks to the process in charge
                self._config.pluginmanager.unregister(plugin)
        items, hook = session.items, self._config.hook
        while (order := worker.recv()) is not None:
            item, nextitem = items[order[0]], None if order[1] is None else items[order[1]]
            hook.pytest_runtest_protocol(item=item, nextitem=nextitem)
            is_last = nextitem is None or self._ends_before(item, nextitem)
            if is_last:
                session._setupstate.teardown_exact(None)
            write = hook.pytest_report_to_serializable
            worker.send(([write(config=self._config, report=report) for report in self._reports], is_last))
        session._setupstate.teardown_exact(None)

    def _ends_before(self, item: pytest.Item, nextitem: pytest.Item) -> bool:
        """Whether this process has too much memory for the next test: more within a file than for another one."""
        if nextitem.get_closest_marker("large"):
            return True
        margin = 0 if nextitem.path != item.path else MARGIN
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") > 2**20 * (float(self._config.getini("child_memory")) + margin)


class TestChild:
    """A process that runs tests, as its worker sees it."""

    __test__ = False

    def __init__(self, number: int, connection: Connection) -> None:
        self._number, self._connection = number, connection
        self._ending = os.pidfd_open(number)

    def ask(self, place: int, next_place: int | None) -> Any:
        """The reports of a test and whether the child ends with it; why it has ended before, where it could say so."""
        try:
            self._connection.send((place, next_place))
            wait([self._connection, self._ending])
            return self._connection.recv() if self._connection.poll() else ""
        except (EOFError, OSError):
            return ""

    def end(self) -> int:
        """Let the child end; its exit code, or the number of the signal that ended it, negative."""
        with suppress(OSError):  # it may have ended
            self._connection.send(None)
        self._connection.close()
        os.close(self._ending)
        return os.waitstatus_to_exitcode(os.waitpid(self._number, 0)[1])


def _make_crash_report(item: pytest.Item, code: int, reason: str) -> pytest.TestReport:
    sentence = f"the process crashed while running '{item.nodeid}' (exit code {code})\n{reason}"
    return pytest.TestReport(item.nodeid, item.location, {}, "failed", sentence, "call")
