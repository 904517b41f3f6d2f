"""Copying as text, pasting from it."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from halation.authoring.edits.clipboard import copy_elements, cut_part, paste_part, read_part
from halation.authoring.edits.decor import add_comment, add_frame
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import entry
from halation.authoring.edits.layout import pin_places, positions
from halation.authoring.edits.naming import name_copy
from halation.authoring.edits.routes import add_dot, routes
from halation.document import dumps
from halation.errors import DocumentError, GraphError
from halation.graph import Control, Graph, Input, Output, Port
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain, Photo, chain


def port(text: str) -> Port:
    return Port.parse(text)


def links(graph: Graph) -> dict[str, str]:
    return {str(end): str(start) for end, start in graph.links.items()}


def moved(graph: Graph, *chosen: str, keep_links: bool = False) -> tuple[Graph, tuple[str, ...]]:
    """`graph` with a copy of some of its elements."""
    return paste_part(
        graph,
        read_part(copy_elements(graph, chosen), "", TOYS, sandbox=UNRESTRICTED),
        positions(graph),
        keep_links=keep_links,
    )


def test_ids_are_fresh_and_links_among_the_copies_are_kept():
    graph = pin_places(chain(3).add_control("glow", Control(port("n1.gain"))).mute("n2"))
    after, put = moved(graph, "n1", "n2")
    assert put == ("n3", "n4")
    assert links(after) == {**links(graph), "n4.image": "n3.out"}
    assert after.nodes["n3"] == graph.nodes["n1"]
    assert after.muted == {"n2", "n4"}
    assert after.controls == graph.controls, "exposed values are not copied"


def test_a_duplicate_is_fed_by_the_same():
    graph = pin_places(chain(3))
    after, _ = moved(graph, "n1", "n2", keep_links=True)
    assert links(after) == {**links(graph), "n3.image": "n0.out", "n4.image": "n3.out"}
    elsewhere, _ = paste_part(Graph(), cut_part(graph, {ElementId("n1")}), {}, keep_links=True)
    assert links(elsewhere) == {}, "what fed it is not there"


def test_nothing_is_exactly_covered():
    graph = pin_places(chain(2))
    before = positions(graph)
    after, put = moved(graph, "n0")
    assert positions(after)[put[0]] == (before["n0"][0] + 24, before["n0"][1] + 24)
    again, more = moved(after, "n0")
    assert positions(again)[more[0]] == (before["n0"][0] + 48, before["n0"][1] + 48)
    placed, put = paste_part(graph, cut_part(graph, {ElementId("n0"), ElementId("n1")}), before, at=(-500.0, 70.0))
    assert [positions(placed)[key] for key in put] == [(-500, 70), (-240, 70)]


def test_frames_comments_and_dots_come_along():
    graph = pin_places(chain(2))
    graph, dot = add_dot(graph, port("n1.image"), (1.0, 2.0))
    graph, frame = add_frame(graph, [ElementId("n0")], positions(graph), "Title")
    graph, note = add_comment(graph, (5.0, 5.0), "Note")
    after, put = moved(graph, "n0", "n1", frame, note)
    assert set(put) == {"n2", "n3", "frames.f2", "comments.c2", "dots.d2"}
    assert routes(after) == {"n1.image": (dot.name,), "n3.image": ("d2",)}
    assert after.ui["frames"]["f2"]["title"] == "Title"
    assert after.ui["comments"]["c2"]["text"] == "Note"


def test_ends_are_shared_where_they_are_the_same_and_added_where_not():
    graph = pin_places(chain(1))
    after, put = moved(graph, "inputs.beauty", "n0", "outputs.image")
    assert links(after) == {**links(graph), "n1.image": "inputs.beauty", "outputs.image2": "n1.out"}
    assert set(put) == {"n1", "outputs.image2"}
    other = pin_places(Graph(inputs={"beauty": Input(Kind.FIELD)}, outputs={"image": Output()}))
    there, _ = paste_part(other, cut_part(graph, set(positions(graph))), positions(other))
    assert links(there) == {"n0.image": "inputs.beauty2", "outputs.image": "n0.out"}
    alone, put = moved(graph, "inputs.beauty")
    assert put == ("inputs.beauty2",) and "beauty2" in alone.inputs


def test_a_whole_graph_file_can_be_pasted():
    graph = chain(2)
    after, put = paste_part(Graph(), read_part(dumps(graph), "", TOYS, sandbox=UNRESTRICTED), {})
    assert set(put) == {"n0", "n1", "inputs.beauty", "outputs.image"}
    assert links(after) == links(graph)


def test_relative_paths_lead_to_the_same_files(tmp_path):
    (tmp_path / "one").mkdir()
    graph = Graph(nodes={"p": Photo(path="a.exr")}, folder=str(tmp_path / "one"))
    found = read_part(copy_elements(graph, [ElementId("p")]), str(tmp_path / "two"), TOYS, sandbox=UNRESTRICTED)
    assert found.nodes["p"] == Photo(path="../one/a.exr")
    assert not found.extra


def test_unknown_keys_of_nodes_come_along():
    graph = replace(chain(1), extra={"nodes.n0": {"later": 1}, "": {"other": 2}})
    after, _ = paste_part(graph, cut_part(graph, {ElementId("n0")}), {})
    assert after.extra == {"nodes.n0": {"later": 1}, "nodes.n1": {"later": 1}, "": {"other": 2}}


@pytest.mark.parametrize(
    ("name", "kind", "wanted"),
    [
        ("blur", "", "blur2"),
        ("n3", "", "n4"),
        ("blur9", "", "blur11"),
        ("free", "", "free"),
        ("convolve3x3", "convolve3x3", "convolve3x33"),
        ("convolve3x32", "convolve3x3", "convolve3x33"),
        ("7", "", "8"),
    ],
)
def test_names_of_copies(name, kind, wanted):
    assert name_copy(name, {"blur", "n3", "blur9", "blur10", "convolve3x3", "convolve3x32", "7"}, kind) == wanted


@pytest.mark.parametrize("text", ["", "some words", "[1]", "https://example.org"])
def test_text_that_is_no_graph(text):
    with pytest.raises(GraphError, match="no nodes to paste"):
        read_part(text, "", TOYS, sandbox=UNRESTRICTED)


def test_a_damaged_graph_says_where():
    with pytest.raises(DocumentError, match="clipboard: not valid JSON"):
        read_part('{"halation": 1, ', "", TOYS, sandbox=UNRESTRICTED)
    with pytest.raises(DocumentError, match="this is no graph"):
        read_part(json.dumps({"from": 3}), "", TOYS, sandbox=UNRESTRICTED)


def test_an_empty_graph_has_nothing_to_paste():
    with pytest.raises(GraphError, match="nothing to paste: copy nodes"):
        paste_part(chain(1), Graph().add("x", Gain()).remove("x"), {})


@pytest.mark.parametrize("state", [True, False, None])
def test_a_copy_is_folded_if_the_original_is(state):
    graph = pin_places(chain(3))
    nodes = {**graph.ui["nodes"], "n1": {**graph.ui["nodes"]["n1"], "collapsed": state}}
    after, (copy, other) = moved(replace(graph, ui={**graph.ui, "nodes": nodes}), "n1", "n2")
    assert after.ui["nodes"][copy].get("collapsed", False) is (state is True)
    assert "collapsed" not in after.ui["nodes"][other]


@pytest.mark.parametrize("state", [True, False, None])
def test_an_input_of_the_graph_is_folded_if_the_original_is(state):
    """In a graph without one of that name and type, where the copy becomes one."""
    source = pin_places(chain(1).add_input("dirt", Input(Kind.IMAGE)).connect(port("inputs.dirt"), port("n0.image")))
    places = {**source.ui["nodes"], "inputs.dirt": {**source.ui["nodes"]["inputs.dirt"], "collapsed": state}}
    source = replace(source, ui={**source.ui, "nodes": places})
    part = read_part(copy_elements(source, ("inputs.dirt", "n0")), "", TOYS, sandbox=UNRESTRICTED)
    after, _ = paste_part(Graph(), part, {})
    assert entry(after, ElementId("inputs.dirt")).get("collapsed", False) is (state is True)
