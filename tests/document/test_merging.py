"""Three-way merges: laws on random graphs, and what two people may do at once."""

from __future__ import annotations

import dataclasses
import json
from random import Random
from typing import Any

import pytest
from edited_graphs import edited, read, some_graph
from halation.app.document import dumps
from halation.app.document.versions import At, Merged, Side, conflicts_of, difference, merged, resolved
from halation.app.document.versions.aligning import align_three
from halation.app.document.versions.parts import at_part, is_tree, parts_of, same
from halation.app.errors import UsageError
from halation.app.graph import Graph
from hypothesis import given, settings
from hypothesis import strategies as st

SEEDS = st.integers(0, 2**32)


def versions(seed: int, edits: int = 3) -> tuple[Graph, Graph, Graph]:
    """A graph, and what two people made of it."""
    rng, base = Random(seed), some_graph(seed)
    sides = [base, base]
    for place in (0, 1):
        for _ in range(rng.randint(1, edits)):
            sides[place] = edited(rng, sides[place])
    return base, *(read(dumps(side)) for side in sides)


@settings(max_examples=60, deadline=None)
@given(SEEDS)
def test_the_laws_of_merging(seed: int) -> None:
    base, ours, theirs = versions(seed)
    assert merged(base, ours, base) == merged(base, base, ours) == merged(base, ours, ours) == Merged(dumps(ours), ())
    one, other = merged(base, ours, theirs), merged(base, theirs, ours)
    assert {c.at for c in one.conflicts} == set() or other.conflicts
    for made in (one, other):
        graph = read(made.text)
        assert dumps(graph) == made.text
        assert ("conflicts" in json.loads(made.text)) == bool(made.conflicts)
    if not one.conflicts:
        first, second = (json.loads(made.text) for made in (one, other))
        assert {**first, "ui": 0} == {**second, "ui": 0}


@settings(max_examples=60, deadline=None)
@given(SEEDS)
def test_nothing_that_a_side_did_is_lost(seed: int) -> None:
    """Every change is in the result, or in a conflict; and ours is always in place."""
    base, ours, theirs = align_three(*versions(seed, 5))
    made = merged(base, ours, theirs)
    parts, open = parts_of(read(made.text)), [conflict.at for conflict in made.conflicts]

    def is_open(at: At) -> bool:
        return any(one[: len(at)] == at or at[: len(one)] == one for one in open)

    for side, changes in ((ours, difference(base, ours).changes), (theirs, difference(base, theirs).changes)):
        for change in changes:
            found = at_part(parts, change.at)
            there = is_tree(found) and is_tree(change.after) or same(found, change.after)
            assert there or is_open(change.at), change
            assert side is theirs or not is_open(change.at) or same(found, at_part(parts_of(ours), change.at)), change
    for conflict in made.conflicts:
        assert [same(at_part(parts_of(side), conflict.at), said) for side, said in zip(
            (base, ours, theirs), (conflict.base, conflict.ours, conflict.theirs), strict=True)] == [True] * 3


@settings(max_examples=40, deadline=None)
@given(SEEDS, st.sampled_from(["ours", "theirs", "base"]))
def test_a_side_can_be_chosen(seed: int, side: Side) -> None:
    """And then nothing is open; what theirs changed is as theirs has it."""
    base, ours, theirs = align_three(*versions(seed, 6))
    made = merged(base, ours, theirs)
    document = json.loads(made.text)
    if not made.conflicts:
        with pytest.raises(UsageError):
            resolved(document, {"": side})
        return
    done = read(json.dumps(resolved(document, {"": side})))
    assert not conflicts_of(json.loads(dumps(done)))
    for conflict in made.conflicts:
        wanted = {"ours": conflict.ours, "theirs": conflict.theirs, "base": conflict.base}[side]
        below = [one.at for one in made.conflicts if one.at != conflict.at and one.at[: len(conflict.at)] == conflict.at]
        assert below or same(at_part(parts_of(done), conflict.at), wanted)
