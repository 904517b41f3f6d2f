"""Crossings, places of single boxes and lanes, and dots, against trying all there are."""

from __future__ import annotations

from itertools import combinations, pairwise
from random import Random

import numpy as np
import pytest
from halation.authoring.edits.lanes import CLEARANCE, choose_dots
from halation.authoring.edits.layering import BoxLayers, Tie, make_layers
from halation.authoring.edits.link_curves import make_curve
from halation.authoring.edits.reinsertion import reinsert_all
from halation.authoring.edits.uncrossing import count_crossings, uncross

WALL = (200.0, -500.0, 300.0, 40.0)


def wire_at_random(seed: int) -> BoxLayers:
    """Boxes in five layers, and links to the right between sockets, some of them over several layers."""
    rng = Random(seed)
    numbers = {f"{layer}{row}": layer for layer in range(5) for row in range(rng.randint(2, 4))}
    pairs = [pair for pair in combinations(numbers, 2) if numbers[pair[0]] < numbers[pair[1]]]
    ties = {Tie(*pair, rng.randint(0, 2), rng.randint(0, 2)) for pair in rng.sample(pairs, min(len(pairs), 14))}
    return make_layers(list(numbers), sorted(ties), numbers)


def count_one_by_one(layering: BoxLayers) -> int:
    """Pairs of pieces whose ends are in opposite orders."""
    total = 0
    for left, right in pairwise(layering.layers):
        pieces = [
            ((left.index(name), side.here), (right.index(side.box), side.there))
            for name in left
            for side in layering.after[name]
        ]
        total += sum(
            (one[0] < other[0] and one[1] > other[1]) or (one[0] > other[0] and one[1] < other[1])
            for one, other in combinations(pieces, 2)
        )
    return total


@pytest.mark.parametrize("seed", range(30))
def test_crossings_are_the_pairs_in_opposite_orders(seed: int) -> None:
    layering = wire_at_random(seed)
    assert count_crossings(layering) == count_one_by_one(layering)


@pytest.mark.parametrize("seed", range(30))
def test_afterwards_no_box_has_a_place_with_fewer_crossings(seed: int) -> None:
    layering = wire_at_random(seed)
    before = count_one_by_one(layering)
    for _ in range(10):  # each call makes a few rounds; the last ones find nothing
        reinsert_all(layering)
    after = count_one_by_one(layering)
    assert after <= before
    for layer in layering.layers:
        order = list(layer)
        for name in order:
            for place in range(len(order)):
                layer.remove(name)
                layer.insert(place, name)
                assert count_one_by_one(layering) >= after
                layer[:] = order


def test_a_lane_moves_as_a_whole_where_no_single_box_can() -> None:
    links = [Tie("a", "z"), Tie("b", "m"), Tie("m", "n"), Tie("n", "y")]
    numbers = {"a": 0, "b": 0, "m": 1, "n": 2, "y": 3, "z": 3}
    layering = make_layers(list(numbers), links, numbers)
    layering.layers = [["a", "b"], ["m", *layering.layers[1][1:]], ["n", *layering.layers[2][1:]], ["z", "y"]]
    assert count_one_by_one(layering) == 2
    reinsert_all(layering)
    assert count_one_by_one(layering) == 0


@pytest.mark.parametrize("seed", range(10))
def test_boxes_stay_in_their_layers(seed: int) -> None:
    layering = wire_at_random(seed)
    before = [set(layer) for layer in layering.layers]
    uncross(layering)
    assert [set(layer) for layer in layering.layers] == before
    assert [len(layer) for layer in layering.layers] == [len(layer) for layer in before]


def test_a_free_link_needs_no_dots() -> None:
    assert choose_dots((0.0, 0.0), (500.0, 100.0), [(150.0, 60.0), (350.0, 60.0)], []) == ()


def test_a_link_passes_the_fewest_dots_that_lead_it_around_a_box() -> None:
    bends = [(150.0, 60.0), (200.0, 60.0), (300.0, 60.0), (350.0, 60.0)]
    dots = choose_dots((0.0, 0.0), (500.0, 0.0), bends, [WALL])
    assert dots and len(dots) <= 2 and set(dots) <= set(bends)
    t = np.linspace(0.0, 1.0, 5000)[:, None]
    for start, end in pairwise([(0.0, 0.0), *dots, (500.0, 0.0)]):
        a, b, c, d = np.array(make_curve(*start, *end)).reshape(4, 2)
        x, y = ((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d).T
        assert not ((x > WALL[0]) & (x < WALL[2]) & (y > WALL[1]) & (y < WALL[3])).any()


def test_dots_that_another_link_of_the_socket_has_are_used_again() -> None:
    bends = [(200.0 - CLEARANCE, 60.0), (190.0, 60.0), (300.0 + CLEARANCE, 60.0), (310.0, 60.0)]
    bends.sort()
    free = choose_dots((0.0, 0.0), (500.0, 0.0), bends, [WALL])
    other = [bend for bend in bends if bend not in free]
    assert set(choose_dots((0.0, 0.0), (500.0, 0.0), bends, [WALL], other)) <= set(other)
