"""The commands. Each imports what it needs when it runs, so that `--help` is instant and no command opens a window."""

from __future__ import annotations

import gc
import os
import sys
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO

_INTERRUPTED = 130
_YOUNG = 100_000
"""Objects made since Python last looked for garbage that make it look again: modules that are being loaded are none."""


def main() -> None:
    """Run the command line, and leave at once: nothing is left to tidy up that the system does not take back.

    Closed streams are replaced, lest the next file to be opened takes their place; names of files may hold bytes
    that no encoding knows. Matrices are small here: numpy's threads for large ones would only spin while they wait.
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
    except KeyboardInterrupt:  # while modules were still being loaded
        code = _INTERRUPTED
    os._exit(code)


def _nowhere() -> TextIO:
    return Path(os.devnull).open("w")
