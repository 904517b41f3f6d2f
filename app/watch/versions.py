"""Versions of files, looked up about once a second."""

from __future__ import annotations

from pathlib import Path
from time import monotonic

from ..errors import HalationError
from ..resources.input_files import fingerprint
from ..resources.sandbox import Sandbox

LOOK_AGAIN = 1.0
"""Seconds after which a file is looked at again, if nothing has told of a change. Chosen by judgement."""


class FileVersions:
    """The versions of files: texts that change when the file does."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox = sandbox
        self._known: dict[str, tuple[float, str, str]] = {}

    def of(self, path: Path) -> tuple[str, str]:
        """The version, which changes when the file does, and why there is no such file, or ""."""
        time_now = monotonic()
        at, version, fault = self._known.get(str(path), (-LOOK_AGAIN, "", ""))
        if time_now - at >= LOOK_AGAIN:
            try:
                version, fault = fingerprint(path, sandbox=self._sandbox), ""
            except HalationError as error:
                version, fault = "", str(error)
            self._known[str(path)] = (time_now, version, fault)
        return version, fault
