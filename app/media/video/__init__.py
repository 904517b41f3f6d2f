"""Videos: frames by number, exactly, and their color; all frames of a rendering in one file. Needs the extra `video`."""

from .facts import passed_on, said_of
from .index import Facts
from .library import HOW_TO_INSTALL, VIDEO_ENDINGS, is_video, library
from .reading import facts_of, signal_at

__all__ = [
    "HOW_TO_INSTALL", "VIDEO_ENDINGS", "Facts", "facts_of", "is_video", "library", "passed_on", "said_of", "signal_at",
]
