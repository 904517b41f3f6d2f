"""Graphs of nodes in a row, as the benchmarks of the editor show them."""

from __future__ import annotations

from dataclasses import replace

from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind, catalogue


def make_chain(types: list[str], size: tuple[int, int]) -> Graph:
    """A noise, then one node after the other, then the output."""
    types_by_name = catalogue()
    graph = Graph().add("noise", types_by_name["noise"]())
    source = Port("noise", "out")
    for number, name in enumerate(types):
        id = f"n{number}"
        graph = graph.add(id, types_by_name[name]())
        first = next(iter(types_by_name[name].inputs))
        graph = graph.connect(source, Port(id, first))
        source = Port(id, next(iter(types_by_name[name].outputs)))
    graph = graph.add_output("image", Output(Kind.IMAGE)).connect(source, Port("outputs", "image"))
    return replace(graph, settings=Settings(size))
