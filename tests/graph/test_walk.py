"""Walks through graphs against scipy's."""

from __future__ import annotations

from random import Random

import numpy as np
from halation.graph.walk import find_cyclic, find_reachable, has_loops
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
