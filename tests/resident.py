"""How much of this process is in memory."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

STATUS = Path("/proc/self/status")
needs_proc = pytest.mark.skipif(not STATUS.exists(), reason="this system has no /proc")


def count_resident() -> int:
    """Bytes of this process that are in memory, without files."""
    found = re.search(r"^RssAnon:\s*(\d+) kB", STATUS.read_text("ascii"), re.MULTILINE)
    assert found
    return int(found[1]) * 1024
