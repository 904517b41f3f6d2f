"""Checks graph files one after another, and finds the line of each problem."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

from halation.nodes import Node, catalogue
from msgspec import Struct
from msgspec.structs import replace

from .. import document
from ..document.disk import read_text
from ..document.positions import Positions
from ..errors import DocumentError, GraphError
from ..graph import Graph, Group, Problem
from ..graph.enough import MAX_FINDINGS, Enough
from ..graph.problems import find_problems
from ..graph.rules import RULES as GRAPH_RULES
from ..graph.rules import Rule
from ..resources.collection import pause_collection
from ..resources.sandbox import Sandbox
from ..resources.suggestions import limit_suggestions
from . import allowing, compiled, surroundings, texts
from .rules import CHECKS
from .sheet import GraphFacts, bodies

RULES: Mapping[str, Rule] = {
    rule.name: rule
    for rule in (
        *texts.READING,
        *GRAPH_RULES,
        *compiled.RULES,
        *(check.rule for check in CHECKS),
        *surroundings.RULES,
        texts.OLD_VERSION,
        texts.NOT_CANONICAL,
        *allowing.RULES,
    )
}
"""Every rule by its name."""

_OUTER = (*(rule.name for rule in (*surroundings.RULES, *compiled.RULES)), texts.OLD_VERSION.name)
"""Rules whose findings depend on more than the file."""


class Finding(Struct, frozen=True):
    """A problem of a file. `code` is the exit code that rendering would have; 0 for a warning."""

    line: int
    problem: Problem
    code: int

    @property
    def facts(self) -> dict[str, Any]:
        """The finding, ready for JSON."""
        return {
            "rule": self.problem.rule.name,
            "severity": self.problem.severity,
            "line": self.line,
            "node": self.problem.node,
            "socket": self.problem.socket,
            "sentence": self.problem.sentence,
        }


class CheckReport(Struct, frozen=True):
    """The findings in a file, sorted by line."""

    file: str
    findings: tuple[Finding, ...]
    more: bool = False
    """True if there may be others, which were not looked for. None of them is worse than those that are listed."""

    @property
    def code(self) -> int:
        """The worst exit code."""
        return max((finding.code for finding in self.findings), default=0)


class GraphChecker(Struct, dict=True, eq=False):
    """Checks files, without the rules in `off`. A file that several graphs name is read once."""

    sandbox: Sandbox
    off: frozenset[str] = frozenset()

    @cached_property
    def world(self) -> compiled.NotingProvider:
        """Facts about the files that graphs name."""
        return compiled.NotingProvider(self.sandbox)

    @cached_property
    def around(self) -> surroundings.Surroundings:
        """Facts about the folders that graphs name."""
        return surroundings.Surroundings(self.sandbox)

    @cached_property
    def types(self) -> Mapping[str, type[Node]]:
        """The installed node types."""
        return catalogue()

    def check_file(self, path: Path) -> CheckReport:
        """Check a graph file. Nothing is raised: a file that cannot be read is a finding."""
        try:
            text = read_text(path, sandbox=self.sandbox)
        except DocumentError as fault:
            return self._report(str(path), "", None, self._document_problem(fault, ""), Enough())
        return self.check_text(text, str(path), str(path.parent))

    def check_text(self, text: str, file: str, folder: str) -> CheckReport:
        """Check the text of a graph. Relative paths in it start at `folder`."""
        with limit_suggestions(), pause_collection():
            try:
                whole_graph = document.loads(text, file, folder, self.types, sandbox=self.sandbox)
            except DocumentError as fault:
                return self._report(file, text, None, self._document_problem(fault, file, text), Enough())
            enough = Enough()
            return self._report(file, text, whole_graph, self._find_problems(whole_graph, text, enough), enough)

    def _document_problem(self, fault: DocumentError, file: str, text: str = "") -> Iterator[tuple[Problem, int, int]]:
        problem, line = texts.explain_fault(fault, text)
        if file and fault.file != file:  # the fault is in the file of a group
            problem = replace(problem, sentence=str(fault), at="")
        yield problem, line if not file or fault.file == file else 0, fault.exit_code

    def _find_problems(self, whole_graph: Graph, text: str, enough: Enough) -> Iterator[tuple[Problem, int, int]]:
        """Problems, each with its line if its JSON path does not give the line, and its exit code."""
        has_errors = False
        for problem in find_problems(whole_graph, self.types, enough):
            is_error = problem.severity == "error"
            has_errors = has_errors or is_error
            yield problem, 0, GraphError.exit_code if is_error else 0
        for problem, line in texts.find_text_problems(whole_graph, text, self.types):
            yield problem, line, 0
        if has_errors:
            return
        for problem in self._find_warnings(whole_graph):
            if not enough.wants("warning"):
                break
            yield problem, 0, 0
        for code, problem in compiled.problems(whole_graph, self.world, enough):
            yield problem, 0, code

    def _find_warnings(self, whole_graph: Graph) -> Iterator[Problem]:
        """The warnings of rules, and of what lies beside the file, about a graph without errors."""
        for body, inside, at in bodies(whole_graph):
            sheet = GraphFacts(body)
            for check in CHECKS:
                for problem in check.find(sheet) if check.rule.name not in self.off else ():
                    node = f"{inside}{problem.node}" if problem.node else inside.removesuffix("/")
                    yield replace(problem, node=node, at=f"{at}{problem.at}" if problem.at else "")
        yield from self.around.problems(whole_graph)

    def _report(
        self,
        file: str,
        text: str,
        whole_graph: Graph | None,
        problems: Iterator[tuple[Problem, int, int]],
        enough: Enough,
    ) -> CheckReport:
        """The report of one file: allowed problems are left out, and no more are asked for than are wanted.

        An allowance is called stale only if its rule was sure to find what it allows: not a rule that is off or that
        depends on other files, and none at all where an error ended the check early.
        """
        reported, used, whole = list[tuple[Problem, int, int]](), set[str](), True
        allowing_graph = whole_graph if whole_graph is not None and whole_graph.settings.allow else None
        for item in problems:
            enough.seen += 1
            severity = item[0].severity
            if item[0].rule.name in self.off:
                continue
            if allowing_graph is not None and (entry := allowing.find_allowance(allowing_graph, item[0])):
                used.add(entry)
            elif enough.wants(severity):
                whole = whole and severity != "error"
                enough.count(severity)
                reported.append(item)
                if not enough.wants("error"):
                    break
        if allowing_graph is not None and allowing.STALE_ALLOW.name not in self.off:
            unsure = {*_OUTER, *self.off} if whole and not enough.stopped else RULES
            stale = [(problem, 0, 0) for problem in allowing.find_stale_allowances(allowing_graph, used, RULES, unsure)]
            reported += stale
        if not reported:
            return CheckReport(file, (), enough.stopped)
        chosen = _choose_worst(reported)
        places = [() if line else _find_places(whole_graph, problem) for problem, line, _ in chosen]
        has_double_key = any(problem.rule is texts.DOUBLE_KEY for problem, _, _ in chosen)
        lines = Positions(text, chain.from_iterable(places), first=not has_double_key)
        findings = [
            Finding(line or _line(lines, paths, problem), problem, code)
            for (problem, line, code), paths in zip(chosen, places, strict=True)
        ]
        is_cut = enough.stopped or len(chosen) < len(reported)
        return CheckReport(file, tuple(sorted(findings, key=_order)), is_cut)


def _choose_worst(reported: Iterable[tuple[Problem, int, int]]) -> list[tuple[Problem, int, int]]:
    """The worst of problems, each with its line and exit code; of equal ones the first."""
    return sorted(reported, key=lambda item: -item[2])[:MAX_FINDINGS]


def _order(finding: Finding) -> tuple[int, str, str, str]:
    problem = finding.problem
    return finding.line, problem.severity, problem.rule.name, problem.sentence


def _line(lines: Positions, paths: Sequence[str], problem: Problem) -> int:
    """The line of a problem that `paths` belong to."""
    if problem.at:
        return lines.line(problem.at, last=problem.rule is texts.DOUBLE_KEY)
    return lines.line(next((path for path in paths if path in lines), ""))


def _find_places(whole_graph: Graph | None, problem: Problem) -> tuple[str, ...]:
    """The JSON path of a problem, or possible paths of its node and socket, the most exact first."""
    if problem.at:
        return (problem.at,)
    if not problem.node and not problem.socket:
        return ()
    at, *rest = "", *problem.node.split("/")
    for name in rest[:-1]:
        item = whole_graph.nodes.get(name) if whole_graph else None
        whole_graph = item.graph if isinstance(item, Group) else None
        if isinstance(item, Group) and item.path:
            return (f"{at}nodes.{name}.path",)
        at = f"{at}nodes.{name}.graph."
    node = rest[-1]
    return (
        f"{at}nodes.{node}.values.{problem.socket}",
        f"{at}links.{node}.{problem.socket}",
        f"{at}{node}.{problem.socket}",
        f"{at}nodes.{node}",
        f"{at}{node}",
    )
