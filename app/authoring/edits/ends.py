"""Edits of the inputs of graphs that become groups."""

from __future__ import annotations

from dataclasses import replace

from ...graph import Graph


def without_samples(graph: Graph) -> Graph:
    """The graph without the files of its inputs: as a group, it gets its pictures through links."""
    return replace(graph, inputs={name: replace(end, file="", layer="") for name, end in graph.inputs.items()})
