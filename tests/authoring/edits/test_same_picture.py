"""Edits that only rearrange a graph: it compiles to the same passes as before."""

from __future__ import annotations

from random import Random

import pytest
from halation.authoring.edits import clipboard, paths, wiring
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.grouping import make_group
from halation.authoring.edits.layout import pin_places, positions
from halation.authoring.edits.room import make_space
from halation.authoring.edits.ungrouping import ungroup
from halation.compiler import Request, compile_graph
from halation.document import dumps, loads
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Port, signature
from halation.nodes import catalogue
from halation.resources.picture import Picture
from halation.resources.sandbox import UNRESTRICTED
from headers import Headers
from random_graphs import SIZE, random_graph
from selection import list_seeds

SEEDS = list_seeds(20, 60)


def keys(graph: Graph) -> dict[str, str]:
    """What every output shows, as the key of its pixels."""
    bindings = {
        name: Picture(name, "", item.kind, item.socket().channels, in_memory=True)
        for name, item in graph.inputs.items()
    }
    plan = compile_graph(graph, Request(bindings=bindings), Headers(SIZE))
    return {name: plan.surfaces[surface].key for name, surface in plan.outputs.items()}


def made(seed: int) -> tuple[Graph, Random]:
    """A random graph with controls, mutes and dots."""
    rng = Random(seed)
    graph = random_graph(seed, rng.randint(4, 16))
    for id in rng.sample(sorted(graph.nodes), 2):
        if values := list(signature(graph.nodes[id]).values):
            graph = graph.add_control(f"c_{id}", Control(Port(id, rng.choice(values))))
    graph = pin_places(graph.mute(rng.choice(sorted(graph.nodes))))
    return graph, rng


def some_nodes(graph: Graph, rng: Random) -> list[ElementId]:
    return rng.sample(sorted(map(ElementId, graph.nodes)), rng.randint(1, len(graph.nodes)))


def flat(graph: Graph) -> dict[str, float]:
    """All coordinates by element and axis."""
    return {key + axis: spot for key, spots in positions(graph).items() for axis, spot in zip("xy", spots, strict=True)}


def saved(graph: Graph) -> Graph:
    return loads(dumps(graph), sandbox=UNRESTRICTED)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_group_and_its_end(seed):
    graph, rng = made(seed)
    wanted, controls = keys(graph), dict(graph.controls)
    for chosen in [[rng.choice(sorted(graph.nodes))], *(some_nodes(graph, rng) for _ in range(8))]:
        try:
            inside, id = make_group(graph, chosen)
        except GraphError as error:
            assert "lies between them" in str(error) and len(chosen) > 1
            continue
        assert keys(inside) == wanted
        assert saved(inside) == inside
        for control in inside.controls.values():
            assert inside.value(control.target) is not None
        again, put = ungroup(inside, id)
        assert keys(again) == wanted
        assert (again.nodes, again.links, again.muted) == (graph.nodes, graph.links, graph.muted)
        assert again.controls == controls
        assert flat(again) == pytest.approx(flat(graph), abs=0.02)
        assert set(put) == {id for id in graph.nodes if id not in inside.nodes}


@pytest.mark.parametrize("seed", SEEDS)
def test_groups_in_groups(seed):
    graph, rng = made(seed)
    wanted = keys(graph)
    for _ in range(3):
        try:
            graph, _ = make_group(graph, some_nodes(graph, rng), "g")
        except GraphError:
            continue
    assert keys(graph) == wanted
    while groups := [id for id, item in graph.nodes.items() if isinstance(item, Group)]:
        graph, _ = ungroup(graph, rng.choice(groups))
    assert keys(graph) == wanted


@pytest.mark.parametrize("seed", SEEDS)
def test_copy_and_paste_of_everything(seed):
    graph, _ = made(seed)
    everything = set(positions(graph))
    part = clipboard.read_part(clipboard.copy_elements(graph, everything), "", catalogue(), sandbox=UNRESTRICTED)
    again, put = clipboard.paste_part(Graph(), part, {})
    assert keys(again) == keys(graph)
    assert set(put) == everything
    assert positions(again) == positions(graph)
    twice, _ = clipboard.paste_part(graph, part, positions(graph))
    found = keys(twice)
    assert {name: found[name] for name in graph.outputs} == keys(graph)
    assert sorted(found.values()) == sorted([*keys(graph).values()] * 2)
    assert saved(twice) == twice


@pytest.mark.parametrize("seed", SEEDS)
def test_a_node_put_into_a_link_and_taken_out(seed):
    graph, rng = made(seed)
    target = rng.choice(sorted(graph.links))
    for name in rng.sample(sorted(catalogue()), 6):
        before = graph.add("fresh", catalogue()[name]())
        try:
            after = wiring.insert_node(before, "fresh", target)
        except GraphError:
            continue
        assert after.links[target].node == "fresh"
        assert wiring.remove_node(after, "fresh").links == graph.links
        assert keys(wiring.extract_nodes(after, ["fresh"])) == keys(graph)
        break


@pytest.mark.parametrize("seed", SEEDS)
def test_a_chain_put_into_a_link_is_as_wired_by_hand(seed):
    graph, rng = made(seed)
    target = rng.choice(sorted(graph.links))
    needs = {name: sum(not one.optional for one in kind.inputs.values()) for name, kind in sorted(catalogue().items())}
    filters = [name for name, count in needs.items() if count == 1]
    for _ in range(6):
        before, ids = graph, [f"fresh{number}" for number in range(rng.randint(2, 4))]
        try:
            for number, id in enumerate(ids):
                before = before.add(id, catalogue()[rng.choice(filters)]())
                if number:
                    before = wiring.link_node(
                        before,
                        id,
                        Port(ids[number - 1], next(iter(signature(before.nodes[ids[number - 1]]).outputs))),
                        True,
                    )
            after = wiring.splice_chain(before, set(ids), target)
        except GraphError:
            continue
        by_hand = before.disconnect(target)
        by_hand = by_hand.connect(graph.links[target], wiring.first_target(by_hand, graph.links[target], ids[0], False))
        by_hand = by_hand.connect(wiring.first_source(by_hand, ids[-1], target), target)
        assert by_hand.links == after.links
        if by_hand.link_faults:  # an output that followed a Field may now be an Image
            assert after.link_faults == by_hand.link_faults
            continue
        assert keys(make_space(pin_places(after), [*map(ElementId, ids)], target)) == keys(by_hand)
        break


@pytest.mark.parametrize("seed", list_seeds(10, 30))
def test_saving_in_another_folder_and_back(seed):
    graph, _ = made(seed)
    graph = graph.add("photo", catalogue()["read_image"](path="plates/a.exr"))
    graph, _ = make_group(graph, [ElementId("photo")])
    there = paths.rebase_paths(graph, "deep/er")
    photo = there.nodes["group"].graph
    assert photo.folder == "deep/er"
    assert photo.nodes["photo"].path == "../../plates/a.exr"
    assert paths.rebase_paths(there, "") == graph
