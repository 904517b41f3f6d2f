"""Finds faults in the color settings of a graph, before any file is read."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct

from ..errors import HalationError
from ..graph import OUTPUTS, Graph, color_settings
from ..resources.sandbox import Sandbox
from .display import NO_VIEW, VIDEO_VIEW, find_view
from .file_space import find_requested_space
from .management import get_color_manager


class ColorFault(Struct, frozen=True):
    """A fault, the input or output of the graph that has it, if any, and its place in the file."""

    error: HalationError
    node: str
    name: str
    at: str


def find_color_faults(graph: Graph, sandbox: Sandbox) -> Iterator[ColorFault]:
    """Yields a config that cannot be read, an unknown working space, unknown views of outputs and unknown color spaces
    of inputs."""
    color = color_settings(graph)
    manager = get_color_manager(color, sandbox)
    views = {name: end.view for name, end in graph.outputs.items() if end.view not in ("", NO_VIEW, VIDEO_VIEW)}
    spaces = {name: end.color_space for name, end in graph.inputs.items() if end.color_space and end.kind.is_color}
    if manager.is_plain and not views and not spaces:
        return
    names_something = color.config or color.working or views or spaces
    try:
        if names_something:
            _ = manager.config, manager.working
    except HalationError as error:
        yield ColorFault(error, "", "", "settings.color")
        return
    for name, view in views.items():
        try:
            find_view(view, "", manager)
        except HalationError as error:
            fault = type(error)(f"output '{name}': {error}")
            yield ColorFault(fault, OUTPUTS, name, f"outputs.{name}.view")
    for name, space in spaces.items():
        try:
            find_requested_space(space, manager)
        except HalationError as error:
            fault = type(error)(f"input '{name}': {error}")
            yield ColorFault(fault, f"inputs.{name}", "", f"inputs.{name}.color_space")
