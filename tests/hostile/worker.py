"""Runs commands of Halation one after the other in one process: loading modules takes longer than most hostile cases.

Reads one JSON object a line from standard input, `{"folder": ..., "words": [...]}`, runs the command in the folder with
its output in files there, and answers with one line, `{"code": ..., "peak": ...}`: the exit code, and the largest
resident memory so far in bytes. Words that start with `api` render through the Python API instead: code 0, the exit
code of a HalationError, or 70 for anything else that is raised. Whoever asks notices when the process dies.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import traceback
from pathlib import Path

BUG = 70
ADDRESS_SPACE = 12 << 30
"""Bytes: far above what a case may take, so that a runaway ends with an error and not with the machine."""


def run_api(graph: str) -> int:
    """Load and render a graph as a Python program would."""
    import halation as hal

    try:
        hal.render(hal.load(graph), size=(24, 16))
    except hal.HalationError as fault:
        print(fault, file=sys.stderr)
        return fault.exit_code
    except Exception:
        traceback.print_exc()
        return BUG
    return 0


def run_case(folder: str, words: list[str]) -> int:
    """The exit code of one command; what it prints is in `stdout.txt` and `stderr.txt` of the folder."""
    from halation.cli.program import run

    os.chdir(folder)
    saved = os.dup(1), os.dup(2)
    for number, name in ((1, "stdout.txt"), (2, "stderr.txt")):
        handle = os.open(Path(folder, name), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(handle, number)
        os.close(handle)
    try:
        return run_api(words[1]) if words[0] == "api" else run(words)
    except BaseException:
        traceback.print_exc()
        return BUG
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        for number, handle in zip((1, 2), saved, strict=True):
            os.dup2(handle, number)
            os.close(handle)


def main() -> None:
    """Serve until standard input ends."""
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for line in sys.stdin:
        case = json.loads(line)
        code = run_case(case["folder"], case["words"])
        peak = 1024 * max(
            resource.getrusage(whose).ru_maxrss for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        )
        print(json.dumps({"code": code, "peak": peak}), flush=True)


if __name__ == "__main__":
    main()
