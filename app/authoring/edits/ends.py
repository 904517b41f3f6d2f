"""Ends of graphs that serve as nodes."""

from __future__ import annotations

from dataclasses import replace

from ...graph import Graph


def without_samples(graph: Graph) -> Graph:
    """The graph without the files of its inputs: what it works on is linked to it."""
    return replace(graph, inputs={name: replace(end, file="", layer="") for name, end in graph.inputs.items()})
