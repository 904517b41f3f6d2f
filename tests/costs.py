"""What the tests cost: processor time of each, its child processes included, and the memory of each worker.

`--costs FILE` writes the table and prints its largest rows; `.ci/run` asks for it. Processor time says more than time
on the clock, which depends on what else the machine does.
"""

from __future__ import annotations

import json
import os
import sys
from collections import defaultdict
from collections.abc import Generator
from contextlib import suppress
from pathlib import Path

import pytest
from selection import LIST, list_slow

SHOWN = 20
"""The most rows that are printed."""

GROWN = 8
"""The most tests that are printed because a worker's peak of memory grew in them."""

_START = pytest.StashKey[float]()


class CostTable:
    """The costs of all tests, in the process that collects the reports."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._seconds: dict[str, float] = {}
        self._memory = defaultdict[str, int](int)
        self._growth: dict[str, int] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Add the costs of a test that has ended."""
        if report.when == "teardown":
            costs = dict(report.user_properties)
            self._seconds[report.nodeid] = round(float(str(costs.get("processor seconds", 0.0))), 3)
            worker = getattr(getattr(report, "node", None), "gateway", None)
            name = worker.id if worker else "this process"
            peak = int(str(costs.get("peak bytes", 0)))
            if self._memory[name]:
                self._growth[report.nodeid] = peak - self._memory[name]
            self._memory[name] = max(self._memory[name], peak)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Print the costs and write them to the file."""
        slowest = sorted(self._seconds.items(), key=lambda entry: -entry[1])
        terminalreporter.section(f"the {SHOWN} tests that take most processor time")
        for name, seconds in slowest[:SHOWN]:
            terminalreporter.write_line(f"{seconds:8.1f} s  {name}")
        peaks = ", ".join(f"{name} {peak / 2**20:.0f} MiB" for name, peak in sorted(self._memory.items()))
        terminalreporter.write_line(f"together {sum(self._seconds.values()):.0f} s; peak memory: {peaks}")
        for name, growth in sorted(self._growth.items(), key=lambda entry: -entry[1])[:GROWN]:
            terminalreporter.write_line(f"{growth / 2**20:8.0f} MiB more in  {name}")
        table = {
            "seconds": dict(sorted(self._seconds.items())),
            "peak_bytes": dict(self._memory),
            "growth_bytes": {name: growth for name, growth in sorted(self._growth.items()) if growth > 0},
        }
        self._path.write_text(json.dumps(table, indent=1) + "\n", "utf-8")
        if os.environ.get("HALATION_RENEW"):
            LIST.write_text("".join(f"{name}\n" for name in list_slow(self._seconds)), "utf-8")


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option that asks for the table."""
    parser.addoption("--costs", metavar="FILE", help="write what each test costs, and print what costs most")


def pytest_configure(config: pytest.Config) -> None:
    """Collect costs where they were asked for, unless another process collects them."""
    if (path := config.getoption("--costs")) and not hasattr(config, "workerinput"):
        config.pluginmanager.register(CostTable(Path(path).absolute()))


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> Generator[None, None, None]:
    """Note when a test begins."""
    item.stash[_START] = processor_seconds()
    return (yield)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_teardown(item: pytest.Item) -> Generator[None, None, None]:
    """Note what a test has cost."""
    try:
        return (yield)
    finally:
        if item.config.getoption("--costs"):
            seconds = processor_seconds() - item.stash.get(_START, processor_seconds())
            item.user_properties += [("processor seconds", seconds), ("peak bytes", peak_memory())]


def processor_seconds() -> float:
    """Seconds of processor time that this process and its ended children have used."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def peak_memory() -> int:
    """The most bytes that this process has had in memory; 0 where the system does not say.

    Linux hands a new process the peak of its parent under `getrusage`, but not in its status.
    """
    if sys.platform == "win32":
        return 0
    with suppress(OSError):
        peaks = (line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM:"))
        return int(next(peaks).split()[1]) * 1024
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
