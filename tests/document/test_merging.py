"""Three-way merges: laws on random graphs, and what two people may do at once."""

from __future__ import annotations

import dataclasses
import json
from random import Random
from typing import Any

import pytest
from edited_graphs import edit_randomly, make_graph, parse_graph
from halation.document import FORMAT, dumps
from halation.document.diff_merge import (
    MergedGraph,
    PartPath,
    Side,
    compare_graphs,
    merge_graphs,
    read_conflicts,
    resolve_conflicts,
)
from halation.document.diff_merge.aligning import align_three
from halation.document.diff_merge.conflicts import Conflict, add_conflicts
from halation.document.diff_merge.lines import merge_lines
from halation.document.diff_merge.parts import ABSENT, equals, get_part, is_tree, parts_of
from halation.errors import UsageError
from halation.graph import Graph, Port, problems, signature
from halation.nodes import catalogue
from hypothesis import given, settings
from hypothesis import strategies as st

NODES = catalogue()
SEEDS = st.integers(0, 2**32)


def versions(seed: int, edits: int = 3) -> tuple[Graph, Graph, Graph]:
    """A graph, and what two people made of it."""
    rng, base = Random(seed), make_graph(seed)
    sides = [base, base]
    for place in (0, 1):
        for _ in range(rng.randint(1, edits)):
            sides[place] = edit_randomly(rng, sides[place])
    return base, *(parse_graph(dumps(side)) for side in sides)


@settings(max_examples=60)
@given(SEEDS)
def test_the_laws_of_merging(seed: int) -> None:
    base, ours, theirs = versions(seed)
    assert (
        merge_graphs(base, ours, base)
        == merge_graphs(base, base, ours)
        == merge_graphs(base, ours, ours)
        == MergedGraph(dumps(ours), ())
    )
    one, other = merge_graphs(base, ours, theirs), merge_graphs(base, theirs, ours)
    assert {c.at for c in one.conflicts} == set() or other.conflicts
    for made in (one, other):
        graph = parse_graph(made.text)
        assert dumps(graph) == made.text
        assert ("conflicts" in json.loads(made.text)) == bool(made.conflicts)
    if not one.conflicts:
        first, second = (json.loads(made.text) for made in (one, other))
        assert {**first, "ui": 0} == {**second, "ui": 0}


@settings(max_examples=60)
@given(SEEDS)
def test_nothing_that_a_side_did_is_lost(seed: int) -> None:
    """Every change is in the result, or in a conflict; and ours is always in place."""
    base, ours, theirs = align_three(*versions(seed, 5))
    made = merge_graphs(base, ours, theirs)
    parts, open = parts_of(parse_graph(made.text)), [conflict.at for conflict in made.conflicts]

    def is_open(at: PartPath) -> bool:
        return any(one[: len(at)] == at or at[: len(one)] == one for one in open)

    for side, changes in ((ours, compare_graphs(base, ours).changes), (theirs, compare_graphs(base, theirs).changes)):
        for change in changes:
            found = get_part(parts, change.at)
            there = (is_tree(found) and is_tree(change.after)) or equals(found, change.after)
            assert there or is_open(change.at), change
            assert side is theirs or not is_open(change.at) or equals(found, get_part(parts_of(ours), change.at)), (
                change
            )
    for conflict in made.conflicts:
        assert [
            equals(get_part(parts_of(side), conflict.at), said)
            for side, said in zip((base, ours, theirs), (conflict.base, conflict.ours, conflict.theirs), strict=True)
        ] == [True] * 3


@settings(max_examples=40)
@given(SEEDS)
def test_edits_of_different_nodes_make_what_both_in_sequence_make(seed: int) -> None:
    """One turns values of some nodes, mutes and moves them; the other does so with the others, and adds one."""
    rng, base = Random(seed), make_graph(seed)
    ids = [*base.nodes]
    rng.shuffle(ids)
    half = len(ids) // 2

    def turned(graph: Graph, mine: list[str], fresh: str) -> Graph:
        for id in mine:
            values = [value for value in signature(graph.nodes[id]).values.values() if value.type == "float"]
            for value in values:
                graph = graph.put(Port(id, value.name), value.default + 0.25)
            graph = graph.mute(id, id not in graph.muted)
            places = {**graph.ui.get("nodes", {}), id: {"x": len(id), "y": -1}}
            graph = dataclasses.replace(graph, ui={**graph.ui, "nodes": places})
        return graph.add(fresh, NODES["exposure"](stops=0.5))

    ours, theirs = turned(base, ids[:half], "mine"), turned(base, ids[half:], "yours")
    both = turned(turned(base, ids[:half], "mine"), ids[half:], "yours")
    assert merge_graphs(base, ours, theirs) == merge_graphs(base, theirs, ours) == MergedGraph(dumps(both), ())


