"""`halation check`: everything that `render` would refuse, without rendering, and what could be better."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..version import VERSION
from .options import AsJson, standard_input
from .outcome import note, print_json
from .plugins import note_refused_plugins, refused_plugins

if TYPE_CHECKING:
    from ..graph.rules import Rule
    from ..lint.checking import CheckReport, Finding, GraphChecker

_REFUSED = 3
"""What `--strict` makes of a warning: the graph is at fault."""


def check(
    graphs: Annotated[
        list[Path] | None,
        typer.Argument(help="Graphs, as JSON; folders for all graphs in them and below; patterns such as '**/*.json'."),
    ] = None,
    off: Annotated[
        list[str] | None, typer.Option("--off", metavar="RULE", help="Leave out a rule, any number of times.")
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Fail for warnings too.")] = False,
    rules: Annotated[bool, typer.Option("--rules", help="List all rules and stop.")] = False,
    sarif: Annotated[
        str, typer.Option(metavar="FILE|-", help="Write a SARIF 2.1.0 log, for code hosts; - to standard output.")
    ] = "",
    as_json: AsJson = False,
) -> int:
    """Look for faults in graphs: schema, types, links, loops, ranges, files and layers, and habits that cost."""
    from ..errors import UsageError
    from ..lint.checking import RULES, GraphChecker

    if rules:
        _list(RULES, as_json)
        return 0
    if not graphs:
        raise UsageError("no graph is given: name files, folders or patterns; see halation check --help")
    if as_json and sarif == "-":
        raise UsageError("--json and --sarif -: both would go to standard output; choose one, or name a file")
    checker = GraphChecker(frozenset(_check_rules(off or (), RULES)))
    reports = _reports(checker, graphs, quiet=as_json or sarif == "-")
    if sarif:
        _write_sarif(reports, RULES, sarif)
    if as_json:
        refused = refused_plugins()
        also = {"refused_plugins": refused} if refused else {}
        print_json({"graphs": [_report_facts(report, strict) for report in reports], **also})
    else:
        note_refused_plugins()
    return max((_code(report, strict) for report in reports), default=0)


def _reports(checker: GraphChecker, graphs: Sequence[Path], quiet: bool) -> list[CheckReport]:
    """Check one after the other; say at once what is found."""
    from ..lint.files import find_graphs

    reports: list[CheckReport] = []
    for path in find_graphs(graphs):
        text = standard_input() if str(path) == "-" else None
        report = checker.check_file(path) if text is None else checker.check_text(text, "-", "")
        reports.append(report)
        for finding in () if quiet else report.findings:
            problem = finding.problem
            sentence, *picture = problem.sentence.split("\n")  # of an expression, where in it the fault is
            print(f"{path}:{finding.line}: {problem.severity}: {sentence} [{problem.rule.name}]", *picture, sep="\n")
        if not quiet and not report.findings and path in graphs:
            print(f"{path}: ok")
    if not reports:
        note("there are no graphs")
    elif len(reports) > 1 and not quiet:
        severities = [finding.problem.severity for report in reports for finding in report.findings]
        counts = [f"{severities.count(word)} {word}s" for word in ("error", "warning")]
        note(f"{len(reports)} graphs: {', '.join(counts)}")
    return reports


def _check_rules(names: Sequence[str], rules: Mapping[str, Rule]) -> Sequence[str]:
    from ..errors import UsageError
    from ..graph import did_you_mean

    for name in names:
        if name not in rules:
            raise UsageError(f"--off {name}: there is no such rule{did_you_mean(name, rules)}; see check --rules")
    return names


def _list(rules: Mapping[str, Rule], as_json: bool) -> None:
    if as_json:
        told = [
            {"rule": rule.name, "severity": rule.severity, "doc": rule.doc, "help": rule.way_out}
            for rule in rules.values()
        ]
        print_json({"rules": told})
        return
    for rule in rules.values():
        print(f"{rule.name} ({rule.severity}): {rule.doc} {rule.way_out}")


def _code(report: CheckReport, strict: bool) -> int:
    return report.code or (_REFUSED if strict and report.findings else 0)


def _report_facts(report: CheckReport, strict: bool) -> dict[str, Any]:
    def problem(finding: Finding) -> dict[str, Any]:
        problem_found = finding.problem
        return {
            "rule": problem_found.rule.name,
            "severity": problem_found.severity,
            "line": finding.line,
            "node": problem_found.node,
            "socket": problem_found.socket,
            "sentence": problem_found.sentence,
        }

    return {
        "graph": report.file,
        "exit_code": _code(report, strict),
        "problems": [problem(finding) for finding in report.findings],
    }


def _write_sarif(reports: Sequence[CheckReport], rules: Mapping[str, Rule], file: str) -> None:
    """Paths in the log start at the repository that this folder is in, else at this folder."""
    from ..lint.sarif import sarif
    from ..lint.surroundings import Surroundings
    from ..resources.atomic_write import write_text_atomically

    here = Path.cwd()
    log = sarif(reports, rules, Surroundings().root(here) or here, VERSION)
    if file == "-":
        print_json(log)
    else:
        write_text_atomically(Path(file), json.dumps(log, indent=2, ensure_ascii=False) + "\n")
