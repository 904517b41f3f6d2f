"""Hints while editing: the same whether a graph is looked at anew or after an edit of one that was known."""

from __future__ import annotations

import dataclasses
from random import Random

from halation.graph import Port, Settings, problems, signature
from halation.lint.live import find_remarks, recheck_remarks
from halation.nodes import catalogue
from hypothesis import given, settings
from hypothesis import strategies as st
from lint_graphs import DIM, HALF, MOVE, SOFT, TONE, TURN, chain
from random_graphs import random_graph

NODES = catalogue()
STEPS = st.lists(st.sampled_from([TURN, MOVE, DIM, HALF, SOFT, TONE, ("bloom", {})]), min_size=2, max_size=5)


@settings(max_examples=60)
@given(STEPS, st.randoms(use_true_random=False))
def test_nothing_is_forgotten_while_values_change(steps, rng: Random) -> None:
    graph = chain(*steps)
    found = find_remarks(graph, NODES)
    for _ in range(6):
        before, id = graph, rng.choice([*graph.nodes])
        if rng.random() < 0.3:
            graph = graph.mute(id, id not in graph.muted)
        else:
            value = rng.choice([v for v in graph.nodes[id].values.values() if v.type in ("float", "vector", "choice")])
            now = {"choice": lambda v=value: rng.choice(v.choices), "float": lambda v=value: max(v.minimum, 1.0)}
            plain = now.get(value.type, lambda v=value: tuple(rng.choice((0.5, 1.0)) for _ in range(v.length)))()
            graph = graph.put(Port(id, value.name), rng.choice((plain, value.default)))
        found = recheck_remarks(graph, before, found, NODES)
        assert found == find_remarks(graph, NODES)


def test_hints_come_after_problems_and_not_in_a_graph_with_errors() -> None:
    graph = chain(TURN, DIM, MOVE)
    assert [one.rule.name for one in find_remarks(graph, NODES)] == ["filtering-twice"]
    broken = graph.disconnect(Port("a", "image"))
    assert find_remarks(broken, NODES) == problems(broken, NODES) != ()
    meant = dataclasses.replace(graph, settings=Settings(allow={"filtering-twice:c": "soft is the look"}))
    assert find_remarks(meant, NODES) == ()


def test_a_value_that_decides_what_a_node_does_is_looked_at_anew() -> None:
    """There and back: what is told after an edit is what the graph tells that was never anything else."""
    first = chain(TURN, DIM, MOVE)
    second = first.put(Port("c", "position"), (0.0, 0.0))
    told = [find_remarks(graph, NODES) for graph in (first, second)]
    assert told[0] and not told[1]
    assert recheck_remarks(second, first, told[0], NODES) == told[1]
    assert recheck_remarks(first, second, told[1], NODES) == told[0]


@settings(max_examples=25)
@given(st.integers(0, 2**32))
def test_any_graph_can_be_looked_at(seed) -> None:
    graph = random_graph(seed, 14)
    for problem in find_remarks(graph, NODES):
        assert problem.severity == "warning"
        assert problem.socket in (*signature(graph.nodes[problem.node]).inputs, "")
