"""Frames of videos as layers of pictures."""

from __future__ import annotations

from collections.abc import Sequence

import OpenImageIO as oiio

from ...color.file_space import AUTO
from ...resources.input_files import check_file, fingerprint
from ...resources.sandbox import Sandbox
from ..channels import ChannelPart, group_channels
from ..convert import LayerRequest, Pixels, convert_layer, select_channels
from ..layers import ImageInfo, find_layer
from ..limits import check_size
from .index import VideoInfo, survey_video
from .planes import convert_frame
from .reader import read_frame


def read_video_info(path: str, sandbox: Sandbox) -> VideoInfo:
    """What is known of a video. Raises InputError."""
    check_file(path, sandbox=sandbox)
    return survey_video(path, fingerprint(path, sandbox=sandbox), sandbox=sandbox)[0]


def describe_video(video: VideoInfo, sandbox: Sandbox) -> ImageInfo:
    """The description of a video as a picture of one layer. Raises InputError."""
    check_size(video.path, video.size)
    channels = ("R", "G", "B", "A") if video.alpha else ("R", "G", "B")
    format = "uint8" if video.bits == 8 else "uint16" if video.bits < 32 else "float32"
    part = ChannelPart(0, "", channels, (format,) * len(channels), "")
    return ImageInfo(
        video.path,
        video.size,
        group_channels([part]),
        fingerprint(video.path, sandbox=sandbox),
        f"video, {video.codec}",
    )


def read_video_layers(path: str, requests: Sequence[LayerRequest], frame: int, sandbox: Sandbox) -> list[Pixels]:
    """One frame of a video as the array of a socket. Raises InputError if it does not exist or is damaged.

    Color is decoded to light by the video's own curve, unless the user says which color space its numbers are in.
    """
    check_file(path, sandbox=sandbox)
    mark = fingerprint(path, sandbox=sandbox)
    video = survey_video(path, mark, sandbox=sandbox)[0]
    info = describe_video(video, sandbox=sandbox)
    picture = convert_frame(read_frame(path, mark, frame, sandbox=sandbox), video)
    results: list[Pixels] = []
    for request in requests:
        layer = find_layer(info, request.layer)
        keeps_numbers = not request.wants_color or layer.is_data or request.space not in AUTO
        block, encoding = (picture.numbers, "") if keeps_numbers else picture.light
        spec = oiio.ImageSpec(block.shape[1], block.shape[0], block.shape[2], "float")
        spec.attribute("oiio:ColorSpace", encoding)
        spec.attribute("oiio:UnassociatedAlpha", 1)
        results.append(convert_layer(select_channels(block, layer.indices, 0), layer, request, spec, info))
    return results
