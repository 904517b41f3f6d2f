"""`halation check`: finds faults in graphs without rendering them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.sandbox import Sandbox
from ..version import VERSION
from .options import AsJson, expand_preset, read_standard_input
from .outcome import print_json, print_note, write_count
from .plugins import describe_refused_plugins, print_refused_plugins

if TYPE_CHECKING:
    from ..graph.rules import Rule
    from ..lint.checking import CheckReport, GraphChecker

_REFUSED = 3
"""The exit code of a warning under `--strict`: that of an invalid graph."""


def check(
    graphs: Annotated[
        list[Path] | None,
        typer.Argument(
            parser=expand_preset,
            metavar="[GRAPHS...]",
            help="Graph files (JSON), names of presets, folders with graphs in them or below, or patterns such as "
            "'**/*.json'.",
        ),
    ] = None,
    off: Annotated[
        list[str] | None, typer.Option("--off", metavar="RULE", help="Skip a rule; may be repeated.")
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 for warnings too.")] = False,
    rules: Annotated[bool, typer.Option("--rules", help="List all rules and exit.")] = False,
    sarif: Annotated[
        str,
        typer.Option(
            metavar="FILE|-", help="Write the findings as SARIF 2.1.0, which code hosts read; - for standard output."
        ),
    ] = "",
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Find faults in graphs without rendering.

    Checks the file format, types, links, loops, ranges, files and layers, and warns of what costs quality or time.
    """
    from ..errors import UsageError
    from ..lint.checking import RULES, GraphChecker

    if rules:
        _list_rules(RULES, as_json)
        return 0
    if not graphs:
        raise UsageError("no graph is given: name files, folders or patterns; see halation check --help")
    if as_json and sarif == "-":
        raise UsageError("--json and --sarif -: both write to standard output; choose one, or name a file for --sarif")
    checker = GraphChecker(sandbox, frozenset(_check_rules(off or (), RULES)))
    reports = _check_and_print(checker, graphs, quiet=as_json or sarif == "-")
    if sarif:
        _write_sarif(reports, RULES, sarif, sandbox=sandbox)
    if as_json:
        plugin_facts = describe_refused_plugins()
        print_json({"graphs": [_report_facts(report, strict) for report in reports], **plugin_facts})
    else:
        print_refused_plugins()
    return max((_exit_code(report, strict) for report in reports), default=0)


def _check_and_print(checker: GraphChecker, graphs: Sequence[Path], quiet: bool) -> list[CheckReport]:
    """Check one graph after the other, and print the findings of each at once."""
    from ..lint.files import find_graphs

    reports: list[CheckReport] = []
    is_named = False
    for path in find_graphs(graphs, checker.sandbox):
        text = read_standard_input() if str(path) == "-" else None
        report = checker.check_file(path) if text is None else checker.check_text(text, "-", "")
        reports.append(report)
        is_named = path in graphs
        for finding in () if quiet else report.findings:
            problem = finding.problem
            sentence, *excerpt = problem.sentence.split("\n")  # an excerpt shows where in an expression the fault is
            is_read = problem.rule.name != "unreadable-graph"
            place = f"{path}:{finding.line}" if is_read else path
            print(f"{place}: {problem.severity}: {sentence} [{problem.rule.name}]", *excerpt, sep="\n")
        if report.more and not quiet:
            print(f"{path}: {len(report.findings):,} findings are listed, there may be more")
        if not quiet and not report.findings and is_named:
            print(f"{path}: ok")
    if not reports:
        print_note("no graphs were found")
    elif (len(reports) > 1 or not is_named) and not quiet:
        severities = [finding.problem.severity for report in reports for finding in report.findings]
        counts = [write_count(severities.count(word), word) for word in ("error", "warning")]
        more = ", and there may be more" if any(report.more for report in reports) else ""
        print_note(f"{write_count(len(reports), 'graph')}: {', '.join(counts)}{more}")
    return reports


def _check_rules(names: Sequence[str], rules: Mapping[str, Rule]) -> Sequence[str]:
    from ..errors import UsageError
    from ..graph import did_you_mean

    for name in names:
        if name not in rules:
            raise UsageError(f"--off {name}: there is no such rule{did_you_mean(name, rules)}; see check --rules")
    return names


def _list_rules(rules: Mapping[str, Rule], as_json: bool) -> None:
    if as_json:
        rule_facts = [
            {"rule": rule.name, "severity": rule.severity, "doc": rule.doc, "help": rule.way_out}
            for rule in rules.values()
        ]
        print_json({"rules": rule_facts})
        return
    for rule in rules.values():
        print(f"{rule.name} ({rule.severity}): {rule.doc} {rule.way_out}")


def _exit_code(report: CheckReport, strict: bool) -> int:
    return report.code or (_REFUSED if strict and report.findings else 0)


def _report_facts(report: CheckReport, strict: bool) -> dict[str, Any]:
    return {
        "graph": report.file,
        "exit_code": _exit_code(report, strict),
        "problems": [finding.facts for finding in report.findings],
        **({"more": True} if report.more else {}),
    }


def _write_sarif(reports: Sequence[CheckReport], rules: Mapping[str, Rule], file: str, sandbox: Sandbox) -> None:
    """Write the SARIF log, with paths relative to the repository of the current folder, or else to that folder."""
    from ..lint.sarif import sarif
    from ..lint.surroundings import Surroundings
    from ..resources.atomic_write import write_text_atomically

    here = Path.cwd()
    log = sarif(reports, rules, Surroundings(sandbox).root(here) or here, VERSION)
    if file == "-":
        print_json(log)
    else:
        write_text_atomically(Path(file), json.dumps(log, indent=2, ensure_ascii=False) + "\n", sandbox=sandbox)
