"""PyAV, the library that reads and writes videos. It is an extra, so it may be missing."""

from __future__ import annotations

from functools import cache
from typing import Any

HOW_TO_INSTALL = "videos need PyAV: pip install halation[video]"


@cache
def load_pyav() -> Any:
    """PyAV, or None where it is not installed."""
    try:
        import av
    except ImportError:
        return None
    return av  # it is quiet by default; its log levels would make decoder threads wait for Python
