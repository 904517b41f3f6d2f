"""The codecs of videos: which container holds which codec, and the settings of each.

Every encoder runs on one thread and leaves out dates and random numbers: the same pictures give the same bytes.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from halation.nodes import Size
from msgspec import Struct

from ...errors import UsageError
from ...resources.suggestions import find_near_names
from .library import HOW_TO_INSTALL, load_pyav


class VideoCodec(Struct, frozen=True):
    """An encoder. `pixels` are the pixel formats for 8 bits and for more; `alpha` means that transparency is kept."""

    encoder: str
    pixels: tuple[str, str]
    options: Mapping[str, str]
    alpha: bool = False
    even: bool = False
    """Chroma has half the size, so width and height must be even."""
    tag: str = ""


_LOSSLESS = MappingProxyType({"level": "3", "slicecrc": "1", "slices": "4", "g": "1"})
CODECS: Mapping[str, VideoCodec] = MappingProxyType(
    {
        "h264": VideoCodec(
            "libx264", ("yuv420p", "yuv420p"), MappingProxyType({"crf": "16", "preset": "medium"}), even=True
        ),
        "h265": VideoCodec(
            "libx265",
            ("yuv420p10le", "yuv420p10le"),
            MappingProxyType({"crf": "18", "x265-params": "log-level=none:pools=none:frame-threads=1:info=0"}),
            even=True,
            tag="hvc1",
        ),
        "prores": VideoCodec(
            "prores_ks", ("yuv422p10le", "yuv422p10le"), MappingProxyType({"profile": "3", "vendor": "apl0"})
        ),
        "prores4444": VideoCodec(
            "prores_ks",
            ("yuva444p10le", "yuva444p10le"),
            MappingProxyType({"profile": "4", "vendor": "apl0"}),
            alpha=True,
        ),
        "ffv1": VideoCodec("ffv1", ("bgra", "gbrap16le"), _LOSSLESS, alpha=True),
        "qtrle": VideoCodec("qtrle", ("argb", "argb"), MappingProxyType({}), alpha=True),
        "vp9": VideoCodec(
            "libvpx-vp9",
            ("yuv420p", "yuv420p"),
            MappingProxyType({"crf": "24", "b": "0", "cpu-used": "2"}),
        ),
    }
)
_CODECS_BY_ENDING = MappingProxyType(
    {
        ".mp4": ("h264", "h265"),
        ".m4v": ("h264", "h265"),
        ".mov": ("prores", "prores4444", "h264", "h265", "qtrle"),
        ".mkv": ("ffv1", "h264", "h265", "vp9"),
        ".webm": ("vp9",),
    }
)
"""Ending -> the codecs that such a file holds, the usual one first."""

WRITABLE = tuple(_CODECS_BY_ENDING)


def find_codec(path: str | Path, name: str, size: Size | None = None) -> VideoCodec:
    """The encoder and format of a video; without a codec, the usual one of its ending.

    Raises:
        UsageError: no such codec in such a file, a size that it cannot have, or PyAV is missing.
    """
    av = load_pyav()
    if av is None:
        raise UsageError(f"{path}: {HOW_TO_INSTALL}, or write numbered pictures")
    codecs = _CODECS_BY_ENDING.get(Path(path).suffix.casefold())
    if codecs is None:
        raise UsageError(f"{path}: videos are written as {', '.join(WRITABLE)}: choose one of these endings")
    chosen = name or codecs[0]
    if chosen not in codecs:
        close_names = find_near_names(chosen.casefold(), codecs)
        homes = [ending for ending, codec_names in _CODECS_BY_ENDING.items() if chosen in codec_names]
        hint = f"did you mean '{close_names[0]}'? Choose" if close_names else "choose"
        rest = f", or write to {' or '.join(homes)}" if homes else ""
        raise UsageError(f"{path}: such a file holds no codec '{chosen}': {hint} from {', '.join(codecs)}{rest}")
    codec = CODECS[chosen]
    if codec.encoder not in av.codecs_available:
        raise UsageError(f"{path}: this PyAV has no encoder for {chosen}: choose from {', '.join(codecs)} with --codec")
    if size and codec.even and (size[0] % 2 or size[1] % 2):
        even = f"{size[0] // 2 * 2 or 2}x{size[1] // 2 * 2 or 2}"
        raise UsageError(
            f"{path}: {chosen} keeps color at half the size, so width and height must be even, not "
            f"{size[0]}x{size[1]}: render with --size {even}, or write ffv1 to an .mkv file"
        )
    return codec
