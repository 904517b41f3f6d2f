"""Reads requests from a stream or from the clients of a local socket, each on a thread of its own."""

from __future__ import annotations

import contextlib
import os
import socket
import threading
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from ..errors import HalationError, OutputError, UsageError
from ..resources.sandbox import Sandbox
from ..scripting.packed_arrays import write_message
from .request_queue import RequestQueue, ServiceClient
from .service_requests import MAX_LINE_BYTES, describe_failure, find_request_id, parse_request

MAX_CLIENTS = 64
"""Clients of a socket at a time; others wait for a place. A choice: each has a thread."""


def serve_stream(queue: RequestQueue, requests: IO[bytes], replies: IO[bytes]) -> None:
    """Read requests from a stream on another thread, until it ends; then the queue is closed.

    A stream that ends says only that there are no more requests. The client has gone when replies cannot be written.
    """
    client = ServiceClient(make_sender(make_line_writer(replies, lambda: queue.remove_client(client))))

    def read() -> None:
        _read_lines(queue, client, requests)
        queue.close()

    threading.Thread(target=read, name="requests", daemon=True).start()


@contextmanager
def serve_socket(queue: RequestQueue, path: Path, sandbox: Sandbox) -> Generator[None]:
    """Read requests from the clients of a socket at `path`, each on a thread, until the block ends.

    Only the user of this process may connect. A socket that nobody listens to any more is replaced. Raises OutputError.
    """
    if reason := sandbox.find_write_fault(path):
        raise OutputError(f"{path}: {reason}")
    if not hasattr(socket, "AF_UNIX"):
        raise UsageError(f"--socket {path}: this system has no local sockets: use standard input and output")
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as listener:
        _bind_socket(listener, path)
        try:  # from here on the name is that of this socket, and nobody else's
            listener.listen()
            places = threading.BoundedSemaphore(MAX_CLIENTS)
            arguments = (queue, listener, places)
            threading.Thread(target=_accept_clients, args=arguments, name="accept", daemon=True).start()
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
        client = ServiceClient(make_sender(make_line_writer(replies, lambda: queue.remove_client(client))))
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
            refuse_long_line(client)
            return
        if line.strip():
            queue_line(queue, client, line)


def refuse_long_line(client: ServiceClient) -> None:
    """Answer a line that is too long. Nothing after it is read: it may be the rest of it."""
    fault = UsageError(f"the request has more than {MAX_LINE_BYTES // 2**20} MB: name files instead of pixels")
    client.send({"id": None, "error": describe_failure(fault)})


def queue_line(queue: RequestQueue, client: ServiceClient, line: bytes) -> None:
    """Let the request in a line wait for its turn; a line that is no request is answered at once."""
    try:
        request = parse_request(line)
        if request.action != "cancel":
            queue.add_request(client, request)
        elif queue.cancel_request(client, request.request):
            client.send({"id": request.request, "cancelled": True})
    except HalationError as fault:
        client.send({"id": find_request_id(line), "error": describe_failure(fault)})


def make_line_writer(replies: IO[bytes], drop_client: Callable[[], None]) -> Callable[[bytes], None]:
    """A function that writes a line, from any thread; the client has gone where that fails."""
    lock = threading.Lock()

    def write(line: bytes) -> None:
        try:
            with lock:
                replies.write(line)
                replies.flush()
        except (OSError, ValueError):
            drop_client()

    return write


def make_sender(write_line: Callable[[bytes], None]) -> Callable[[Mapping[str, Any]], None]:
    """A function that writes a reply as one line."""

    def send(reply: Mapping[str, Any]) -> None:
        write_line(write_message(reply))

    return send
