"""The command line. Each command imports what it needs when it runs, so that `--help` is instant and only `edit`
loads a window library.
"""

from __future__ import annotations

import gc
import os
import sys
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO

_INTERRUPTED = 130
_YOUNG = 100_000
"""New objects after which Python collects garbage, instead of 700: importing modules creates many, and none of them
is garbage."""


def main() -> None:
    """Run the command line and end the process at once: the system frees all that it holds.

    A closed standard stream is replaced, because the next opened file would get its number. File names may hold bytes
    that are not valid text, so printing escapes them. Matrices are small here, and the threads that numpy starts for
    large ones would cost time.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(_YOUNG)
    sys.stdout, sys.stderr = sys.stdout or _nowhere(), sys.stderr or _nowhere()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    try:
        from .program import run

        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # while modules are still being imported
        code = _INTERRUPTED
    os._exit(code)


def _nowhere() -> TextIO:
    return Path(os.devnull).open("w")
