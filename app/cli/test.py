"""`halation test`: renders graphs and compares them with approved pictures."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from ..errors import UsageError
from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .options import AsJson, Cluster
from .outcome import print_json, print_note
from .watchdog import PoolWatchdog, Timeout, run_session

if TYPE_CHECKING:
    from ..regression.case_runner import RunOptions
    from ..regression.cases import Case
    from ..regression.parallel import CaseSharing, Supervisor
    from ..regression.results import Outcome

_MARKS = {"passed": "pass", "failed": "FAIL", "blessed": "new ", "skipped": "skip"}


_Suites = Annotated[
    list[Path] | None,
    typer.Argument(help="Suite files (*.suite.toml), or folders with suites; by default the current folder."),
]
_Select = Annotated[
    str,
    typer.Option(
        "-k", "--select", metavar="EXPR", help="Run only cases whose names match: words combined with and, or, not."
    ),
]
_Update = Annotated[
    bool, typer.Option("--update", help="Approve the new pictures: write goldens that are missing or that fail.")
]
_StopEarly = Annotated[bool, typer.Option("-x", "--exitfirst", help="Stop at the first failure.")]
_Jobs = Annotated[
    str,
    typer.Option(
        "-j",
        "--jobs",
        metavar="N|auto",
        help="Share the cases among this many processes; auto chooses as many as cases, cores and memory allow.",
    ),
]
_Listed = Annotated[bool, typer.Option("--list", help="Print the names of the cases without rendering.")]
_Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Write pictures of failures to this folder, as EXR and PNG."),
]
_Report = Annotated[
    Path | None,
    typer.Option("--report", metavar="FILE.html", help="Write an HTML page that shows the differences, in one file."),
]
_Junit = Annotated[
    Path | None, typer.Option("--junit", metavar="FILE.xml", help="Write the results as JUnit XML, for CI servers.")
]
_Deterministic = Annotated[
    bool,
    typer.Option(
        "--deterministic/--no-deterministic",
        help="Render with one fixed version of the software rasterizer, which gives the same bytes on every "
        "machine, or with the device of this machine.",
    ),
]


def test(
    suites: _Suites = None,
    select: _Select = "",
    update: _Update = False,
    stop_early: _StopEarly = False,
    jobs: _Jobs = "1",
    cluster: Cluster = "",
    listed: _Listed = False,
    out: _Out = None,
    report: _Report = None,
    junit: _Junit = None,
    deterministic: _Deterministic = True,
    as_json: AsJson = False,
    timeout: Timeout = DEFAULT_TIMEOUT,
    *,
    sandbox: Sandbox,
) -> int:
    """Compare renders with golden pictures.

    A suite file lists the graphs, their golden pictures and the tolerances; see docs/testing.md.
    """
    from ..regression.selection import select_cases
    from ..regression.suites import load_suites

    cases = select_cases(load_suites(suites or [Path()], sandbox), select)
    if listed:
        return _list_cases(cases, as_json)
    reports, processes = _ReportFiles(report, junit, as_json), parsing.parse_jobs(jobs)
    if not processes and not cluster:
        from ..regression.parallel import choose_processes

        processes = choose_processes(len(cases))

    def work(supervisor: Supervisor | None = None, share: CaseSharing | None = None) -> int:
        from ..regression.case_runner import RunOptions

        options = RunOptions(sandbox, update, out, pictures=report is not None, deterministic=deterministic)
        return _run_and_report(cases, options, processes, stop_early, reports, supervisor, share)

    if cluster:
        return _run_on_cluster(cluster, processes, timeout, lambda share: work(None, share))
    if processes == 1:
        return run_session(work, timeout, as_json)
    import tempfile

    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        return work(PoolWatchdog(Path(folder), timeout))


def _run_on_cluster(address: str, jobs: int, timeout: float, work: Callable[[CaseSharing], int]) -> int:
    """Run cases on the workers of a cluster."""
    from ..cluster.connection import open_client
    from ..regression.cluster_cases import share_cases

    if jobs != 1:
        raise UsageError("--cluster and -j: give one of them; --cluster local:4 has four workers on this machine")
    with open_client(address) as client:
        return work(lambda cases, options: share_cases(client, address, cases, options, timeout))


class _ReportFiles(NamedTuple):
    """Where the results go."""

    page: Path | None
    junit: Path | None
    as_json: bool


def _run_and_report(
    cases: tuple[Case, ...],
    options: RunOptions,
    jobs: int,
    stop_early: bool,
    files: _ReportFiles,
    supervisor: Supervisor | None,
    share: CaseSharing | None,
) -> int:
    """Run cases, write all reports, and return the exit code."""
    from ..regression.junit import write_junit
    from ..regression.parallel import run_cases
    from ..regression.report import check_report, write_report
    from ..regression.results import as_json as for_machines

    check_report(files.page, files.junit, sandbox=options.sandbox)
    session = run_cases(
        cases,
        options,
        jobs=jobs,
        stop_early=stop_early,
        report_outcome=None if files.as_json else _print_outcome,
        supervisor=supervisor,
        share=share,
    )
    if files.page is not None:
        write_report(session, files.page, sandbox=options.sandbox)
    if files.junit is not None:
        write_junit(session, files.junit, sandbox=options.sandbox)
    if files.as_json:
        print_json(for_machines(session))
    else:
        print_note(f"{session.device or 'nothing was rendered'}{'; deterministic' if session.deterministic else ''}")
        for sentence in filter(None, (session.remark, session.summary)):
            print_note(sentence)
    return 1 if session.count("failed") else 0


def _print_outcome(outcome: Outcome) -> None:
    print(_format_outcome(outcome), flush=True)  # should the process be ended, nothing of this is lost


def _list_cases(cases: tuple[Case, ...], as_json: bool) -> int:
    if as_json:
        print_json({"cases": [{"id": case.id, "graph": str(case.graph), "skip": case.skip} for case in cases]})
        return 0
    for case in cases:
        print(f"{case.id}{f'  (skipped: {case.skip})' if case.skip else ''}")
    return 0


def _format_outcome(outcome: Outcome) -> str:
    """A line about the result of a case, and for a failure a second line with the reason."""
    from ..regression.cases import format_number

    worst = outcome.worst
    measured = worst is not None and worst.value is not None and outcome.status == "passed"
    value = f"  {outcome.case.metric} {format_number(worst.value or 0.0)}" if worst is not None and measured else ""
    head = f"{_MARKS[outcome.status]}  {outcome.case.id}{value}  {outcome.seconds:.2f} s"
    sentence = outcome.sentence if outcome.status != "passed" else ""
    files = [path for check in outcome.checks for path in check.files]
    where = f"\n      pictures: {files[0].parent}" if files else ""
    return f"{head}{f'{chr(10)}      {sentence}' if sentence else ''}{where}"
