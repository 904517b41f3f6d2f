"""A file in which a render server and its client leave each other arrays, as they lie in memory.

As text in the reply, 2 MB of pixels are written, go through two pipes and are read again, which takes longer than to
render them. The client makes the file, in memory where the system has a folder for that, and names it in its requests.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from ..errors import OutputError
from ..resources.atomic_write import describe_write_error
from ..resources.input_files import find_special_kind
from ..resources.sandbox import Sandbox, make_path_printable

if TYPE_CHECKING:
    import numpy as np

_MEMORY_FOLDER = Path("/dev/shm")
"""Files in this folder of Linux are memory; elsewhere the system keeps a file that is in use in memory, mostly."""

_OPEN_FLAGS = os.O_RDWR | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)


class ArrayFile:
    """An open file with arrays of floats, one after the other."""

    def __init__(self, path: Path, file: IO[bytes]) -> None:
        self.path, self._file = path, file
        self._end = 0

    def rewind(self) -> None:
        """Write the next array over the first one."""
        self._end = 0

    def pack_array(self, array: np.ndarray) -> dict[str, Any]:
        """Write an array after those before it: what a message says of it. Raises OutputError."""
        import numpy as np

        contiguous = np.ascontiguousarray(array)
        offset, self._end = self._end, self._end + contiguous.nbytes
        try:
            self._file.seek(offset)
            contiguous.tofile(self._file)
        except OSError as fault:
            raise OutputError(f"{self.path}: {describe_write_error(fault)}") from None
        return {"shape": list(contiguous.shape), "type": contiguous.dtype.name, "offset": offset}

    def read_array(self, type: str, shape: Sequence[int], offset: int) -> np.ndarray:
        """A copy of the array at an offset. Raises ValueError where the file does not hold it."""
        import numpy as np

        dtype = np.dtype(type)
        count = int(np.prod(shape, dtype=object))
        size = os.fstat(self._file.fileno()).st_size
        if min(offset, *shape, 0) < 0 or offset + count * dtype.itemsize > size:
            raise ValueError(f"{self.path} has {size} bytes")
        self._file.seek(offset)
        return np.fromfile(self._file, dtype, count).reshape(shape)


@contextmanager
def open_array_file(path: str, sandbox: Sandbox) -> Generator[ArrayFile]:
    """Open the file that a client has made, to read and to overwrite arrays. Raises OutputError."""
    if reason := sandbox.find_write_fault(path):
        raise OutputError(f"{make_path_printable(path)}: {reason}")
    try:
        kind = find_special_kind(Path(path).stat().st_mode)
        descriptor = -1 if kind else os.open(path, _OPEN_FLAGS)
    except FileNotFoundError:
        raise OutputError(f"{path}: there is no such file: make the array_file before it is named") from None
    except (OSError, ValueError) as fault:
        raise OutputError(f"{make_path_printable(path)}: {describe_write_error(fault)}") from None
    if kind:
        raise OutputError(f"{path}: is {kind}, not a file for pixels")
    with os.fdopen(descriptor, "r+b", buffering=0) as file:
        yield ArrayFile(Path(path), file)


@contextmanager
def make_array_file() -> Generator[ArrayFile | None]:
    """A file that only this user can open, and that is removed at the end; None where none can be made."""
    folder = _MEMORY_FOLDER if os.access(_MEMORY_FOLDER, os.W_OK) else None
    with contextlib.ExitStack() as stack:
        array_file = None
        with contextlib.suppress(OSError):
            name = stack.enter_context(tempfile.TemporaryDirectory(prefix="halation-", dir=folder))
            path = Path(name, "pixels")
            array_file = ArrayFile(path, stack.enter_context(path.open("x+b", buffering=0)))
        yield array_file
