"""Reads layers as the pixels that sockets of a graph take.

From a path to an array, one function for each step:

1. open the file and read its header: `pictures.open.open_picture`, `describe_picture`;
2. choose the layer: `layers.find_layer`;
3. decode its channels, in the file's precision: `pictures.reader.decode_layers`;
4. convert them to what the socket takes (color, repair, placement): `convert.convert_layer`.

For a video, `video.reader` decodes the frame instead; the last step is the same. `sequences.find_frame_file` has
already found the file of a frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from halation.nodes import Kind

from ..color.management import ColorManager, get_default_color_manager
from ..graph.frames import is_video
from ..resources.sandbox import Sandbox
from .convert import LayerRequest, Pixels
from .pictures.reader import read_picture_layers


def read_layer(
    path: str | Path,
    layer: str,
    kind: Kind,
    width: int = 4,
    frame: int = 1,
    *,
    space: str = "",
    manager: ColorManager | None = None,
    sandbox: Sandbox,
) -> Pixels:
    """Read one layer over the whole display window; pixels without data are 0.

    IMAGE is RGBA in the working space, premultiplied, alpha 1 where the file has none. FIELD is the first channel,
    VECTOR the first `width` ones, missing ones 0: both are the numbers of the file, without any color conversion.
    Non-finite color becomes the mean of its finite neighbors (OpenImageIO, fixNonFinite BOX3); in data a NaN
    becomes 0 and infinity, the background of many depth passes, stays. Of a video it is the frame of that number.

    Raises:
        InputError: the file or the layer is missing, or the file is damaged.
        GraphError, UsageError: `space` is unknown, or there is no config.
    """
    return read_layers(
        path, [LayerRequest(layer, kind, width, space, manager or get_default_color_manager())], frame, sandbox=sandbox
    )[0]


def read_layers(
    path: str | Path, requests: Sequence[LayerRequest], frame: int = 1, *, sandbox: Sandbox
) -> list[Pixels]:
    """Read several layers of one file; layers of one part are decoded together.

    Raises:
        InputError: as `read_layer`.
    """
    if is_video(str(path)):
        from .video.layers import read_video_layers

        return read_video_layers(str(path), requests, frame, sandbox=sandbox)
    return read_picture_layers(str(path), requests, sandbox=sandbox)
