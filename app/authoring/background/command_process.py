"""A command of Halation that runs in a process of its own while the window stays fast; a crash there does no harm."""

from __future__ import annotations

import contextlib
import json
import subprocess
import threading
from collections.abc import Callable, Sequence
from typing import Any

from msgspec import Struct

from ...language.translation import translate
from ...resources.program import module_command


class CommandEnd(Struct, frozen=True):
    """How a command ended: its exit code, and what it printed."""

    code: int
    output: str
    errors: str

    @property
    def fault(self) -> str:
        """Why it was refused, in the words of the command; "" if it did its work."""
        if not self.code:
            return ""
        lines = self.errors.strip().splitlines() or [translate("it gave no reason")]
        error = self.report.get("error")
        return str(error["message"]) if error else lines[-1].removeprefix("halation: ")

    @property
    def report(self) -> dict[str, Any]:
        """What `--json` printed, or the last of its lines; empty if a signal came before."""
        for text in (self.output, self.output.strip().rpartition("\n")[2]):
            with contextlib.suppress(ValueError):
                return dict(json.loads(text))
        return {}


class CommandProcess:
    """Runs `halation WORDS`. Lines and the end are told in a thread of its own."""

    def __init__(
        self,
        words: Sequence[str],
        on_end: Callable[[CommandEnd], None],
        on_line: Callable[[str], None] = lambda line: None,
    ) -> None:
        self._words = [*module_command("halation.cli"), *words]
        self._on_line, self._on_end = on_line, on_end
        self._process: subprocess.Popen[str] | None = None
        self._stopped, self._ended = False, threading.Event()
        threading.Thread(target=self._run, name=f"halation {words[0]}", daemon=True).start()

    def stop(self) -> None:
        """Ask the process to end, which leaves no unfinished file."""
        self._stopped = True
        if self._process is not None:
            with contextlib.suppress(OSError):
                self._process.terminate()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until it has ended, at most so long; False if it still runs."""
        return self._ended.wait(seconds)

    def _run(self) -> None:
        pipe = subprocess.PIPE
        try:
            with subprocess.Popen(
                self._words, stdin=subprocess.DEVNULL, stdout=pipe, stderr=pipe, encoding="utf-8", errors="replace"
            ) as process:
                self._process = process
                if self._stopped:  # before there was a process
                    process.terminate()
                self._on_end(self._follow(process))
        except OSError as fault:
            self._on_end(CommandEnd(1, "", translate("the command cannot be started: {reason}", reason=fault.strerror)))
        self._ended.set()

    def _follow(self, process: subprocess.Popen[str]) -> CommandEnd:
        """Read both streams at once: a process waits where nobody reads one of them."""
        assert process.stdout is not None and process.stderr is not None
        errors: list[str] = []
        reader = threading.Thread(target=lambda: errors.extend(process.stderr or ()), daemon=True)
        reader.start()
        lines: list[str] = []
        for line in process.stdout:
            lines.append(line)
            self._on_line(line)
        reader.join()
        return CommandEnd(process.wait(), "".join(lines), "".join(errors))
