"""What the color layers of a file are in, and how that is known."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from halation.nodes import ColorSettings

from ..color.file_space import FileSpace, space_of
from ..color.management import DEFAULT_COLOR, managed
from ..errors import HalationError
from ..graph.frames import is_video
from .info import describe_picture, open_picture
from .pictures.color_hints import read_color_hints


def find_layer_spaces(
    path: str | Path, color: ColorSettings = DEFAULT_COLOR, wanted: str = ""
) -> Mapping[str, FileSpace]:
    """The color space of every layer of color by its full name; data has none. `wanted` is what somebody says it is.

    Raises:
        InputError: the file cannot be read, or names a space that nobody knows.
        GraphError, UsageError: `wanted` is unknown, or there is no config.
    """
    if is_video(str(path)):
        return {}
    found: dict[str, FileSpace] = {}
    with open_picture(path) as handle:
        header = describe_picture(handle, str(path))
        for layer in header.layers:
            if not layer.is_data:
                handle.seek_subimage(layer.part, 0)
                hints = read_color_hints(handle.spec(), header.format, layer.format.startswith("uint"))
                found[layer.full_name] = space_of(str(path), hints, managed(color), wanted)
    return found


def describe_color_spaces(path: str | Path) -> list[tuple[str, ...]]:
    """Rows of words: layer, color space, reason; one row where all are alike; a sentence where nobody can tell."""
    try:
        found = find_layer_spaces(path)
    except HalationError as fault:
        return [("unknown", str(fault).removeprefix(f"{path}: "))]
    said = {(item.name, item.reason) for item in found.values()}
    if len(said) == 1:
        return [*said]
    return [(name, item.name, item.reason) for name, item in found.items()]
