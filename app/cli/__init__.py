"""The commands. Each imports what it needs when it runs, so that `--help` is instant and no command opens a window."""

from __future__ import annotations

import os
import sys
from io import TextIOWrapper

_INTERRUPTED = 130


def main() -> None:
    """Run the command line, and leave at once: nothing is left to tidy up that the system does not take back."""
    # Where they are closed, the next files to be opened would take their places.
    sys.stdout, sys.stderr = (stream or open(os.devnull, "w") for stream in (sys.stdout, sys.stderr))  # noqa: PTH123
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names of files may hold bytes that no encoding knows
    try:
        from .program import run

        code = run(sys.argv[1:])
    except KeyboardInterrupt:  # while modules were still being loaded
        code = _INTERRUPTED
    os._exit(code)
