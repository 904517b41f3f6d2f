"""Finds the color spaces of the layers of a file, and the reasons."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..color.display import NO_VIEW, VIDEO_VIEW
from ..color.encoding import VIDEO_SPACE
from ..color.file_space import FileSpace, find_file_space, find_requested_space
from ..color.management import ColorManager, get_default_color_manager
from ..color.transforms import is_display_referred
from ..errors import HalationError
from ..graph.frames import is_video
from ..resources.sandbox import Sandbox
from .layers import Layer
from .pictures.color_hints import read_color_hints
from .pictures.open import describe_picture, open_picture


def find_layer_spaces(
    path: str | Path, manager: ColorManager, space: str = "", *, sandbox: Sandbox
) -> Mapping[str, FileSpace]:
    """The color space of every color layer by its full name; data has none. `space` is what the user says it is.

    Raises:
        InputError: the file cannot be read, or names a space that is unknown.
        GraphError, UsageError: `space` is unknown, or there is no config.
    """
    if is_video(str(path)):
        return {}
    spaces: dict[str, FileSpace] = {}
    with open_picture(path, sandbox=sandbox) as picture:
        info = describe_picture(picture, str(path), sandbox=sandbox)
        for layer in info.layers:
            if not layer.is_data:
                picture.seek_subimage(layer.part, 0)
                hints = read_color_hints(picture.spec(), info.format, layer.format)
                spaces[layer.full_name] = find_file_space(str(path), hints, manager, space)
    return spaces


def find_plain_view(path: str, layer: Layer, manager: ColorManager, space: str = "", *, sandbox: Sandbox) -> str:
    """The view that encodes color as a layer for a screen has it: `none` or `bt1886`; "" for light of a scene.

    A video says so by its transfer characteristics, unless the user says which `space` it is in. Raises the errors of
    `find_layer_spaces`.
    """
    if not is_video(path):
        spaces = find_layer_spaces(path, manager, space, sandbox=sandbox)
        return _choose_plain_view(spaces[layer.full_name], manager)
    if requested := find_requested_space(space, manager):
        return _choose_plain_view(FileSpace(requested.name, "", requested), manager)
    from .video import read_video_info
    from .video.signals import SCENE_TRANSFERS, VIDEO_TRANSFERS

    transfer = read_video_info(path, sandbox=sandbox).transfer
    return "" if transfer in SCENE_TRANSFERS else VIDEO_VIEW if transfer in VIDEO_TRANSFERS else NO_VIEW


def _choose_plain_view(file_space: FileSpace, manager: ColorManager) -> str:
    if not is_display_referred(file_space, manager):
        return ""
    is_for_video = file_space.space is not None and manager.find_header_name(file_space.space) == VIDEO_SPACE
    return VIDEO_VIEW if is_for_video else NO_VIEW


def describe_color_spaces(path: str | Path, sandbox: Sandbox) -> list[tuple[str, ...]]:
    """Rows of words: layer, color space, reason. One row if all layers have the same; one row with the fault if there
    is one."""
    try:
        spaces = find_layer_spaces(path, get_default_color_manager(), sandbox=sandbox)
    except HalationError as error:
        return [("unknown", str(error).removeprefix(f"{path}: "))]
    rows = {layer: _describe_space(space) for layer, space in spaces.items()}
    distinct = set(rows.values())
    if len(distinct) == 1:
        return [*distinct]
    return [(layer, *row) for layer, row in rows.items()]


def _describe_space(space: FileSpace) -> tuple[str, str]:
    return space.name, f"{space.reason}; {space.warning}" if space.warning else space.reason
