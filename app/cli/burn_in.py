"""`halation render --burn-in`: file, timecode and frame over every picture that is written."""

from __future__ import annotations

from ..errors import UsageError
from ..graph import INPUTS, OUTPUTS, Graph, Group, Port
from ..resources.sandbox import UNRESTRICTED

PRESET = "burn_in"


def add_burn_in(graph: Graph) -> Graph:
    """The graph with the preset `burn_in` as a group before each output that is a picture. Raises UsageError."""
    from dataclasses import replace

    from halation.nodes import Kind
    from halation.presets import paths

    from ..document import load

    ends = [Port(OUTPUTS, name) for name, end in graph.outputs.items() if end.kind is Kind.IMAGE]
    linked = [end for end in ends if end in graph.links]
    if not linked:
        raise UsageError("--burn-in: no output of the graph is a picture that could be written on")
    preset = load(next(path for path in paths() if path.stem == PRESET), sandbox=UNRESTRICTED)
    inputs = {name: replace(end, file="", layer="") for name, end in preset.inputs.items()}
    body = replace(preset, inputs=inputs)
    (source,), (result,) = body.inputs, body.outputs
    for end in linked:
        id = _find_free_name(graph)
        graph = graph.add(id, Group(body)).connect(graph.links[end], Port(id, source)).connect(Port(id, result), end)
    return graph


def _find_free_name(graph: Graph) -> str:
    """A name that no node has."""
    used_names, number = {*graph.nodes, INPUTS, OUTPUTS}, 1
    while (name := PRESET if number == 1 else f"{PRESET}_{number}") in used_names:
        number += 1
    return name
