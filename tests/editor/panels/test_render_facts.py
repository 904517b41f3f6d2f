"""Which nodes read a render, and from which value."""

from __future__ import annotations

from pathlib import Path

from halation.editor.shared.render_facts import render_file, render_path
from halation.graph import Graph, Group, Port, Unknown
from halation.nodes import catalogue

READERS = {"cryptomatte": "path", "light_groups": "path", "read_render": "path", "solve_camera": "path"}
"""All others read none, though some read pictures, tables, fonts or scenes."""


def test_nodes_that_read_renders() -> None:
    found = {id: render_path(node()) for id, node in catalogue().items()}
    assert {id: name for id, name in found.items() if name} == READERS
    assert render_path(Unknown("read_render", {})) == render_path(Group(Graph())) == ""


def test_the_file_lies_beside_the_graph() -> None:
    nodes = {"render": catalogue()["read_render"](), "picture": catalogue()["read_image"]()}
    graph = Graph(nodes, folder="/shots")
    assert render_file(graph, "render") is None and render_file(graph, "gone") is None
    graph = graph.set(Port("render", "path"), "a/b.exr").set(Port("picture", "path"), "c.exr")
    assert render_file(graph, "render") == Path("/shots/a/b.exr") and render_file(graph, "picture") is None
