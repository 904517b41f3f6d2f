"""The command line. Each command imports what it needs when it runs, so that `--help` is instant and only `edit`
loads a window library.
"""

from __future__ import annotations

import gc
import os
import sys
from io import TextIOWrapper
from typing import Literal, TextIO

from ..resources.call_room import call_with_room
from ..resources.machine import has_memory_limit
from .signals import raise_on_requests

_INTERRUPTED = 130
_YOUNG = 100_000
"""New objects after which Python collects garbage, instead of 700: importing modules creates many, and none of them
is garbage."""


def main() -> None:
    """Run the command line and end the process at once: the system frees all that it holds.

    File names may hold bytes that are not valid text, so printing escapes them. Matrices are small here, and the
    threads that numpy starts for large ones would cost time. Each thread takes address space, and libraries wait for
    ever where a limit (`ulimit -v`) leaves none for theirs.
    """
    try:
        raise_on_requests()
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        if has_memory_limit():
            os.environ.setdefault("OPENIMAGEIO_THREADS", "1")
        gc.set_threshold(_YOUNG)
        _replace_closed_streams()
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, TextIOWrapper):
                stream.reconfigure(errors="backslashreplace")
        code = _run(sys.argv[1:])
    except KeyboardInterrupt:  # while modules are still being imported
        code = _INTERRUPTED
    os._exit(code)


def _run(arguments: list[str]) -> int:
    from .head_start import begin_early

    if (code := begin_early(arguments)) is not None:
        return code
    from .program import run_process

    return call_with_room(run_process, arguments)


def _replace_closed_streams() -> None:
    """Give closed standard streams a descriptor, because the next opened file would get its number.

    Nothing can be written to that of standard output, so a command that prints fails instead of losing its results.
    """
    for descriptor, mode in enumerate((os.O_RDONLY, os.O_RDONLY, os.O_WRONLY)):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, mode)  # the smallest number that is free, which is this one
    sys.stdin = sys.stdin or _open_stream(0, "r")
    sys.stdout, sys.stderr = sys.stdout or _open_stream(1, "w"), sys.stderr or _open_stream(2, "w")


def _open_stream(descriptor: int, mode: Literal["r", "w"]) -> TextIO:
    return open(descriptor, mode, encoding="utf-8", closefd=False)
