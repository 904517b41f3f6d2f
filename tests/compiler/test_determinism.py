"""A graph has one plan: it does not depend on the order of sets, which is another one in every process."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from halation.compiler import Request, compile_graph
from halation.graph import Graph, Input, Output, Port
from halation.inputs.provider import MediaProvider
from halation.nodes import Filter, Node, Source, catalogue
from halation.resources.sandbox import Sandbox


def feed_with_constants(node: type[Node]) -> Graph:
    """A node all of whose inputs are linked to numbers and colors of the graph."""
    graph = Graph().add("node", node())
    for name, socket in node.inputs.items():
        default = 0.5 if socket.channels == 1 else (0.5,) * socket.channels
        graph = graph.add_input(name, Input(socket.kind, socket.channels, default=default))
        graph = graph.connect(Port("inputs", name), Port("node", name))
    name, output = next((name, output) for name, output in node.outputs.items() if not output.socket.kind.is_planned)
    graph = graph.add_output("out", Output(output.socket.kind, output.socket.channels))
    return graph.connect(Port("node", name), Port("outputs", "out"))


def describe_plans() -> str:
    """The plans of all filters that have several inputs, with the texts of their programs."""
    filters = {
        id: node
        for id, node in sorted(catalogue().items())
        if issubclass(node, Filter)
        and not issubclass(node, Source)
        and len(node.inputs) > 1
        and not any(socket.kind.is_planned for socket in node.inputs.values())
    }
    assert len(filters) > 10
    provider = MediaProvider(sandbox=Sandbox(""))
    return "\n".join(
        f"{id}: {compile_graph(feed_with_constants(node), Request(size=(64, 48)), provider)}"
        for id, node in filters.items()
    )


@pytest.mark.parametrize("seed", ["1", "2", "3"])
def test_a_plan_is_the_same_in_every_process(seed: str) -> None:
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    child = subprocess.run([sys.executable, __file__], env=environment, capture_output=True, text=True, check=True)
    assert child.stdout == describe_plans()


if __name__ == "__main__":
    sys.stdout.write(describe_plans())
