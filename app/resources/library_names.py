"""Names of files for libraries that take only text: file systems allow bytes that are no UTF-8."""

from __future__ import annotations

import os
import re
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

_ESCAPED = re.compile(r"\\u(dc[89a-f][0-9a-f])")


@contextmanager
def name_for_library(path: str | Path) -> Generator[str]:
    """A name of the file that is UTF-8: its own, else that of a link in a temporary folder, with the same ending.

    The link is there as long as the context, for libraries that open a file again.
    """
    name = str(path)
    if is_utf8(name):
        yield name
        return
    import tempfile  # such names are rare

    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        ending = Path(name).suffix
        link = Path(folder, f"file{ending if is_utf8(ending) else ''}")
        link.symlink_to(os.path.abspath(name))  # noqa: PTH100 - a link that is replaced meanwhile stays a link
        yield str(link)


def escape_bytes(text: str) -> str:
    """A text as UTF-8 can hold it: bytes of names of files that are no UTF-8 become `\\udcff`, as in JSON."""
    return text.encode("utf-8", "backslashreplace").decode()


def restore_bytes(text: str) -> str:
    """The name of a file that `escape_bytes` has changed."""
    return _ESCAPED.sub(lambda match: chr(int(match[1], 16)), text)


def is_utf8(name: str) -> bool:
    """False for a name that holds bytes of another encoding, which Python keeps as surrogates."""
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True
