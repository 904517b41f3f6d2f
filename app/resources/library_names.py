"""Names of files for libraries that take only text: file systems allow bytes that are no UTF-8."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def name_for_library(path: str | Path) -> Iterator[str]:
    """A name of the file that is UTF-8: its own, else that of a link in a temporary folder, with the same ending.

    The link is there as long as the context, for libraries that open a file again.
    """
    name = str(path)
    if is_utf8(name):
        yield name
        return
    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        ending = Path(name).suffix
        link = Path(folder, f"file{ending if is_utf8(ending) else ''}")
        link.symlink_to(os.path.abspath(name))  # noqa: PTH100 - a link that is replaced meanwhile stays a link
        yield str(link)


def is_utf8(name: str) -> bool:
    """False for a name that holds bytes of another encoding, which Python keeps as surrogates."""
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True
