"""Planning needs no device: pictures are a header."""

from __future__ import annotations

import pytest
from halation.compiler import Plan, Request, compile_graph
from halation.graph import Graph
from halation.resources.picture import Picture
from headers import Headers

SIZE = (37, 23)


@pytest.fixture(scope="session")
def plan():
    """`plan(graph, scale=0.5, fusion=False, ...)` with every graph input bound, but single values with a default."""

    def planned(graph: Graph, **options) -> Plan:
        asked = {name: options.pop(name) for name in ("scale", "size", "targets", "frame") if name in options}
        bindings = {
            name: Picture(name, "", item.kind, item.socket().channels, in_memory=True)
            for name, item in graph.inputs.items()
            if item.default is None or not item.socket().single
        }
        return compile_graph(graph, Request(bindings=bindings, **asked), Headers(SIZE), **options)

    return planned
