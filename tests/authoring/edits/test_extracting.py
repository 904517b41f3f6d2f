"""Nodes that are taken out work by themselves; names of presets; what could be linked with a picture."""

from __future__ import annotations

import pytest
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.extracting import extract_graph
from halation.authoring.edits.wiring import fits_picture
from halation.authoring.library import LONGEST_NAME, find_preset_file, make_preset_name
from halation.errors import GraphError, UsageError
from halation.graph import Graph, Group, Input, Output, Port
from halation.nodes import Kind
from toy_nodes import Blend, Gain, Soften


def chain() -> Graph:
    """An input through three nodes to an output; the second one is read twice."""
    graph = Graph().add_input("image", Input(Kind.IMAGE, 4)).add("a", Gain()).add("b", Soften()).add("c", Gain())
    graph = graph.add("d", Gain()).add_output("out", Output(Kind.IMAGE, 4))
    for source, target in (("inputs.image", "a.image"), ("a.out", "b.image"), ("b.out", "c.image"),
                           ("b.out", "d.image"), ("c.out", "outputs.out")):  # fmt: skip
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph


def take(graph: Graph, *ids: str) -> Graph:
    return extract_graph(graph, [ElementId(id) for id in ids])


def test_what_is_read_from_outside_are_inputs_and_what_nobody_reads_outputs() -> None:
    found = take(chain(), "b", "d")
    assert {*found.nodes} == {"b", "d"} and len(found.inputs) == 1
    (name,) = found.inputs
    assert found.links[Port("b", "image")] == Port("inputs", name) and found.links[Port("d", "image")] == Port(
        "b", "out"
    )
    assert {*found.links.values()} >= {Port("b", "out"), Port("d", "out")}, "c has read b, and nobody reads d"
    assert {found.links[Port("outputs", name)].node for name in found.outputs} == {"b", "d"}
    found.order()


def test_sockets_without_a_link_become_inputs_unless_they_are_optional() -> None:
    found = take(Graph().add("a", Gain()).add("blend", Blend()), "a", "blend")
    needed = {Port(id, socket.name) for id, kind in (("a", Gain), ("blend", Blend)) for socket in kind.inputs.values()
              if not socket.optional}  # fmt: skip
    assert {target for target, source in found.links.items() if source.node == "inputs"} == needed
    assert len(found.inputs) == len(needed) > 2 and len(found.outputs) == 2


def test_a_group_alone_is_what_is_in_it() -> None:
    inner = chain()
    assert {*take(Graph({"g": Group(inner), "x": Gain()}), "g").nodes} == {*inner.nodes}
    with pytest.raises(GraphError):
        take(chain())


def test_what_could_be_linked_with_a_picture() -> None:
    graph = chain()
    assert fits_picture(graph, Port("a", "image"), False) and fits_picture(graph, Port("a", "out"), True)
    graph = graph.add_input("view", Input(Kind.CAMERA)).add_output("view", Output(Kind.CAMERA))
    assert not fits_picture(graph, Port("inputs", "view"), True) and not fits_picture(
        graph, Port("outputs", "view"), False
    )


@pytest.mark.parametrize(
    ("text", "name"), [("My glow", "my_glow"), ("  Two \t words ", "two_words"), ("a-b_c3", "a-b_c3"),
                       ("\u00c4rger", "\u00e4rger"), ("x" * LONGEST_NAME, "x" * LONGEST_NAME)]
)  # fmt: skip
def test_names_of_presets_are_names_of_files(text: str, name: str) -> None:
    assert make_preset_name(text) == name


@pytest.mark.parametrize(
    ("text", "words"),
    [("", "type a name"), ("  ", "type a name"), ("x" * (LONGEST_NAME + 1), "too long"), ("a/b", "letters, digits"),
     ("a.b", "letters, digits"), ("-a", "no - at the start"), ("CON", "Windows"), ("lpt1", "Windows"),
     ("Soft bloom", "is a preset of Halation")],
)  # fmt: skip
def test_what_is_no_name_of_a_preset(text: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        make_preset_name(text)


def test_the_file_of_a_preset_is_the_one_that_is_there(tmp_path) -> None:
    (tmp_path / "My_Glow.json").write_text("{}")
    assert find_preset_file("my_glow", tmp_path) == tmp_path / "My_Glow.json"
    assert find_preset_file("other", tmp_path) == tmp_path / "other.json"
