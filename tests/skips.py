"""Why a test may be skipped: every reason is here, and one for which something is missing fails in CI.

A test that is skipped everywhere proves nothing, and nobody notices. So a reason that is not listed is a failure.
"""

from __future__ import annotations

import os
from collections.abc import Generator
from typing import Literal, TypeVar

import pytest

Cause = Literal["system", "case", "tool"]
Report = TypeVar("Report", pytest.TestReport, pytest.CollectReport)

REASONS: dict[str, Cause] = {
    "the superuser may read everything": "system",
    "it lists the processes of": "system",
    "this driver rounds for itself": "system",
    "links need": "system",
    "POSIX": "system",
    "no such device here": "system",
    "nobody knows how much memory there is": "system",
    "this system has no": "system",
    "fork and SIGKILL": "system",
    "names of files are bytes on Linux only": "system",
    "needs /dev/full": "system",
    "only Linux keeps to it": "system",
    "the guide was made on Linux": "system",
    "signals and limits": "system",
    "folders have no such mode": "system",
    "needs root": "system",
    "tried nightly": "case",
    "another user cannot run this checkout": "system",
    "this machine does not let us mount": "system",
    "a Mac or Windows always has a display": "system",
    "needs a device that is always full": "system",
    "the super-user may write anywhere": "system",
    "rights are not modes there": "system",
    "dev is a shell script": "system",
    "other systems bring OpenGL": "system",
    "pyright finds the package through symbolic links, which this system refuses": "system",
    "Windows has no SIGALRM": "system",
    "frames that need others are made whole": "case",
    "makes pictures": "case",
    "makes the guide": "case",
    "libjpeg ends the process of whoever writes it": "case",
    "it is never part of a drag": "case",
    "Dask is not installed": "tool",
    "check-jsonschema is not installed": "tool",
    "cyclonedx-bom is not installed": "tool",
    "PyAV is not installed": "tool",
    "pyoidn is not installed": "tool",
    "this PyAV has no encoder": "tool",
    "git is not installed": "tool",
    "not installed as a command": "tool",
    "glslangValidator is not installed": "tool",
    "gdtoolkit is not installed": "tool",
    "Mono is not installed": "tool",
    "slangpy is not installed": "tool",
    "there is no driver of Vulkan": "tool",
    "there is no driver named": "tool",
    "no newer Mesa is unpacked": "tool",
    "vkBasalt or Xvfb is not installed": "tool",
    "uv is not installed": "tool",
    "Chromium is not installed": "tool",
    "axe-playwright-python is not installed": "tool",
}
"""How a reason begins, and what it is due to: the system, a case without anything to test, or a missing tool."""


def find_cause(reason: str) -> Cause | None:
    """What a skip is due to; None for a reason that is not listed."""
    return next((cause for start, cause in REASONS.items() if reason.startswith(start)), None)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Judge the skip of a test."""
    return judge_skip((yield))


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Judge the skip of a module."""
    return judge_skip((yield))


def judge_skip(report: Report) -> Report:
    """The report of what is skipped without a listed reason, or for want of a tool in CI, as a failure."""
    if report.skipped and isinstance(report.longrepr, tuple):
        reason = report.longrepr[2].removeprefix("Skipped: ")
        cause = find_cause(reason)
        if cause is None or (cause == "tool" and os.environ.get("CI") == "true"):
            report.outcome = "failed"
            advice = "install it" if cause == "tool" else "list the reason in tests/skips.py"
            report.longrepr = f"{report.nodeid} is skipped ({reason}): {advice}"
    return report
