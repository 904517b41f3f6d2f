"""Faults in the color settings of a graph are found before any file is read, each at the place that has it."""

from __future__ import annotations

import pytest
from halation.color.graph_faults import find_color_faults
from halation.graph import Graph, Input, Output, Settings
from halation.lint import compiled
from halation.nodes import ColorSettings, Kind
from halation.resources.sandbox import UNRESTRICTED


def make(view: str = "", space: str = "", kind: Kind = Kind.IMAGE, color: ColorSettings | None = None) -> Graph:
    """A graph with an input and an output, and one more output that asks for nothing."""
    graph = Graph(settings=Settings(color=color)) if color else Graph()
    graph = graph.add_input("beauty", Input(kind, 4 if kind is Kind.IMAGE else 1, color_space=space))
    return graph.add_output("image", Output(Kind.IMAGE, 4, view=view)).add_output("more", Output(Kind.IMAGE, 4))


def find(graph: Graph) -> list[tuple[str, str, str]]:
    return [(fault.node, fault.name, fault.at) for fault in find_color_faults(graph, UNRESTRICTED)]


@pytest.mark.parametrize("view", ["", "none", "video"])
def test_views_that_need_no_config(view: str) -> None:
    assert find(make(view)) == []


def test_unknown_names_are_faults_of_their_ends() -> None:
    assert find(make("moonlight")) == [("outputs", "image", "outputs.image.view")]
    assert find(make(space="moonlight")) == [("inputs.beauty", "", "inputs.beauty.color_space")]
    assert len(find(make("moonlight", "moonlight"))) == 2
    (fault,) = find_color_faults(make("moonlight"), UNRESTRICTED)
    assert str(fault.error).startswith("output 'image': ") and "moonlight" in str(fault.error)
    (fault,) = find_color_faults(make(space="moonlight"), UNRESTRICTED)
    assert str(fault.error).startswith("input 'beauty': ")


def test_the_space_of_data_does_not_matter() -> None:
    assert find(make(space="moonlight", kind=Kind.FIELD)) == []


@pytest.mark.parametrize("color", [ColorSettings("gone.ocio", ""), ColorSettings("", "moonlight")])
def test_a_config_or_a_working_space_that_is_not_there_comes_alone(color: ColorSettings) -> None:
    assert find(make("moonlight", "moonlight", color=color)) == [("", "", "settings.color")]


@pytest.mark.parametrize(
    ("graph", "is_asked"),
    [
        (Graph().add_output("image", Output(Kind.IMAGE, 4, view="moonlight")), True),
        (make("moonlight"), True), (make(space="moonlight"), True), (make(color=ColorSettings("", "ACEScg")), True),
        (make(), False), (make("none"), False), (Graph(), False),
    ],
)  # fmt: skip
def test_the_linter_asks_only_where_something_is_named(
    monkeypatch: pytest.MonkeyPatch, graph: Graph, is_asked: bool
) -> None:
    asked: list[Graph] = []
    monkeypatch.setattr(
        "halation.color.graph_faults.find_color_faults", lambda graph, sandbox: asked.append(graph) or ()
    )
    assert not [*compiled._color_faults(graph, UNRESTRICTED)] and bool(asked) is is_asked  # pyright: ignore
