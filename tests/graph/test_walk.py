"""Walks through graphs against scipy's."""

from __future__ import annotations

from itertools import pairwise
from random import Random

import numpy as np
from halation.graph.walk import find_cyclic, find_loops, find_reachable, has_loops
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components, shortest_path


@settings(max_examples=300)
@given(st.integers(0, 2**32), st.integers(1, 9))
def test_what_leads_to_itself_is_in_a_strong_component(seed: int, count: int) -> None:
    """Of several names, or of one that names itself; whatever the order of names is."""
    rng = Random(seed)
    steps = {name: [rng.randrange(count) for _ in range(rng.randrange(3))] for name in rng.sample(range(count), count)}
    matrix = np.zeros((count, count))
    for name, following in steps.items():
        matrix[name, following] = 1.0
    _, labels = connected_components(csr_matrix(matrix), connection="strong")
    sizes = np.bincount(labels)
    assert find_cyclic(steps) == {name for name in range(count) if sizes[labels[name]] > 1 or matrix[name, name]}
    assert has_loops(steps) == any(sizes[labels[name]] > 1 or matrix[name, name] for name in range(count))
    away = shortest_path(csr_matrix(matrix), unweighted=True)
    start = rng.randrange(count)
    reachable = find_reachable([start], steps)
    near = {name: away[start, name] for name in range(count) if np.isfinite(away[start, name]) and name != start}
    assert reachable.keys() - {start} == near.keys()
    distances = [near[name] for name in reachable if name != start]
    assert distances == sorted(distances) and all(name in steps[before] for name, before in reachable.items())


@settings(max_examples=300)
@given(st.integers(0, 2**32), st.integers(1, 12), st.integers(1, 4))
def test_loops_share_no_name_and_none_is_left(seed: int, count: int, most: int) -> None:
    rng = Random(seed)
    names = [f"n{number}" for number in range(count)]
    steps = {name: rng.choices(names, k=rng.randrange(3)) for name in rng.sample(names, count)}
    loops = find_loops(steps, most)
    for loop in loops:
        assert loop[0] == loop[-1] and len(set(loop)) == len(loop) - 1
        assert all(before in steps[after] for before, after in pairwise(loop))
    inside = [name for loop in loops for name in loop[1:]]
    assert len(inside) == len(set(inside)) and len(loops) <= most
    kept = [name for name in names if name not in inside]
    matrix = csr_matrix([[name in steps[other] for name in kept] for other in kept])
    strong = connected_components(matrix, connection="strong")[0] if kept else 0
    is_free = strong == len(kept) and not any(name in steps[name] for name in kept)
    assert is_free or len(loops) == most


class CountedSteps(dict[str, list[str]]):
    """Counts how often the steps from a name are looked up."""

    count = 0

    def __getitem__(self, name: str) -> list[str]:
        self.count += 1
        return super().__getitem__(name)


def test_many_ways_are_walked_once() -> None:
    """Sixteen nodes that are linked twice to the next one have 65,536 ways through them."""
    steps = CountedSteps({"n16": []})
    for number in range(16):
        steps |= {f"n{number}": [f"a{number}", f"b{number}"]}
        steps |= {f"{side}{number}": [f"n{number + 1}"] for side in "ab"}
    assert find_loops(dict(sorted(steps.items()))) == ()
    assert find_loops(steps) == () and steps.count == len(steps)
