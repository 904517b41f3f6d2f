"""The Python client of `halation serve`."""

from __future__ import annotations

import contextlib
import json
import socket
import subprocess
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING, Any, Self

from ..errors import OutputError, RenderError, rebuild_fault
from ..resources.program import module_command
from .array_file import make_array_file
from .packed_arrays import pack_array, read_pictures, write_message

if TYPE_CHECKING:
    import numpy as np

    from ..graph import Graph
    from ..inputs.provider import Binding


PIPE_BYTES = 1 << 20
"""Bytes that a pipe to a server holds, where the system can: as many as Linux allows to everybody. A picture of 480x270
is 2.8 MB of text, and each time a pipe is full costs a change of processes."""


class ServiceConnection:
    """Sends requests to a warm process of Halation, and waits for the replies; any thread may use it.

    Use it in a `with` block: at its end the connection is closed, and a process that it has started ends.
    """

    def __init__(self, requests: IO[bytes], replies: IO[bytes], close: Callable[[], None]) -> None:
        self._requests, self._replies = requests, replies
        self._lock = threading.RLock()
        self._count = 0
        with contextlib.ExitStack() as stack:
            stack.callback(close)
            self._array_file = stack.enter_context(make_array_file())
            self._closing = stack.pop_all()

    def render(
        self,
        graph: str | Path | Graph,
        inputs: Mapping[str, Binding] | None = None,
        *,
        values: Mapping[str, Any] | None = None,
        output: str | Path | Mapping[str, str | Path] | None = None,
        **options: Any,
    ) -> dict[str, np.ndarray]:
        """Every output by name as [height, width, channels]; nothing if they are written to `output`.

        `options` are `node`, `size`, `scale`, `frame`, `precision` and `view`. Raises HalationError.
        """
        files = output if isinstance(output, Mapping) else {} if output is None else {"": output}
        packed_files = {name: str(path) for name, path in files.items()}
        with self._lock:
            try:
                return self._render(graph, inputs, values, {"output": packed_files, **options})
            except OutputError:
                if files or self._array_file is None:
                    raise
                self._array_file = None  # the server has a --root, or the memory for files is full
                return self._render(graph, inputs, values, options)

    def make_thumbnail(
        self,
        graph: str | Path | Graph,
        inputs: Mapping[str, Binding] | None = None,
        *,
        values: Mapping[str, Any] | None = None,
        width: int = 320,
        **options: Any,
    ) -> bytes:
        """A PNG of the first output, at most `width` pixels wide. Raises HalationError."""
        import base64

        reply = self.ask("thumbnail", graph, inputs, values=values, width=width, **options)
        return base64.b64decode(reply["png"])

    def ask(
        self,
        action: str,
        graph: str | Path | Graph,
        inputs: Mapping[str, Binding] | None = None,
        *,
        values: Mapping[str, Any] | None = None,
        **options: Any,
    ) -> dict[str, Any]:
        """The reply to any request: `action` is render, thumbnail, explain or check. Raises HalationError."""
        return _read_reply(self._exchange(_make_request(action, graph, inputs, values, options)))

    def close(self) -> None:
        """End the connection."""
        self._closing.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _render(
        self,
        graph: str | Path | Graph,
        inputs: Mapping[str, Binding] | None,
        values: Mapping[str, Any] | None,
        options: Mapping[str, Any],
    ) -> dict[str, np.ndarray]:
        """The outputs of a graph, through the file for arrays where there is one."""
        array_file = self._array_file
        if array_file is not None:
            array_file.rewind()
            options = {**options, "array_file": str(array_file.path)}
        pack = pack_array if array_file is None else array_file.pack_array
        line = self._exchange(_make_request("render", graph, inputs, values, options, pack))
        pictures = read_pictures(line, array_file)
        if pictures is None:
            _read_reply(line)  # files are written, or there is an error
        return pictures or {}

    def _exchange(self, request: Mapping[str, Any]) -> bytes:
        """Send a request and wait for the line of its reply. Raises RenderError."""
        with self._lock:
            self._count += 1
            line = write_message({"id": self._count, **request})
            try:
                self._requests.write(line)
                self._requests.flush()
                reply_line = self._replies.readline()
            except (OSError, ValueError):
                reply_line = b""
        if not reply_line:
            raise RenderError("the render server has ended the connection: see what it has printed")
        return reply_line


def _make_request(
    action: str,
    graph: str | Path | Graph,
    inputs: Mapping[str, Binding] | None,
    values: Mapping[str, Any] | None,
    options: Mapping[str, Any],
    pack: Callable[[np.ndarray], dict[str, Any]] = pack_array,
) -> dict[str, Any]:
    """A request without its id; `pack` says what stands for an array."""
    import numpy as np

    from .. import document

    bindings = {
        name: pack(binding.astype(np.float32, copy=False))
        if isinstance(binding, np.ndarray)
        else str(binding)
        if isinstance(binding, Path)
        else binding
        for name, binding in (inputs or {}).items()
    }
    whole = str(graph) if isinstance(graph, str | Path) else json.loads(document.dumps(graph))
    request = {"do": action, "graph": whole, "input": bindings, "set": dict(values or {})}
    return {**request, **{name: option for name, option in options.items() if option is not None}}


def _read_reply(line: bytes) -> dict[str, Any]:
    """The reply in a line. Raises the HalationError that it holds."""
    reply = json.loads(line)
    if error := reply.get("error"):
        raise rebuild_fault(error)
    return reply


def open_connection(path: Path | None) -> ServiceConnection:
    """Connect to the socket of a server; without one, start a server for this connection only. Raises RenderError."""
    if path is not None:
        connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            connection.connect(str(path))
        except OSError as fault:
            connection.close()
            raise RenderError(
                f"{path}: no server listens here ({fault.strerror}): start one with halation serve --socket {path}"
            ) from None
        streams = connection.makefile("wb"), connection.makefile("rb")
        return ServiceConnection(*streams, lambda: _close_all(*streams, connection))
    process = subprocess.Popen(
        [*module_command("halation.cli"), "serve"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        pipesize=PIPE_BYTES,
    )
    assert process.stdin and process.stdout
    pipes = process.stdin, process.stdout

    def close() -> None:
        _close_all(*pipes)
        process.wait()

    return ServiceConnection(*pipes, close)


def _close_all(*streams: IO[bytes] | socket.socket) -> None:
    for stream in streams:
        with contextlib.suppress(OSError):
            stream.close()
