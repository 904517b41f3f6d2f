"""Room for nested calls, so that none of them costs a call of the system."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

_WORDS = 1 << 15
"""Pointers of room: 256 KiB, of which only what is used takes memory. A thousand frames fit in; Python ends at that."""


def call_with_room(function: Callable[P, T], /, *arguments: P.args, **options: P.kwargs) -> T:
    """What a function returns that is called with room for all that it calls in turn; its errors pass through.

    Python keeps the frames of calls in pieces of 16 KiB. A loop at the end of one that calls a function takes a new
    piece from the system for each call, and gives it back: importing numpy then costs 3,500 of them, a fifth of the
    time of a short process. A frame that does not fit into a piece is given a piece of twice its size or less, which
    the next frames share. So this frame says that it is large.
    """
    return function(*arguments, **options)


call_with_room.__code__ = call_with_room.__code__.replace(co_stacksize=_WORDS + 1)
