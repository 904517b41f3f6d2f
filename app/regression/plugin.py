"""A pytest plug-in: every case of a `*.suite.toml` file is a test. Nothing is loaded until there is such a file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from .case_runner import RunOptions
    from .cases import Case

_ENDING = ".suite.toml"


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options of the plugin."""
    group = parser.getgroup("halation", "graphs and golden pictures")
    group.addoption(
        "--halation-update",
        action="store_true",
        default=False,
        help="bless: write golden pictures that are missing or that fail",
    )
    group.addoption(
        "--halation-out", metavar="DIR", default=None, help="leave pictures of failures here (default: a temporary one)"
    )


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """The suite files, recognized by their names."""
    return SuiteFile.from_parent(parent, path=file_path) if file_path.name.endswith(_ENDING) else None  # pyright: ignore[reportUnknownMemberType]


class CaseFailure(Exception):
    """A case that failed, in one sentence."""


class SuiteFile(pytest.File):
    """The cases of one suite."""

    def collect(self) -> Iterator[pytest.Item]:
        """Every case as a test."""
        from ..errors import HalationError
        from ..resources.sandbox import read_process_sandbox
        from .suites import load_suite

        try:
            cases = load_suite(self.path, read_process_sandbox())
        except HalationError as fault:
            raise self.CollectError(str(fault)) from None
        for case in cases:
            yield CaseItem.from_parent(self, name=case.name, case=case)  # pyright: ignore[reportUnknownMemberType]


class CaseItem(pytest.Item):
    """One case."""

    def __init__(self, *, case: Case, **options: Any) -> None:
        super().__init__(**options)
        self.case = case

    def runtest(self) -> None:
        """Render and compare. Raises Failure."""
        from .parallel import run_in_process

        outcome = run_in_process(self.case, self._how())
        for check in outcome.checks:
            self.user_properties += [("picture", str(path)) for path in check.files]
        if outcome.status == "skipped":
            pytest.skip(outcome.sentence)
        if outcome.status == "blessed":
            self.add_report_section("call", "halation", f"blessed: {outcome.sentence}")
        if outcome.status == "failed":
            files = [path for check in outcome.checks for path in check.files]
            where = f"\npictures: {files[0].parent}" if files else ""
            raise CaseFailure(f"{outcome.sentence}{where}")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The sentence alone: the traceback does not matter."""
        return str(excinfo.value) if isinstance(excinfo.value, CaseFailure) else super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """The place of a failure in pytest's report."""
        return self.path, None, f"{self.path.name}::{self.name}"

    def _how(self) -> RunOptions:
        from ..resources.sandbox import read_process_sandbox
        from .case_runner import RunOptions

        update, out = self.config.getoption("--halation-update"), self.config.getoption("--halation-out")
        if out is None:
            out = self.config.cache.mkdir("halation") if self.config.cache else None
        return RunOptions(read_process_sandbox(), bool(update), Path(str(out)) if out else None)
