"""What is wrong with a graph, and which element of the canvas shows it."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Node

from ...graph import INPUTS, OUTPUTS, Graph, Problem
from ...lint.live import find_remarks, recheck_remarks
from .memo import Memo


def find_problems(memo: Memo, name: str, graph: Graph, types: Mapping[str, type[Node]]) -> tuple[Problem, ...]:
    """The problems of a graph, starting from those that were found last under that name: most nodes did not change."""
    before, problems = memo.last(name)
    old_graph, old_types = before or (None, None)

    def compute() -> tuple[Problem, ...]:
        if isinstance(old_graph, Graph) and old_types is types:
            return recheck_remarks(graph, old_graph, problems, types)
        return find_remarks(graph, types)

    return memo.get(name, (graph, types), compute)


def sort_problems(problems: tuple[Problem, ...], elements: tuple[str, ...]) -> Mapping[str, tuple[Problem, ...]]:
    """Problems by the key of the element that shows them, in the order in which they were found."""
    by_key: dict[str, tuple[Problem, ...]] = {}
    for problem in problems:
        node = problem.node.partition("/")[0]
        key = f"{node}.{problem.socket}" if node in (INPUTS, OUTPUTS) else node
        key = key if key in elements else ""
        by_key[key] = (*by_key.get(key, ()), problem)
    return by_key
