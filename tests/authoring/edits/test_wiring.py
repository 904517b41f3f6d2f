"""Links: what fits, what is put into them and taken out."""

from __future__ import annotations

import pytest
from halation.authoring.edits import routes, wiring
from halation.authoring.edits.decor import add_frame
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import list_elements, with_places
from halation.authoring.edits.layout import pin_places, positions
from halation.authoring.edits.room import MARGIN, make_space
from halation.errors import GraphError
from halation.graph import Graph, Input, Output, Port, Unknown
from halation.nodes import Kind
from toy_nodes import Blend, Flow, Gain, Meter, Photo, Slope, Soften, Split, chain

TOYS = {kind.id: kind for kind in (Gain, Soften, Blend, Split, Slope, Flow, Meter, Photo)}


def port(text: str) -> Port:
    return Port.parse(text)


def links(graph: Graph) -> dict[str, str]:
    return {str(end): str(start) for end, start in graph.links.items()}


def test_the_types_that_fit_a_source():
    graph = chain(1).add_input("depth", Input(Kind.FIELD)).add("slope", Slope()).add("lens", Unknown("lens"))
    assert wiring.list_fitting_types(graph, port("inputs.beauty"), True, TOYS) == (
        "gain",
        "soften",
        "blend",
        "split",
        "flow",
        "meter",
    )
    assert "slope" in wiring.list_fitting_types(graph, port("inputs.depth"), True, TOYS)
    assert wiring.list_fitting_types(graph, port("slope.flow"), True, TOYS) == ("gain", "flow"), (
        "a position is a vector of two"
    )
    assert wiring.list_fitting_types(graph, port("lens.out"), True, TOYS) == tuple(
        name for name in TOYS if name != "photo"
    )


def test_the_types_that_fit_a_target():
    graph = Graph().add("flow", Flow()).add("blend", Blend())
    assert wiring.list_fitting_types(graph, port("flow.by"), False, TOYS) == ("split", "slope", "meter"), (
        "a field fits too"
    )
    assert wiring.list_fitting_types(graph, port("blend.mask"), False, TOYS) == ("split", "meter")
    assert "photo" in wiring.list_fitting_types(graph, port("blend.first"), False, TOYS)


def test_a_link_goes_to_the_first_free_socket_that_fits():
    graph = chain(1).add("blend", Blend()).add("meter", Meter())
    graph = wiring.link_node(graph, "blend", port("n0.out"), True)
    graph = wiring.link_node(graph, "blend", port("inputs.beauty"), True)
    assert links(graph)["blend.first"] == "n0.out"
    assert links(graph)["blend.second"] == "inputs.beauty"
    full = wiring.link_node(graph, "blend", port("inputs.beauty"), True)
    assert links(full)["blend.first"] == "inputs.beauty", "where none is free, the first is taken"
    graph = wiring.link_node(graph.add("split", Split()), "split", port("blend.mask"), False)
    assert links(graph)["blend.mask"] == "split.grey"
    with pytest.raises(GraphError, match=r"'meter.mean' fits no input of node 'photo': it has none"):
        wiring.link_node(graph.add("photo", Photo()), "photo", port("meter.mean"), True)
    with pytest.raises(GraphError, match="form a loop"):
        wiring.link_node(graph, "n0", port("blend.out"), True)


def test_a_refusal_names_types_and_loops():
    graph = chain(2).add("slope", Slope())
    assert wiring.why_not_linkable(graph, port("n0.out"), port("n1.image")) is None
    assert "does not fit a Field" in str(wiring.why_not_linkable(graph, port("n0.out"), port("slope.depth")))
    assert "n0 -> n1 -> n0" in str(wiring.why_not_linkable(graph, port("n1.out"), port("n0.image")))
    assert "no node 'x'" in str(wiring.why_not_linkable(graph, port("x.out"), port("n0.image")))


def test_dots_stay_on_their_side_of_a_node_that_is_put_in_and_come_together_again():
    graph = with_places(pin_places(chain(2)), {ElementId("n0"): (0.0, 0.0), ElementId("n1"): (900.0, 0.0)})
    graph, right = routes.add_dot(graph, port("n1.image"), (700.0, 0.0))
    graph, left = routes.add_dot(graph, port("n1.image"), (300.0, 0.0))
    assert routes.dots_on_link(graph, port("n1.image")) == (left.name, right.name)
    fresh = with_places(graph.add("soften", Soften()), {ElementId("soften"): (500.0, 0.0)})
    graph_in = wiring.insert_node(fresh, "soften", port("n1.image"))
    assert links(graph_in)["n1.image"] == "soften.out"
    assert links(graph_in)["soften.image"] == "n0.out"
    assert routes.routes(graph_in) == {"soften.image": (left.name,), "n1.image": (right.name,)}
    assert wiring.remove_node(graph_in, "soften") == graph
    assert routes.routes(wiring.extract_nodes(graph_in, ["soften"])) == {"n1.image": (left.name, right.name)}


def test_a_node_is_not_put_into_its_own_link_or_into_none():
    for id, target, said in (("n0", "n1.image", "an end of that link"), ("n0", "n0.gain", "nothing is linked")):
        with pytest.raises(GraphError, match=said):
            wiring.insert_node(chain(2), id, port(target))


def test_a_chain_is_put_into_a_link_as_a_whole():
    graph = chain(2).add("a", Soften()).add("b", Blend()).add("photo", Photo())
    graph = graph.connect(port("a.out"), port("b.first")).connect(port("photo.out"), port("b.second"))
    after = wiring.splice_chain(graph, ["photo", "b", "a"], port("n1.image"))
    by_hand = graph.connect(port("n0.out"), port("a.image")).connect(port("b.out"), port("n1.image"))
    assert links(after) == links(by_hand)
    for ids, said in ((["a"], "extract the selection"), (["photo", "n0"], "extract the selection")):
        with pytest.raises(GraphError, match=said):
            wiring.splice_chain(graph, ids, port("n1.image"))
    loose = chain(2).add("a", Soften()).add("b", Soften())
    with pytest.raises(GraphError, match="not a chain"):
        wiring.splice_chain(loose, ["a", "b"], port("n1.image"))


