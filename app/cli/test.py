"""`halation test`: graphs against the pictures that they must give."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .options import AsJson
from .outcome import note, print_json

if TYPE_CHECKING:
    from ..regression.cases import Case
    from ..regression.results import Outcome

_MARKS = {"passed": "pass", "failed": "FAIL", "blessed": "new ", "skipped": "skip"}


def test(
    suites: Annotated[
        list[Path] | None, typer.Argument(help="Suites (*.suite.toml), or folders with some; by default this folder.")
    ] = None,
    select: Annotated[
        str, typer.Option("-k", "--select", metavar="EXPR", help="Only cases whose names fit: words with and, or, not.")
    ] = "",
    update: Annotated[
        bool, typer.Option("--update", help="Bless: write goldens that are missing or fail as they are rendered now.")
    ] = False,
    stop_early: Annotated[bool, typer.Option("-x", "--exitfirst", help="Stop at the first failure.")] = False,
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="Processes that share the cases.")] = 1,
    listed: Annotated[bool, typer.Option("--list", help="Print the names of the cases and render nothing.")] = False,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Leave pictures of failures here, as EXR and as PNG.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option("--report", metavar="FILE.html", help="A page to look at what differs, in one file.")
    ] = None,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE.xml", help="The outcome as JUnit XML, for CI servers.")
    ] = None,
    deterministic: Annotated[
        bool,
        typer.Option(
            "--deterministic/--no-deterministic",
            help="Pin the software rasterizer, so that every machine gives the same bytes, or take what is there.",
        ),
    ] = True,
    as_json: AsJson = False,
) -> int:
    """Render graphs and compare with golden pictures; see docs/testing.md for the files that say what and how."""
    from ..regression.selection import select_cases
    from ..regression.suites import load_suites

    cases = select_cases(load_suites(suites or [Path()]), select)
    if listed:
        return _list_cases(cases, as_json)
    from ..regression.case_runner import RunOptions
    from ..regression.junit import write_junit
    from ..regression.parallel import run_cases
    from ..regression.report import check_report, write_report
    from ..regression.results import as_json as for_machines

    check_report(report, junit)
    how = RunOptions(update, out, pictures=report is not None, deterministic=deterministic)
    session = run_cases(
        cases, how, jobs=jobs, stop_early=stop_early, hears=None if as_json else lambda outcome: print(_line(outcome))
    )
    if report is not None:
        write_report(session, report)
    if junit is not None:
        write_junit(session, junit)
    if as_json:
        print_json(for_machines(session))
    else:
        note(f"{session.device or 'nothing was rendered'}{'; deterministic' if session.deterministic else ''}")
        for sentence in filter(None, (session.remark, session.summary)):
            note(sentence)
    return 1 if session.count("failed") else 0


def _list_cases(cases: tuple[Case, ...], as_json: bool) -> int:
    if as_json:
        print_json({"cases": [{"id": case.id, "graph": str(case.graph), "skip": case.skip} for case in cases]})
        return 0
    for case in cases:
        print(f"{case.id}{f'  (skipped: {case.skip})' if case.skip else ''}")
    return 0


def _line(outcome: Outcome) -> str:
    """One line of what became of a case; a sentence follows where there is one to say."""
    from ..regression.cases import format_number

    worst = outcome.worst
    measured = worst is not None and worst.value is not None and outcome.status == "passed"
    value = f"  {outcome.case.metric} {format_number(worst.value or 0.0)}" if worst is not None and measured else ""
    head = f"{_MARKS[outcome.status]}  {outcome.case.id}{value}  {outcome.seconds:.2f} s"
    sentence = outcome.sentence if outcome.status != "passed" else ""
    files = [path for check in outcome.checks for path in check.files]
    where = f"\n      pictures: {files[0].parent}" if files else ""
    return f"{head}{f'{chr(10)}      {sentence}' if sentence else ''}{where}"
