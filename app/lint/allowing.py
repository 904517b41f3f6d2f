"""Warnings that a graph file allows: `settings.allow` holds reasons by `rule`, or by `rule:node`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from ..graph import INPUTS, OUTPUTS, Graph, Problem, did_you_mean
from ..graph.problems import CONTROLS
from ..graph.rules import Rule

STALE_ALLOW = Rule(
    "stale-allow",
    "warning",
    "settings.allow allows a warning that does not exist: it was corrected since, the name is wrong, or "
    "it is an error.",
    "Remove the entry, or correct its name.",
)
RULES = (STALE_ALLOW,)


def place_name(problem: Problem) -> str:
    """The place of a problem as `rule:node` names it: `glow/bloom`, `inputs.beauty`; "" for the graph as a whole."""
    end = problem.node.rpartition("/")[2] in (INPUTS, OUTPUTS, CONTROLS)
    return f"{problem.node}.{problem.socket}" if end and problem.socket else problem.node


def find_allowance(graph: Graph, problem: Problem) -> str:
    """The entry of `settings.allow` that allows a warning, or ""."""
    if problem.severity == "error":
        return ""
    names = (problem.rule.name, f"{problem.rule.name}:{place_name(problem)}")
    return next((name for name in names if name in graph.settings.allow), "")


def find_stale_allowances(
    graph: Graph, used: Iterable[str], rules: Mapping[str, Rule], unsure: Iterable[str]
) -> Iterator[Problem]:
    """Entries that allow nothing. Entries of `unsure` rules are left out, since these rules depend on more than the
    file."""
    spent, silent = set(used), set(unsure)
    for entry in graph.settings.allow:
        name = entry.partition(":")[0]
        if name not in rules:
            fault = f"there is no rule '{name}'{did_you_mean(name, rules)}"
        elif rules[name].severity == "error":
            fault = "an error cannot be allowed"
        elif entry in spent or name in silent:
            continue
        else:
            fault = "nothing of that kind is left: remove it"
        yield Problem("", "", f"settings.allow, '{entry}': {fault}", STALE_ALLOW, f"settings.allow.{entry}")
