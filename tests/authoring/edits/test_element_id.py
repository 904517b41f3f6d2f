"""Ids of elements: written and read back in one place."""

from __future__ import annotations

import pytest
from halation.authoring.edits.element_id import DECOR, NO_ELEMENT, ElementId
from halation.authoring.edits.elements import fresh_decor, list_decor, list_elements, with_entries
from halation.graph import Graph, Port
from toy_nodes import chain


@pytest.mark.parametrize(
    ("kind", "name", "text"),
    [
        ("node", "blur", "blur"),
        ("node", "frames", "frames"),
        ("input", "beauty", "inputs.beauty"),
        ("output", "image", "outputs.image"),
        ("frame", "f1", "frames.f1"),
        ("comment", "c1", "comments.c1"),
        ("dot", "d1", "dots.d1"),
    ],
)
def test_kind_and_name_are_written_and_read_back(kind, name, text) -> None:
    element = ElementId.of(kind, name)
    assert element == text and (ElementId(text).kind, ElementId(text).name) == (kind, name)
    assert element.is_decor == (kind in DECOR) and element.is_note == (kind in ("frame", "comment"))


def test_a_port_is_shown_by_its_node_or_its_end() -> None:
    assert ElementId.of_port(Port("blur", "out")) == "blur"
    beauty = Port("inputs", "beauty")
    assert ElementId.of_port(beauty) == "inputs.beauty" and ElementId.of_port(beauty).port == beauty
    assert ElementId("blur").port is None and not NO_ELEMENT and NO_ELEMENT.port is None


def test_elements_of_a_graph_are_ids() -> None:
    graph = with_entries(chain(1), {ElementId.of(kind, f"{kind[0]}1"): {"x": 1.0} for kind in DECOR})
    elements = list_elements(graph)
    assert elements == ("n0", "inputs.beauty", "outputs.image", "frames.f1", "comments.c1", "dots.d1")
    assert all(isinstance(element, ElementId) for element in elements)
    assert [*list_decor(graph, "dot")] == ["dots.d1"] and fresh_decor(graph, "dot") == "dots.d2"
    assert list_decor(Graph(ui={"frames": {"f1": 7, "": {}}}), "frame") == {}
