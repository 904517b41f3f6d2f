"""Hints while a graph is edited: what costs quality, not what is merely unfinished."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import islice

from halation.nodes import Node, Trait
from msgspec.structs import replace

from ..graph import Graph, Problem, problems
from ..graph.enough import MAX_FINDINGS
from ..graph.problems import differ_in_nodes, recheck
from .allowing import find_allowance
from .rules import data, filtering, light
from .sheet import GraphFacts, bodies, has_trait

_CHECKS = (*filtering.CHECKS, *light.CHECKS, *data.CHECKS)


def find_remarks(graph: Graph, types: Mapping[str, type[Node]]) -> tuple[Problem, ...]:
    """The problems of a graph. If it has no errors, also the hints, for groups in its file too."""
    graph_problems = problems(graph, types)
    if any(problem.severity == "error" for problem in graph_problems):
        return graph_problems
    return (
        *graph_problems,
        *sorted(islice(_hints(graph), MAX_FINDINGS), key=lambda item: (item.node, item.socket, item.sentence)),
    )


def recheck_remarks(
    graph: Graph, before: Graph, last_problems: tuple[Problem, ...], types: Mapping[str, type[Node]]
) -> tuple[Problem, ...]:
    """The same as `remarks(graph)`, from its result for an earlier graph `before`: fast while a value is dragged."""
    if differ_in_nodes(graph, before) and _same_roles(graph, before):
        rechecked_problems = recheck(graph, before, last_problems, types)
        if rechecked_problems is last_problems:
            return last_problems
    return find_remarks(graph, types)


def _hints(graph: Graph) -> Iterator[Problem]:
    for body, inside, _ in bodies(graph):
        sheet = GraphFacts(body)
        for check in _CHECKS:
            for problem in check.find(sheet):
                hint = replace(problem, node=f"{inside}{problem.node}")
                if not find_allowance(graph, hint):
                    yield hint


def _same_roles(graph: Graph, before: Graph) -> bool:
    """True if the same nodes are active as before, with the same links."""
    changed = ((item, before.nodes[id]) for id, item in graph.nodes.items() if item is not before.nodes[id])
    return graph.muted == before.muted and all(
        isinstance(new, Node) and isinstance(old, Node) and _same_role(new, old) for new, old in changed
    )


def _same_role(new: Node, old: Node) -> bool:
    if has_trait(new, Trait.RESAMPLES):  # hints contain their numbers
        return False
    texts = (name for name, value in new.values.items() if value.type in ("path", "text", "choice"))
    same = type(new) is type(old) and all(new.setting(name) == old.setting(name) for name in texts)
    return same and (new.identity() is None) == (old.identity() is None)
