"""Writes a large picture by rows, from the top down."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from halation.nodes import Kind, Size

from ...color.encoding import Encoding
from ...color.transforms import Array
from ...resources.atomic_write import replace_file
from ...resources.library_names import name_for_library
from ...resources.sandbox import Sandbox
from ..metadata import add_metadata
from .writer import Precision, encode_exr_parts, encoder_error, open_encoder

_BLOCK = 2**16
"""Bytes that must be free on the disk. Chosen by judgement."""


class ScanlineWriter:
    """An EXR of one layer of `size` and `kind`, equal to one that `write` makes of all rows.

    The file appears when it is closed. Raises OutputError.
    """

    def __init__(
        self,
        path: Path,
        size: Size,
        name: str,
        kind: Kind,
        *,
        precision: Precision,
        compression: str,
        encoding: Encoding,
        metadata: Mapping[str, Any],
        sandbox: Sandbox,
    ) -> None:
        self._path, self._size, self._name, self._kind, self._metadata = path, size, name, kind, metadata
        self._precision: Precision = precision
        self._compression, self._encoding = compression, encoding
        self._output = open_encoder(path, "openexr")
        self._row = 0
        self._open = ExitStack()
        self._replacement = self._open.enter_context(replace_file(path, sandbox=sandbox))

    def add(self, rows: Array) -> None:
        """Write the next rows: [rows, width, channels]."""
        layers, kinds = {self._name: rows}, {self._name: self._kind}
        (part,) = encode_exr_parts(layers, kinds, self._precision, self._compression, self._encoding)
        if not self._row:
            part.spec.height = part.spec.full_height = self._size[1]
            add_metadata(part.spec, self._metadata, "openexr")
            name = self._open.enter_context(name_for_library(self._replacement.temporary))
            self._check_encoded(self._output.open(name, part.spec))
            self._open.callback(self._output.close)
        end = self._row + len(rows)
        self._check_encoded(self._output.write_scanlines(self._row, end, 0, part.array))
        self._row = end

    def close(self) -> None:
        """Finish the file and give it its name."""
        try:
            assert self._row == self._size[1], f"{self._size[1] - self._row} rows are missing"
            self._check_encoded(self._output.close())
            self._replacement.commit()
        except OSError as error:
            raise self._replacement.explain(error) from error
        finally:
            self.abort()

    def abort(self) -> None:
        """Remove the unfinished file, unless it was closed."""
        self._open.close()

    def _check_encoded(self, succeeded: bool) -> None:
        if succeeded:
            return
        message = self._output.geterror()
        try:
            with self._replacement.temporary.open("ab") as file:  # the system knows the reason, the encoder does not
                file.write(bytes(_BLOCK))
        except OSError as error:
            raise self._replacement.explain(error) from error
        raise encoder_error(self._path, message)