@settings(max_examples=40)
@given(SEEDS, st.sampled_from(["ours", "theirs", "base"]))
def test_a_side_can_be_chosen(seed: int, side: Side) -> None:
    """And then nothing is open; what theirs changed is as theirs has it."""
    base, ours, theirs = align_three(*versions(seed, 6))
    made = merge_graphs(base, ours, theirs)
    document = json.loads(made.text)
    if not made.conflicts:
        with pytest.raises(UsageError):
            resolve_conflicts(document, {"": side})
        return
    done = parse_graph(json.dumps(resolve_conflicts(document, {"": side})))
    assert not read_conflicts(json.loads(dumps(done)))
    for conflict in made.conflicts:
        wanted = {"ours": conflict.ours, "theirs": conflict.theirs, "base": conflict.base}[side]
        assert equals(get_part(parts_of(done), conflict.at), wanted)


def made(document: dict[str, Any], **changes: Any) -> Graph:
    """A small graph with some parts changed; None removes one. Names are paths with slashes."""
    tree = json.loads(json.dumps(document))
    for path, part in changes.items():
        *above, last = path.split("/")
        place = tree
        for key in above:
            place = place.setdefault(key, {})
        if part is None:
            del place[last]
        else:
            place[last] = part
    return parse_graph(json.dumps(tree))


