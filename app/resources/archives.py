"""What can be wrong with a zip file: `zipfile` lets the faults of its libraries through."""

from __future__ import annotations

import zlib
from lzma import LZMAError
from zipfile import BadZipFile

DAMAGED_ARCHIVE = (BadZipFile, EOFError, LZMAError, NotImplementedError, OSError, RuntimeError, ValueError, zlib.error)
"""Exceptions of a damaged, encrypted or unknown archive: bz2 raises OSError, names that are no UTF-8 a ValueError."""
