"""PyAV, the library that reads and writes videos. It is an extra, so it may be missing."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

VIDEO_ENDINGS = frozenset({
    ".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi", ".mxf", ".mpg", ".mpeg", ".m2v", ".ts", ".mts", ".m2ts", ".wmv",
    ".flv", ".ogv", ".3gp", ".y4m", ".dv",
})
"""Endings of names of videos."""

HOW_TO_INSTALL = "videos need PyAV: pip install halation[video]"


def is_video(path: str | Path) -> bool:
    """True for the name of a video."""
    return Path(path).suffix.casefold() in VIDEO_ENDINGS


@cache
def library() -> Any:
    """PyAV, or None where it is not installed."""
    try:
        import av
    except ImportError:
        return None
    return av  # it keeps quiet by itself; its levels of logging would have the decoder's threads wait for us