def test_only_what_would_be_covered_is_pushed_aside_and_what_follows_it():
    graph = with_places(
        pin_places(chain(3)),
        {
            ElementId("inputs.beauty"): (0.0, 0.0),
            ElementId("n0"): (200.0, 0.0),
            ElementId("n1"): (450.0, 0.0),
            ElementId("n2"): (700.0, 0.0),
            ElementId("outputs.image"): (950.0, 0.0),
        },
    )
    graph, dot = routes.add_dot(graph, port("n2.image"), (660.0, 0.0))
    graph, frame = add_frame(graph, [ElementId("n2"), ElementId("outputs.image")], positions(graph))
    sizes = {
        key: (180.0, 100.0) for key in list_elements(graph) if "." not in key or key.startswith(("inputs", "outputs"))
    }
    fresh = with_places(graph.add("soften", Soften()), {ElementId("soften"): (400.0, 20.0)})
    sizes["soften"] = (180.0, 100.0)
    after = make_space(
        wiring.insert_node(fresh, "soften", port("n1.image")), [ElementId("soften")], port("n1.image"), sizes
    )
    by = 400.0 + 180.0 + MARGIN - 450.0
    moved = {
        key: spot[0] - positions(graph)[key][0] for key, spot in positions(after).items() if key in list_elements(graph)
    }
    assert moved == {
        "inputs.beauty": 0.0,
        "n0": 0.0,
        "n1": by,
        "n2": by,
        "outputs.image": by,
        dot: by,
        frame: by,
    }
    assert positions(after)["soften"] == (400.0, 20.0)
    below = with_places(fresh, {ElementId("soften"): (400.0, 300.0)})
    left = wiring.insert_node(below, "soften", port("n1.image"))
    assert make_space(left, [ElementId("soften")], port("n1.image"), sizes) is left, "nothing is in the way"
    early = wiring.insert_node(with_places(fresh, {ElementId("soften"): (210.0, 20.0)}), "soften", port("n1.image"))
    after = make_space(early, [ElementId("soften")], port("n1.image"), sizes)
    assert positions(after)["soften"] == (200.0 + 180.0 + MARGIN, 20.0)


def test_extracted_nodes_keep_the_links_among_themselves():
    after = wiring.extract_nodes(chain(4), ["n1", "n2"])
    assert links(after) == {
        "n0.image": "inputs.beauty",
        "n3.image": "n0.out",
        "n2.image": "n1.out",
        "outputs.image": "n3.out",
    }
    with pytest.raises(GraphError, match="in no chain"):
        wiring.extract_nodes(after, ["n1", "n2"])


def test_swapping_the_first_two_inputs():
    graph = chain(1).add("blend", Blend()).connect(port("n0.out"), port("blend.first"))
    once = wiring.swap_inputs(graph, "blend")
    assert links(once)["blend.second"] == "n0.out" and "blend.first" not in links(once)
    assert wiring.swap_inputs(once, "blend") == graph
    both = once.connect(port("inputs.beauty"), port("blend.first"))
    assert links(wiring.swap_inputs(both, "blend"))["blend.second"] == "inputs.beauty"
    with pytest.raises(GraphError, match="fewer than two inputs"):
        wiring.swap_inputs(graph, "n0")
    with pytest.raises(GraphError, match="nothing is linked"):
        wiring.swap_inputs(graph.add("other", Blend()), "other")


def test_a_replaced_node_keeps_values_of_the_same_name_and_type():
    graph = chain(2).set(port("n0.gain"), 0.25)
    after = wiring.replace_node(graph, "n0", Blend)
    assert after.value(port("n0.gain")) == 0.25
    assert links(after)["n0.first"] == "inputs.beauty"
    assert wiring.replace_node(chain(1).set(port("n0.gain"), 9.0), "n0", Soften).nodes["n0"] == Soften()


def test_a_moved_link_takes_its_dots_along():
    graph = pin_places(chain(2).add("blend", Blend()))
    graph, dot = routes.add_dot(graph, port("n1.image"), (1.0, 2.0))
    after = wiring.move_link(graph, port("n1.image"), port("blend.first"))
    assert "n1.image" not in links(after)
    assert routes.routes(after) == {"blend.first": (dot.name,)}


def test_links_from_one_source_share_a_dot():
    graph = pin_places(chain(2).add("blend", Blend()).connect(port("n0.out"), port("blend.first")))
    graph, dot = routes.add_dot(graph, port("n1.image"), (1.0, 2.0))
    graph = routes.join_dot(graph, dot, port("blend.first"))
    assert routes.routes(graph) == {"n1.image": (dot.name,), "blend.first": (dot.name,)}
    assert routes.routes(routes.remove_dots(graph, [dot])) == {}
    assert "dots" in routes.tidy_routes(graph.disconnect(port("n1.image"))).ui, "the other link still passes it"
    gone = routes.tidy_routes(graph.disconnect(port("n1.image")).disconnect(port("blend.first")))
    assert "dots" not in gone.ui
    with pytest.raises(GraphError, match="another source"):
        routes.join_dot(graph, dot, port("outputs.image"))


def test_an_output_can_be_reached_too():
    graph = Graph(outputs={"image": Output()}).add("photo", Photo())
    assert links(wiring.link_node(graph, "photo", port("outputs.image"), False)) == {"outputs.image": "photo.out"}
