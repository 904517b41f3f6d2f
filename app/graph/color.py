"""The color settings of a graph, for reading files."""

from __future__ import annotations

from pathlib import PurePath

from halation.nodes import ColorSettings
from msgspec import structs

from .graph import Graph

BUILT_IN = "ocio://"
"""The prefix of the configs that come with OpenColorIO."""


def color_settings(graph: Graph) -> ColorSettings:
    """The color settings of a graph, with the path of the config made relative to the current folder."""
    color = graph.settings.color
    if not color.config or color.config.startswith(BUILT_IN):
        return color
    return structs.replace(color, config=str(PurePath(graph.folder, color.config)))
