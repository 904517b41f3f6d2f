"""Graphs for tests of the canvas, and points on it."""

from __future__ import annotations

from halation.authoring.commands import ReplaceGraph
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import with_places
from halation.graph import Graph, Input, Output, Port
from halation.nodes import catalogue


def chain(*types: str) -> Graph:
    """Nodes of those types in a row between an input and an output, far enough apart to drop something between."""
    graph = Graph().add_input("beauty", Input(default=0.5)).add_output("image", Output())
    last, places = Port("inputs", "beauty"), {ElementId("inputs.beauty"): (0.0, 0.0)}
    for at, name in enumerate(types, 1):
        graph = graph.add(name, catalogue()[name]())
        graph = graph.connect(last, Port(name, next(iter(catalogue()[name].inputs))))
        last, places[ElementId(name)] = Port(name, "out"), (at * 320.0, 0.0)
    places[ElementId("outputs.image")] = (len(types) * 320.0 + 320.0, 0.0)
    return with_places(graph.connect(last, Port("outputs", "image")), places)


def row(count: int) -> Graph:
    """Many nodes `n0`, `n1`, ... that feed each other, in lines of twenty, and an output."""
    graph, places = Graph().add_output("image", Output()), dict[ElementId, tuple[float, float]]()
    for number in range(count):
        id = f"n{number}"
        graph = graph.add(id, catalogue()["exposure"]())
        if number:
            graph = graph.connect(Port(f"n{number - 1}", "out"), Port(id, "image"))
        places[ElementId(id)] = (number % 20 * 240.0, number // 20 * 160.0)
    return with_places(graph.connect(Port(f"n{count - 1}", "out"), Port("outputs", "image")), places)


def show(ui, graph: Graph, zoom: float | None = 0.8) -> None:
    """Put a graph on the canvas, without pictures."""
    ui.editor.dialogs.open.clear()
    ui.editor.store.change(thumbnails=False)
    ui.session.apply(ReplaceGraph("Test", graph, ()))
    ui.editor.canvas.fit()
    ui.wait(4)
    ui.editor.canvas.zoom = zoom or ui.editor.canvas.zoom
    ui.wait(4)


def empty(ui) -> tuple[float, float]:
    """A point of the canvas with nothing below it, under the middle of the graph."""
    x, y = ui.at("node inputs.beauty")
    return x + 40.0, y + 150.0
