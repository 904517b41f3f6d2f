"""The problems of a graph, and which element of the canvas shows them."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from halation.nodes import Node

from ...graph import Graph, Port, Problem
from ...lint.live import find_remarks, recheck_remarks
from ..edits.element_id import NO_ELEMENT, ElementId
from .memo import Memo


def find_problems(memo: Memo, name: str, graph: Graph, types: Mapping[str, type[Node]]) -> tuple[Problem, ...]:
    """The problems of a graph; nodes that did not change since the last call with this name are not checked again."""
    before, problems = memo.last(name)
    old_graph, old_types = before or (None, None)

    def compute() -> tuple[Problem, ...]:
        if isinstance(old_graph, Graph) and old_types is types:
            return recheck_remarks(graph, old_graph, problems, types)
        return find_remarks(graph, types)

    return memo.get(name, (graph, types), compute)


def sort_problems(
    problems: tuple[Problem, ...], elements: Collection[ElementId]
) -> Mapping[ElementId, tuple[Problem, ...]]:
    """Problems by the element that shows them, in the order in which they were found; others under the empty id."""
    sorted_problems: dict[ElementId, tuple[Problem, ...]] = {}
    for problem in problems:
        element = ElementId.of_port(Port(problem.node.partition("/")[0], problem.socket))
        element = element if element in elements else NO_ELEMENT
        sorted_problems[element] = (*sorted_problems.get(element, ()), problem)
    return sorted_problems
