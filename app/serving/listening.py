"""Reads requests from a stream or from the clients of a local socket, each on a thread of its own."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import threading
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from ..errors import HalationError, OutputError, UsageError
from ..resources.sandbox import Sandbox
from .request_queue import RequestQueue, ServiceClient
from .service_requests import MAX_LINE_BYTES, describe_failure, find_request_id, parse_request

MAX_CLIENTS = 64
"""Clients of a socket at a time; others wait for a place. A choice: each has a thread."""


def serve_stream(queue: RequestQueue, requests: IO[bytes], replies: IO[bytes]) -> None:
    """Read requests from a stream on another thread, until it ends; then the queue is closed.

    A stream that ends says only that there are no more requests. The client has gone when replies cannot be written.
    """
    client = ServiceClient(_make_sender(replies, lambda: queue.remove_client(client)))

    def read() -> None:
        _read_lines(queue, client, requests)
        queue.close()

    threading.Thread(target=read, name="requests", daemon=True).start()


@contextmanager
def serve_socket(queue: RequestQueue, path: Path, sandbox: Sandbox) -> Generator[None]:
    """Read requests from the clients of a socket at `path`, each on a thread, until the block ends.

    Only the user of this process may connect. A socket that nobody listens to any more is replaced. Raises OutputError.
    """
    if reason := sandbox.fault(path):
        raise OutputError(f"{path}: {reason}")
    if not hasattr(socket, "AF_UNIX"):
        raise UsageError(f"--socket {path}: this system has no local sockets: use standard input and output")
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        _bind_socket(listener, path)
        listener.listen()
        places = threading.BoundedSemaphore(MAX_CLIENTS)
        accept = threading.Thread(target=_accept_clients, args=(queue, listener, places), name="accept", daemon=True)
        accept.start()
        yield
    finally:
        listener.close()
        with contextlib.suppress(OSError):
            path.unlink()


def _bind_socket(listener: socket.socket, path: Path) -> None:
    """Give a socket its name. Raises OutputError, also where another process listens there."""
    if path.is_socket():
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
            if probe.connect_ex(str(path)) == 0:
                raise OutputError(f"{path}: another process listens here: stop it, or choose another --socket")
        path.unlink()
    mask = os.umask(0o177)
    try:
        listener.bind(str(path))
    except OSError as fault:
        raise OutputError(f"{path}: the socket cannot be created ({fault.strerror or fault})") from None
    finally:
        os.umask(mask)


def _accept_clients(queue: RequestQueue, listener: socket.socket, places: threading.BoundedSemaphore) -> None:
    """Start a thread for every client that connects, until the socket is closed."""
    while True:
        places.acquire()
        try:
            connection = listener.accept()[0]
        except OSError:
            return
        threading.Thread(target=_serve_client, args=(queue, connection, places), name="client", daemon=True).start()


def _serve_client(queue: RequestQueue, connection: socket.socket, places: threading.BoundedSemaphore) -> None:
    """Read the requests of one client until it goes away, which ends its work."""
    with connection, connection.makefile("rb") as requests, connection.makefile("wb") as replies:
        client = ServiceClient(_make_sender(replies, lambda: queue.remove_client(client)))
        _read_lines(queue, client, requests)
        queue.remove_client(client)
    places.release()


def _read_lines(queue: RequestQueue, client: ServiceClient, requests: IO[bytes]) -> None:
    """Queue the requests of a client until its stream ends, or has a line that is too long."""
    while not client.is_gone:
        try:
            line = requests.readline(MAX_LINE_BYTES + 1)
        except (OSError, ValueError):
            return
        if not line:
            return
        if len(line) > MAX_LINE_BYTES:
            fault = UsageError(f"the request has more than {MAX_LINE_BYTES // 2**20} MB: name files instead of pixels")
            client.send({"id": None, "error": describe_failure(fault)})
            return
        if line.strip():
            _queue_line(queue, client, line)


def _queue_line(queue: RequestQueue, client: ServiceClient, line: bytes) -> None:
    """Let the request in a line wait for its turn; a line that is no request is answered at once."""
    try:
        request = parse_request(line)
        if request.action != "cancel":
            queue.add_request(client, request)
        elif queue.cancel_request(client, request.request):
            client.send({"id": request.request, "cancelled": True})
    except HalationError as fault:
        client.send({"id": find_request_id(line), "error": describe_failure(fault)})


def _make_sender(replies: IO[bytes], drop_client: Callable[[], None]) -> Callable[[Mapping[str, Any]], None]:
    """A function that writes a reply as one line, from any thread; the client has gone where that fails."""
    lock = threading.Lock()

    def send(reply: Mapping[str, Any]) -> None:
        line = json.dumps(reply, ensure_ascii=False).encode("utf-8", "surrogateescape") + b"\n"
        try:
            with lock:
                replies.write(line)
                replies.flush()
        except (OSError, ValueError):
            drop_client()

    return send
