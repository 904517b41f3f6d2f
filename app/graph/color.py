"""How a graph manages color, as those see it who read files."""

from __future__ import annotations

from pathlib import PurePath

from halation.nodes import ColorSettings
from msgspec import structs

from .graph import Graph

BUILT_IN = "ocio://"
"""What the names of configs begin with that come with OpenColorIO."""


def color_settings(graph: Graph) -> ColorSettings:
    """The settings of a graph; a config's path, which starts at the graph's folder, as it stands."""
    color = graph.settings.color
    if not color.config or color.config.startswith(BUILT_IN):
        return color
    return structs.replace(color, config=str(PurePath(graph.folder, color.config)))
