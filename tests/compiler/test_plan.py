"""What must hold of every plan, whatever the graph."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from halation.compiler import NULL, Plan
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.merge.mix_images import MixImages
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from random_graphs import random_graph

SEEDS = st.integers(0, 100_000)


def check_lives(plan: Plan) -> None:
    """Surfaces are made before they are read, and two that share a texture never live at the same time."""
    made = {upload.surface: -1 for upload in plan.uploads}
    for index, one in enumerate(plan.passes):
        for number in one.textures:
            assert made[number] < index
            assert plan.surfaces[number].first <= index <= plan.surfaces[number].last
        for number in one.targets:
            assert number not in made
            made[number] = index
            # A pass must not write the texture that it reads.
            assert plan.surfaces[number].slot not in {plan.surfaces[read].slot for read in one.textures}
    assert set(plan.outputs.values()) <= set(made)
    for slot in range(len(plan.slots)):
        living = sorted((item.first, item.last) for item in plan.surfaces if item.slot == slot)
        for (_, end), (start, _) in pairwise(living):
            assert end < start


@settings(max_examples=60)
@given(SEEDS, st.booleans(), st.sampled_from(["compute", "fragment"]))
def test_slots_never_overlap_in_life(plan, seed, fusion, form):
    check_lives(plan(random_graph(seed), fusion=fusion, target=replace(NULL, form=form)))


@settings(max_examples=40)
@given(SEEDS)
def test_slots_hold_what_lies_in_them_and_no_more(plan, seed):
    made = plan(random_graph(seed))
    for slot, size in enumerate(made.slots):
        assert {item.nbytes for item in made.surfaces if item.slot == slot} == {size}
    assert made.peak_bytes == sum(made.slots)


@settings(max_examples=40)
@given(SEEDS)
def test_fusion_saves_passes_and_keeps_the_outputs(plan, seed):
    graph = random_graph(seed)
    fused, plain = plan(graph), plan(graph, fusion=False)
    assert len(fused.passes) <= len(plain.passes)
    for name, number in plain.outputs.items():
        assert fused.surfaces[fused.outputs[name]].size == plain.surfaces[number].size


@settings(max_examples=40)
@given(SEEDS)
def test_the_same_graph_gives_the_same_plan(plan, seed):
    assert plan(random_graph(seed)) == plan(random_graph(seed))


@settings(max_examples=40)
@given(SEEDS)
def test_keys_tell_different_pixels_apart(plan, seed):
    for fusion in (False, True):
        made = plan(random_graph(seed), fusion=fusion)
        # A merged pass makes the same pixels as another one in other company.
        alone = [one for one in made.passes if not fusion or len(one.targets) == 1]
        merged = {number for one in made.passes if one not in alone for number in one.targets}
        # One picture stands for all that are read under its key; that these are the same is checked on their own turn.
        firsts: dict[str, int] = {}
        for number, item in enumerate(made.surfaces):
            if number not in merged:
                firsts.setdefault(item.key, number)
        ways = {
            number: (
                one.shader,
                one.uniforms,
                tuple(read if read in merged else firsts[made.surfaces[read].key] for read in one.textures),
                one.targets.index(number),
            )
            for one in alone
            for number in one.targets
        }
        for number in range(len(made.surfaces)):
            key = made.surfaces[number].key
            same = [other for other, item in enumerate(made.surfaces) if item.key == key and other not in merged]
            # The same numbers as color and as data are the same pixels.
            assert len({ways.get(other, other) for other in same}) <= 1


@pytest.mark.parametrize("limit", [2, 4, 8])
def test_a_pass_stays_within_the_device_limits(plan, limit):
    for seed in range(20):
        target = replace(NULL, form="fragment", max_samplers=limit)
        for one in plan(random_graph(seed, 14), target=target).passes:
            # A node that reads more by itself cannot be helped.
            assert len(one.textures) <= limit or len(one.nodes) == 1


@pytest.mark.parametrize("limit", [3, 4, 5, 8])
def test_a_pass_uses_all_image_units_and_no_more(plan, limit):
    """Each pass reads one picture fewer than there are units, for it writes one: a chain of blends takes as many passes
    as n - 1 pictures take that are joined k - 2 at a time."""
    target = replace(NULL, form="compute", max_images=limit)
    assert target.loads_images
    for count in range(2, 14):
        graph = Graph(inputs={f"p{number}": Input() for number in range(count)})
        source = Port("inputs", "p0")
        for number in range(1, count):
            graph = graph.add(f"mix{number}", MixImages(factor=0.5)).connect(source, Port(f"mix{number}", "a"))
            graph = graph.connect(Port("inputs", f"p{number}"), Port(f"mix{number}", "b"))
            source = Port(f"mix{number}", "out")
        graph = graph.add_output("out", Output(Kind.IMAGE)).connect(source, Port("outputs", "out"))
        passes = plan(graph, target=target).passes
        assert len(passes) == math.ceil((count - 1) / (limit - 2))
        assert all(len(one.textures) + len(one.targets) <= limit for one in passes)