BASE = {
    "halation": FORMAT,
    "inputs": {"beauty": {"type": "Image"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {
        "blur": {"type": "gaussian_blur", "values": {"sigma": 2.0}},
        "light": {"type": "exposure", "values": {"stops": 1.0}},
    },
    "links": {"blur.image": "inputs.beauty", "light.image": "blur.out", "outputs.image": "light.out"},
    "animation": {"light.stops": {"keys": [{"frame": 1, "value": 0.0}, {"frame": 9, "value": 1.0}]}},
    "ui": {"nodes": {"blur": {"x": 0, "y": 0}, "light": {"x": 9, "y": 0}}},
}
NEW = {"type": "saturation", "version": 1}


def key(frame: float, value: float) -> dict[str, float]:
    return {"frame": frame, "value": value}


@pytest.mark.parametrize(
    ("ours", "theirs"),
    [
        ({"nodes/a": NEW}, {"nodes/b": {"type": "exposure"}}),
        ({"nodes/blur/values": {"sigma": 3.0}}, {"nodes/blur/values": {"sigma": 2.0, "edge": "mirror"}}),
        ({"nodes/blur/values": {"sigma": 3.0}}, {"nodes/blur/muted": True}),
        ({"nodes/blur/values": {"sigma": 3.0}}, {"links/light.image": "inputs.beauty"}),
        ({"ui/nodes/blur": {"x": 5, "y": 5}}, {"ui/nodes/light": {"x": 7, "y": 7}, "nodes/light/muted": True}),
        (
            {"animation/light.stops/keys": [key(1, 0.5), key(9, 1.0)]},
            {"animation/light.stops/keys": [key(1, 0.0), key(4, 2.0), key(9, 1.0)]},
        ),
        ({"settings": {"size": [64, 32]}}, {"settings": {"frames": [1, 9]}}),
        (
            {"nodes/a": NEW, "links/a.image": "blur.out"},
            {"outputs/more": {"type": "Image"}, "links/outputs.more": "blur.out"},
        ),
        ({"later": {"one": 1}}, {"later": {"two": [2]}}),
        (
            {"nodes/light": None, "links/light.image": None, "links/outputs.image": "blur.out", "animation": None},
            {"ui/nodes/light": {"x": 5, "y": 5}},
        ),
    ],
)
def test_what_two_people_may_do_at_once(ours: dict[str, Any], theirs: dict[str, Any]) -> None:
    """The result is what one would have made of what the other left, and no one is asked."""
    sides = made(BASE), made(BASE, **ours), made(BASE, **theirs)
    found, other = merge_graphs(*sides), merge_graphs(sides[0], sides[2], sides[1])
    assert found == other and not found.conflicts
    logic = [json.loads(text) for text in (found.text, dumps(made(BASE, **ours)), dumps(made(BASE, **theirs)))]
    for section in ("nodes", "links", "outputs"):
        base = json.loads(dumps(sides[0]))[section]
        for side in logic[1:]:
            changed = {name: entry for name, entry in side[section].items() if base.get(name) != entry}
            for name in changed:
                assert name in logic[0][section]
            assert not {name for name in base if name not in side[section]} & logic[0][section].keys()
    assert set(logic[0].get("ui", {}).get("nodes", {})) <= {*logic[0]["nodes"]}


def test_keys_of_both_sides() -> None:
    ours = made(BASE, **{"animation/light.stops/keys": [key(1, 0.5), key(9, 1.0)]})
    theirs = made(BASE, **{"animation/light.stops/keys": [key(1, 0.0), key(4, 2.0), key(9, 1.0)]})
    found = json.loads(merge_graphs(made(BASE), ours, theirs).text)
    assert found["animation"]["light.stops"]["keys"] == [key(1, 0.5), key(4, 2.0), key(9, 1.0)]


@pytest.mark.parametrize(
    ("ours", "theirs", "place"),
    [
        ({"x": 5, "y": 5}, {"x": 7, "y": 0}, {"x": 5, "y": 5}),  # both moved it
        ({"x": 0, "y": 5}, {"x": 7, "y": 0}, {"x": 7, "y": 5}),  # each in another direction
        (None, {"x": 7, "y": 0}, {"x": 7, "y": 0}),  # one forgot the place that the other chose
        ({"x": 5, "y": 5}, None, {"x": 5, "y": 5}),
    ],
)
def test_of_two_places_ours_counts_and_one_counts_more_than_none(
    ours: dict[str, int] | None, theirs: dict[str, int] | None, place: dict[str, int]
) -> None:
    found = merge_graphs(made(BASE), *(made(BASE, **{"ui/nodes/blur": side}) for side in (ours, theirs)))
    assert not found.conflicts and json.loads(found.text)["ui"]["nodes"]["blur"] == place


def test_a_renamed_node_takes_what_the_other_changed() -> None:
    renamed = made(BASE).rename("blur", "soft")
    theirs = made(BASE, **{"nodes/blur/values": {"sigma": 7.0}})
    for sides in ((renamed, theirs), (theirs, renamed)):
        found = merge_graphs(made(BASE), *sides)
        assert not found.conflicts and parse_graph(found.text) == theirs.rename("blur", "soft")


REMOVED = {"nodes/blur": None, "links/blur.image": None, "links/light.image": "inputs.beauty"}
LOOPING = {"nodes/c": {"type": "merge"}, "links/c.a": "inputs.beauty", "links/c.b": "inputs.beauty"}


@pytest.mark.parametrize(
    ("ours", "theirs", "paths"),
    [
        ({"nodes/blur/values": {"sigma": 3.0}}, {"nodes/blur/values": {"sigma": 4.5}}, {"nodes.blur.values.sigma"}),
        (REMOVED, {"nodes/blur/values": {"sigma": 4.5}}, {"nodes.blur", "links.blur.image", "links.light.image"}),
        (
            REMOVED,
            {"nodes/a": NEW, "links/a.image": "blur.out"},
            {"nodes.blur", "links.blur.image", "links.light.image", "links.a.image"},
        ),
        ({"links/light.image": "inputs.beauty"}, {"nodes/a": NEW, "links/light.image": "a.out"}, {"links.light.image"}),
        ({"nodes/a": NEW}, {"nodes/a": {"type": "exposure"}}, {"nodes.a"}),
        (
            {"nodes/a": NEW, "links/a.image": "blur.out", "links/light.image": "a.out"},
            {"nodes/a": {"type": "box_blur"}, "links/a.image": "blur.out"},
            {"nodes.a", "links.light.image"},  # what was linked to one of two that have nothing but a name in common
        ),
        ({"nodes/blur": {"type": "box_blur"}}, {"nodes/blur/values": {"sigma": 4.5}}, {"nodes.blur"}),
        (
            {"animation/light.stops/keys": [key(9, 1.0)]},
            {"animation/light.stops/keys": [key(1, 0.0)]},
            {"animation.light.stops"},
        ),
        (
            {"animation/light.stops": {"expression": "frame"}},
            {"animation/light.stops/keys": [key(1, 0.0)]},
            {"animation.light.stops"},
        ),
        ({"settings": {"size": [1, 2]}}, {"settings": {"size": [3, 4]}}, {"settings.size"}),
        (
            {"inputs": None, "links/blur.image": None},
            {"nodes/a": NEW, "links/a.image": "inputs.beauty"},
            {"inputs.beauty", "links.blur.image", "links.a.image"},
        ),
    ],
)
def test_true_conflicts(ours: dict[str, Any], theirs: dict[str, Any], paths: set[str]) -> None:
    """Ours stays in place, the graph loads, and every conflict is a problem on the node that it is about."""
    sides = made(BASE), made(BASE, **ours), made(BASE, **theirs)
    found = merge_graphs(*sides)
    assert {conflict.path for conflict in found.conflicts} == paths
    graph, document = parse_graph(found.text), json.loads(found.text)
    named = [problem for problem in problems(graph) if problem.rule.name == "unmerged"]
    assert {problem.sentence.partition(" was")[0] for problem in named} == paths
    assert {problem.severity for problem in named} == {"error"}
    assert parse_graph(json.dumps(resolve_conflicts(document, {"": "ours"}))).nodes.items() >= sides[1].nodes.items()
    done = parse_graph(json.dumps(resolve_conflicts(document, {"": "theirs"})))
    assert done.nodes.items() >= sides[2].nodes.items() and done.links.items() >= sides[2].links.items()


GONE = {"nodes/light": None, "links/light.image": None, "links/outputs.image": "blur.out", "animation": None}
"""`light` is removed, and what it was linked to."""


@pytest.mark.parametrize(
    ("uses", "path"),
    [
        ({"nodes/light/muted": True}, "nodes.light"),
        ({"links/light.image": "inputs.beauty"}, "links.light.image"),
        ({"nodes/a": NEW, "links/a.image": "light.out"}, "links.a.image"),
        ({"controls": {"knob": {"target": "light.stops"}}}, "controls.knob"),
        ({"animation/light.stops/keys": [key(1, 0.5)]}, "animation.light.stops"),
        ({"animation/blur.sigma": {"expression": "light.stops * 2"}}, "animation.blur.sigma"),
    ],
)
def test_nothing_goes_that_the_other_side_began_to_use(uses: dict[str, Any], path: str) -> None:
    """In whichever way: its removal and the use of it are both open."""
    sides = made(BASE), made(BASE, **GONE), made(BASE, **uses)
    both = [merge_graphs(*sides), merge_graphs(sides[0], sides[2], sides[1])]
    open = [{conflict.path for conflict in found.conflicts} for found in both]
    assert open[0] == open[1] >= {"nodes.light", path}


def test_links_that_only_together_make_a_loop() -> None:
    base = {**BASE, "nodes": {**BASE["nodes"], "a": {"type": "merge"}, "b": {"type": "merge"}}}
    ours, theirs = made(base, **{"links/a.a": "b.out"}), made(base, **{"links/b.a": "a.out"})
    found = merge_graphs(made(base), ours, theirs)
    assert [conflict.path for conflict in found.conflicts] == ["links.b.a"]
    parse_graph(found.text).order()
    assert parse_graph(json.dumps(resolve_conflicts(json.loads(found.text), {"links.b.a": "ours"}))) == ours


def test_code_goes_together_line_by_line() -> None:
    def coded(*code: str) -> Graph:
        return parse_graph(json.dumps({"halation": FORMAT, "nodes": {"wave": {"type": "later", "code": code}}}))

    base = coded("a", "b", "c", "d", "e")
    found = merge_graphs(base, coded("A", "b", "c", "d", "e"), coded("a", "b", "c", "d", "E", "f"))
    assert json.loads(found.text)["nodes"]["wave"]["code"] == ["A", "b", "c", "d", "E", "f"] and not found.conflicts
    found = merge_graphs(base, coded("a", "x", "c", "d", "e"), coded("a", "y", "c", "d", "e"))
    assert [conflict.path for conflict in found.conflicts] == ["nodes.wave.code"]


@settings(max_examples=80)
@given(*[st.lists(st.sampled_from("abcd"), max_size=8)] * 3)
def test_the_laws_of_lines(base: list[str], ours: list[str], theirs: list[str]) -> None:
    """Laws of diff3: what is the same on two sides is taken from the third, and the sides are alike."""
    assert merge_lines(base, ours, base) == merge_lines(base, base, ours) == merge_lines(base, ours, ours) == ours
    assert merge_lines(base, ours, theirs) == merge_lines(base, theirs, ours)


@pytest.mark.parametrize(
    "marker", [3, [], [3], [{}], [{"at": []}], [{"at": [None, {}]}], [{"at": ["nodes"], "ours": {}}]]
)
def test_a_damaged_marker_is_a_problem_and_not_a_crash(marker: Any) -> None:
    graph = made(BASE, conflicts=marker)
    named = [problem for problem in problems(graph) if problem.rule.name == "unmerged"]
    assert len(named) == (1 if marker else 0)
    assert json.loads(merge_graphs(graph, graph, made(BASE, conflicts=marker, later=1)).text)["conflicts"] == marker


def test_new_conflicts_take_the_place_of_those_at_the_same_part_only() -> None:
    first, second = PartPath(("nodes", "bloom", "values", "sigma")), PartPath(("nodes", "fog", "muted"))
    old = add_conflicts({}, {first: Conflict(first, 1.0, 2.0, 3.0), second: Conflict(second, False, True, ABSENT)})
    new = add_conflicts(old, {first: Conflict(first, 2.0, 5.0, 7.0)})
    assert {conflict.at: (conflict.base, conflict.ours, conflict.theirs) for conflict in read_conflicts(new)} == {
        second: (False, True, ABSENT),
        first: (2.0, 5.0, 7.0),
    }
    assert len(new["conflicts"]) == 2 and add_conflicts(old, {}) is old
