"""Describes a video in words."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .index import VideoInfo
from .signals import RGB, choose_matrix

_MATRICES = {0: "RGB", 1: "BT.709", 4: "FCC", 5: "BT.601", 6: "BT.601", 7: "SMPTE 240M", 8: "YCgCo", 9: "BT.2020"}
_TRANSFERS = {
    1: "BT.709",
    4: "gamma 2.2",
    5: "gamma 2.8",
    6: "BT.601",
    8: "linear",
    13: "sRGB",
    14: "BT.2020",
    15: "BT.2020",
    16: "PQ",
    18: "HLG",
}
_PRIMARIES = {1: "BT.709", 5: "BT.601, 625 lines", 6: "BT.601, 525 lines", 9: "BT.2020", 11: "DCI P3", 12: "Display P3"}
_STORAGE_TAGS = frozenset(
    {
        "major_brand",
        "minor_version",
        "compatible_brands",
        "encoder",
        "duration",
        "creation_time",
    }
)
"""Tags about how a file is stored."""


def describe_video_attributes(facts: VideoInfo) -> Mapping[str, int | float | str]:
    """All facts, by names that begin with `video:`."""
    matrix = choose_matrix(facts.matrix, facts.size)
    luma = facts.pixels.startswith(("yuv", "nv", "p0", "p2", "p4", "uyvy", "y2"))
    full = facts.range == 2 or facts.pixels.startswith("yuvj") or not luma
    note = "" if matrix == facts.matrix else " (not said)"
    return MappingProxyType(
        {
            "video:frames": facts.count,
            "video:rate": float(facts.rate),
            "video:seconds": round(facts.seconds, 6),
            "video:codec": facts.codec,
            "video:pixels": facts.pixels,
            "video:matrix": _MATRICES.get(matrix, str(matrix)) + note if luma else _MATRICES[RGB],
            "video:range": "full" if full else "limited",
            "video:transfer": _TRANSFERS.get(
                facts.transfer, "sRGB (not said)" if facts.transfer in (0, 2) else "unknown"
            ),
            "video:primaries": _PRIMARIES.get(facts.primaries, "BT.709 (not said)"),
        }
    )


def find_kept_tags(facts: VideoInfo) -> Mapping[str, str]:
    """The tags that also apply to pictures made from the video."""
    return MappingProxyType({name: text for name, text in facts.tags.items() if name.casefold() not in _STORAGE_TAGS})
