"""The facts of a picture or video that rendering needs, from its header."""

from __future__ import annotations

from pathlib import Path

from ..graph.frames import is_video
from ..resources.sandbox import Sandbox
from .layers import ImageInfo
from .pictures.open import describe_picture, open_picture


def read_info(path: str | Path, sandbox: Sandbox) -> ImageInfo:
    """Read the header.

    Raises:
        InputError: missing, empty, damaged, deep or not a picture.
    """
    if is_video(str(path)):
        from .video import describe_video, read_video_info

        return describe_video(read_video_info(str(path), sandbox=sandbox), sandbox=sandbox)
    with open_picture(path, sandbox=sandbox) as picture:
        return describe_picture(picture, str(path), sandbox=sandbox)
