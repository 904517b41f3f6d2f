"""The garbage collector of Python, which visits all objects now and then to find those that hold each other."""

from __future__ import annotations

import gc
from collections.abc import Generator
from contextlib import contextmanager


@contextmanager
def pause_collection() -> Generator[None]:
    """Stop the garbage collector inside, for work that makes many objects which live on: it would visit them all."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def keep_for_ever() -> None:
    """Tell the garbage collector that everything that is there now stays until the process ends.

    It would visit all of it when it is next let work: 45 ms for the modules of the editor.
    For a program that has just loaded: what it drops later and what holds itself is then never freed.
    """
    gc.freeze()
