"""Frames of videos by number, exactly, and their color; what a video can be written as. Needs the extra `video`."""

from .facts import passed_on, said_of
from .index import Facts
from .reading import facts_of, signal_at

__all__ = ["Facts", "facts_of", "passed_on", "said_of", "signal_at"]
