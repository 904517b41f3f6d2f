"""Programs that are started, waited for and measured. Standard library alone: see `tasks`."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class FinishedProcess:
    """How a process and those that it waited for ended: seconds, seconds of all processors, peak memory of the largest.

    `memory` is in MiB.
    """

    wall: float
    cpu: float
    memory: float
    code: int
    output: str

    @property
    def result(self) -> dict[str, Any]:
        """The JSON object on its last line that holds one; empty without one."""
        for line in reversed(self.output.splitlines()):
            if line.startswith("{"):
                return json.loads(line)
        return {}


WARM = {"PYTHONDONTWRITEBYTECODE": ""}
"""Programs in Python keep the bytecode that their first run made, as installed ones have it."""


def run_process(
    command: Sequence[str], environment: Mapping[str, str] | None = None, patience: float = 600.0
) -> FinishedProcess:
    """Start a program, wait for its end and say what it took; after `patience` seconds it is ended."""
    with tempfile.TemporaryFile() as out:
        started = time.perf_counter()
        process = subprocess.Popen(
            command,
            env={**os.environ, **WARM, **(environment or {})},
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        timer = threading.Timer(patience, os.killpg, (process.pid, signal.SIGKILL))
        timer.daemon = True
        timer.start()
        _, status, used = os.wait4(process.pid, 0)
        wall = time.perf_counter() - started
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        output = out.read().decode(errors="replace")
    return FinishedProcess(wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0, process.returncode, output)
