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

from ..errors import RenderError, rebuild_fault
from ..resources.program import module_command
from .packed_arrays import pack_array, unpack_array

if TYPE_CHECKING:
    import numpy as np

    from ..graph import Graph
    from ..inputs.provider import Binding


class ServiceConnection:
    """Sends requests to a warm process of Halation, and waits for the replies; any thread may use it.

    Use it in a `with` block: at its end the connection is closed, and a process that it has started ends.
    """

    def __init__(self, requests: IO[bytes], replies: IO[bytes], close: Callable[[], None]) -> None:
        self._requests, self._replies, self._close = requests, replies, close
        self._lock = threading.Lock()
        self._count = 0

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
        reply = self.ask("render", graph, inputs, values=values, output=packed_files, **options)
        return {name: unpack_array(name, packed) for name, packed in reply.get("pictures", {}).items()}

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
        import numpy as np

        from .. import document

        bindings = {
            name: pack_array(binding.astype(np.float32, copy=False))
            if isinstance(binding, np.ndarray)
            else str(binding)
            if isinstance(binding, Path)
            else binding
            for name, binding in (inputs or {}).items()
        }
        whole = str(graph) if isinstance(graph, str | Path) else json.loads(document.dumps(graph))
        request = {"do": action, "graph": whole, "input": bindings, "set": dict(values or {})}
        return self._exchange({**request, **{name: option for name, option in options.items() if option is not None}})

    def close(self) -> None:
        """End the connection."""
        self._close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _exchange(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Send a request and wait for its reply."""
        with self._lock:
            self._count += 1
            line = json.dumps({"id": self._count, **request}).encode() + b"\n"
            try:
                self._requests.write(line)
                self._requests.flush()
                reply_line = self._replies.readline()
            except (OSError, ValueError):
                reply_line = b""
        if not reply_line:
            raise RenderError("the render server has ended the connection: see what it has printed")
        reply = json.loads(reply_line)
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
