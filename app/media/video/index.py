"""Indexes the frames of a video, so that frame numbers are exact.

Frame 1 is the first that a player shows. What a file says of its length and rate is often wrong, so frames are counted.
Every packet has a time of presentation, and the frames are these times in order, without what an edit list cuts off.
Reading the packets of a file decodes nothing, which is fast enough to be done for every video once.

Packets cannot always be trusted: some have no times, equal or guessed ones, some videos have pictures before the first
key frame, VP8 has hidden frames. So the first eight frames are decoded and compared with the index. Where they differ,
or the packets show one of these signs, the whole video is decoded once, its frames are counted, and a frame is then
reached by counting from the first one. `reader` uses the index to decode from the last key frame before a frame.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from functools import lru_cache
from itertools import islice
from types import MappingProxyType
from typing import Any

from halation.nodes import Size
from msgspec import Struct, field

from ...errors import InputError
from ...resources.sandbox import Sandbox
from .library import HOW_TO_INSTALL, load_pyav

_CHECKED_FRAMES = 8
"""Frames that are decoded to compare them with the packets: more than the frames that codecs reorder (H.264 and H.265
keep up to 16, encoders use 2 to 4), and few enough to decode for every video."""

_CONTAINERS = (
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,matroska,webm,avi,mxf,mpeg,mpegvideo,mpegts,asf,flv,ogg,yuv4mpegpipe,dv"
)
"""Containers that are read: no playlists, which would lead to other files and to the network."""

_HIDING = ("vp8",)
_TIMELESS = ("avi",)
"""Containers that store only the order of decoding; times of presentation are guesses."""

_ALPHA_DECODERS = {"vp8": "libvpx", "vp9": "libvpx-vp9"}
_USUAL_RATE = Fraction(24)
"""Frames per second of a video that names no rate: that of graphs."""

_ATTACHED_PICTURE = 1024
"""The flag of a cover picture: AV_DISPOSITION_ATTACHED_PIC of FFmpeg."""


class KeyFrame(Struct, frozen=True):
    """A packet from which decoding can begin: its time of presentation, and its index among all packets."""

    time: int
    place: int


class FrameIndex(Struct, frozen=True):
    """The places of frames: `times` of presentation in the units of the stream, `places` of packets by their two times.

    Without `times`, frames can only be counted from the first one.
    """

    count: int
    times: tuple[int, ...] = ()
    places: Mapping[tuple[int | None, int | None], int] = field(default_factory=dict[Any, int])
    keys: tuple[KeyFrame, ...] = ()

    def last_key_before(self, time: int) -> int:
        """The index in `keys` of the last key frame at a time or before."""
        return max(bisect_right(self.keys, time, key=lambda key: key.time) - 1, 0)


class VideoInfo(Struct, frozen=True):
    """The facts of a video.

    `pixels` is FFmpeg's name of the pixel format, `bits` those of a channel. `matrix`, `range`, `transfer` and
    `primaries` are the numbers of ITU-T H.273 (range: 1 limited, 2 full), 0 or 2 where the file says nothing.
    """

    path: str
    size: Size
    count: int
    rate: Fraction
    container: str
    codec: str
    pixels: str
    bits: int
    alpha: bool
    matrix: int
    range: int
    transfer: int
    primaries: int
    tags: Mapping[str, str]

    @property
    def seconds(self) -> float:
        """Its duration at its average rate."""
        return float(self.count / self.rate)


@contextmanager
def open_video(path: str, sandbox: Sandbox) -> Iterator[tuple[Any, Any, Any]]:
    """An open container, its first stream of pictures, and what decodes that.

    Raises:
        InputError: it is no video, has no pictures, needs a decoder that is not there, or PyAV is missing.
    """
    av = load_pyav()
    if av is None:
        raise InputError(f"{path}: {HOW_TO_INSTALL}")
    try:
        options = {"format_whitelist": _CONTAINERS, "protocol_whitelist": "file"}
        container = av.open(path, metadata_errors="replace", options=options)
    except (av.FFmpegError, ValueError, UnicodeError) as error:
        raise InputError(f"{path}: {describe_video_fault(error)}") from error
    with container:
        stream = next((candidate for candidate in container.streams.video if not _is_cover(candidate)), None)
        if stream is None or stream.codec_context is None:
            raise InputError(f"{path}: holds no moving pictures that can be decoded")
        yield container, stream, _open_decoder(av, stream)


def demux_packets(container: Any, stream: Any) -> Iterator[Any]:
    """The packets of a stream, without the empty one at the end."""
    return (packet for packet in container.demux(stream) if packet.size)


def decode_frames(container: Any, stream: Any, decoder: Any) -> Iterator[Any]:
    """All following frames, in the order of their presentation."""
    for packet in demux_packets(container, stream):
        yield from decoder.decode(packet)
    yield from decoder.decode(None)


def describe_video_fault(error: Exception) -> str:
    """The complaint of FFmpeg, as the rest of a sentence that starts with the path."""
    message = getattr(error, "strerror", None) or str(error)
    if "nvalid data" in message or "End of file" in message:
        return "is no video, or is cut short or damaged: copy or render it again"
    return f"cannot be read as a video ({message})"


@lru_cache(maxsize=64)  # chosen by judgement: the videos of a few graphs; looking through one takes long
def survey_video(path: str, mark: str, sandbox: Sandbox) -> tuple[VideoInfo, FrameIndex]:
    """Look through a video; the same version of a file, which `mark` tells, is looked through once.

    Raises:
        InputError: it cannot be read, or has no frames.
    """
    av = load_pyav()
    with open_video(path, sandbox=sandbox) as (container, stream, decoder):
        try:
            index = _index_packets(container, stream)
        except av.FFmpegError as error:
            raise InputError(f"{path}: {describe_video_fault(error)}") from error
    with open_video(path, sandbox=sandbox) as (container, stream, decoder):
        try:
            decoded_frames = decode_frames(container, stream, decoder)
            first = list(islice(decoded_frames, _CHECKED_FRAMES))
            if index is None or tuple(frame.pts for frame in first) != index.times[:_CHECKED_FRAMES]:
                index = FrameIndex(len(first) + sum(1 for _ in decoded_frames))
        except (av.FFmpegError, MemoryError) as error:
            raise InputError(f"{path}: {describe_video_fault(error)}") from error
        if not first:
            raise InputError(f"{path}: holds no frame that can be decoded: copy or render it again")
        return _describe_stream(path, container, stream, first[0], index.count), index


def _index_packets(container: Any, stream: Any) -> FrameIndex | None:
    """The index from the packets; None if they cannot be trusted."""
    context = stream.codec_context
    if context.name in _HIDING or (container.format.name in _TIMELESS and not context.codec.intra_only):
        return None
    times: list[int] = []
    places: dict[tuple[int | None, int | None], int] = {}
    keys: list[KeyFrame] = []
    for place, packet in enumerate(demux_packets(container, stream)):
        places[packet.pts, packet.dts] = place
        if packet.pts is None:
            return None
        if packet.is_keyframe and (not keys or packet.pts > keys[-1].time):
            keys.append(KeyFrame(packet.pts, place))
        if not packet.is_discard:
            times.append(packet.pts)
    if not keys or keys[0].place or min(times, default=0) < keys[0].time:
        return None
    if len(set(times)) < len(times) or len(places) <= max(places.values()):
        return None
    return FrameIndex(len(times), tuple(sorted(times)), places, tuple(keys))


def _describe_stream(path: str, container: Any, stream: Any, frame: Any, count: int) -> VideoInfo:
    is_turned = frame.rotation % 180 == 90
    size = (frame.height, frame.width) if is_turned else (frame.width, frame.height)
    rate = stream.average_rate or stream.guessed_rate or _USUAL_RATE
    components = frame.format.components
    return VideoInfo(
        path,
        size,
        count,
        Fraction(rate),
        container.format.name.partition(",")[0],
        stream.codec_context.codec.name,
        frame.format.name,
        max(part.bits for part in components),
        any(part.is_alpha for part in components) or frame.format.has_palette,
        int(frame.colorspace),
        int(frame.color_range),
        int(frame.color_trc),
        int(frame.color_primaries),
        MappingProxyType({_restore_tag_case(name): text for name, text in container.metadata.items()}),
    )


def _restore_tag_case(name: str) -> str:
    """The name of a tag as Halation writes it: Matroska stores names in capitals."""
    return name.lower() if name.startswith("HALATION:") else name


def _open_decoder(av: Any, stream: Any) -> Any:
    """The decoder of the stream, or one with alpha for a VP8 or VP9 stream that has transparency."""
    context = stream.codec_context
    name = _ALPHA_DECODERS.get(context.name, "")
    tags = {key.casefold(): text for key, text in stream.metadata.items()}
    if name and tags.get("alpha_mode") == "1" and name in av.codecs_available:
        return av.CodecContext.create(name, "r")
    context.thread_type = "AUTO"
    return context


def _is_cover(stream: Any) -> bool:
    """True for a still picture that some files carry as a cover."""
    return bool(int(stream.disposition) & _ATTACHED_PICTURE)
