"""Cached frames stay when a node is edited that nothing reads, and only then: they are those of the edited graph."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from halation.authoring.preview.read_nodes import list_read_nodes, shows_same_pictures
from halation.graph import Control, Expression, Graph, Group, Input, Keys, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.input.noise import Noise
from halation.renderer import RenderRequest
from previews import pixels, settle
from sequences import noise_graph

PORTS = {"A": Port("outputs", "out")}
STOPS = Port("node", "stops")


def make_graph() -> Graph:
    """A moving noise, and an exposure with keys that nothing reads."""
    graph = noise_graph(Exposure(), (1, 6)).add("spare", Exposure()).add("other", Noise())
    graph = graph.connect(Port("noise", "out"), Port("spare", "image"))
    return graph.animate(STOPS, Keys().set(1, 0.0).set(6, 2.0))


SPARE = Port("spare", "stops")
UNREAD = {
    "value": lambda graph: graph.set(SPARE, 2.0),
    "keys": lambda graph: graph.animate(SPARE, Keys().set(1, 0.0).set(6, 2.0)),
    "expression": lambda graph: graph.animate(SPARE, Expression("node.stops")),
    "link": lambda graph: graph.connect(Port("other", "out"), Port("spare", "image")),
    "unlinked": lambda graph: graph.disconnect(Port("spare", "image")),
    "added": lambda graph: graph.add("new", Exposure()).connect(Port("node", "out"), Port("new", "image")),
    "removed": lambda graph: graph.remove("spare"),
    "muted": lambda graph: replace(graph, muted=frozenset({"spare"})),
}
READ = {
    "value": lambda graph: graph.set(Port("noise", "size"), 9.0),
    "keys": lambda graph: graph.animate(STOPS, Keys().set(1, 0.0).set(6, 1.0)),
    "link": lambda graph: graph.connect(Port("other", "out"), Port("node", "image")),
    "muted": lambda graph: replace(graph, muted=frozenset({"node"})),
    "settings": lambda graph: replace(graph, settings=Settings((15, 9), (1, 6))),
}


def show(preview, graph: Graph, frame: int) -> np.ndarray:
    preview.want(graph, PORTS, frame=frame)
    settle(preview)
    return pixels(preview, preview.renderer).copy()


def render(engine, graph: Graph, frame: int) -> np.ndarray:
    return engine.render(graph, RenderRequest(frame=frame, targets=PORTS))["A"]


@pytest.mark.parametrize("name", UNREAD)
def test_no_frame_is_dropped(preview, engine, name: str) -> None:
    graph = make_graph()
    for frame in (1, 2, 3, 4):
        show(preview, graph, frame)
    edited = UNREAD[name](graph)
    preview.want(edited, PORTS, frame=4)
    settle(preview)
    assert preview.frames == (1, 2, 3, 4)
    passes = engine.runner.counters.passes
    preview.skims = True
    for frame in (2, 4):
        np.testing.assert_array_equal(show(preview, edited, frame), render(engine, edited, frame))
    assert engine.runner.counters.passes >= passes


@pytest.mark.parametrize("name", READ)
def test_frames_of_another_picture_are_dropped(preview, engine, name: str) -> None:
    graph = make_graph()
    for frame in (1, 2, 3):
        show(preview, graph, frame)
    edited = READ[name](graph)
    preview.want(edited, PORTS, frame=3)
    settle(preview)
    assert preview.frames == (3,)
    np.testing.assert_array_equal(show(preview, edited, 2), render(engine, edited, 2))


def test_what_an_expression_names_is_read() -> None:
    graph = make_graph().animate(STOPS, Expression("spare.stops + 1"))
    assert list_read_nodes(graph, PORTS.values()) == {"noise", "node", "spare"}
    assert not shows_same_pictures(graph, graph.set(SPARE, 2.0), PORTS.values())
    controlled = replace(make_graph(), controls={"light": Control(SPARE)}).animate(STOPS, Expression("light"))
    assert not shows_same_pictures(controlled, controlled.set(SPARE, 2.0), PORTS.values())


def test_groups_are_looked_into() -> None:
    inner = Graph().add("noise", Noise()).add("spare", Exposure())
    inner = inner.connect(Port("noise", "out"), Port("spare", "image")).add_output("out", Output(Kind.IMAGE))
    inner = inner.connect(Port("noise", "out"), Port("outputs", "out"))
    graph = Graph(settings=Settings((8, 8))).add("group", Group(inner)).add_output("out", Output(Kind.IMAGE))
    graph = graph.connect(Port("group", "out"), Port("outputs", "out"))
    edited = replace(graph, nodes={"group": Group(inner.set(SPARE, 2.0))})
    assert shows_same_pictures(graph, edited, PORTS.values())
    assert not shows_same_pictures(graph, edited, [Port("group/spare", "out")])
    louder = replace(graph, nodes={"group": Group(inner.set(Port("noise", "size"), 2.0))})
    assert not shows_same_pictures(graph, louder, PORTS.values())


def test_the_first_picture_of_a_graph_without_a_size_is_read() -> None:
    from halation.nodes import catalogue

    graph = replace(make_graph(), settings=Settings()).add("file", catalogue()["read_image"](path="a.exr"))
    edited = graph.set(Port("file", "path"), "b.exr")
    assert not shows_same_pictures(graph, edited, PORTS.values())
    with_size = replace(graph, settings=Settings((8, 8)))
    assert shows_same_pictures(with_size, replace(edited, settings=Settings((8, 8))), PORTS.values())


@pytest.mark.parametrize("reads_by", ["a node", "an input"])
def test_a_picture_within_a_group_may_decide_the_size(reads_by: str) -> None:
    """Beside nodes and inputs that read no file."""
    from halation.nodes import catalogue

    read = catalogue()["read_image"]

    def make(path: str) -> Graph:
        inner = Graph().add("light", Exposure()).add_input("plain", Input(Kind.IMAGE))
        if reads_by == "a node":
            inner = inner.add("file", read(path=path))
        else:
            inner = inner.add_input("read", Input(Kind.IMAGE, file=path))
        return replace(make_graph(), settings=Settings()).add("group", Group(inner))

    assert not shows_same_pictures(make("a.exr"), make("b.exr"), PORTS.values())
    assert shows_same_pictures(make("a.exr"), make("a.exr"), PORTS.values())
