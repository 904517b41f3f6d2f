"""Keeps the requests of all clients, and hands them out in turns."""

from __future__ import annotations

import threading
from collections import OrderedDict, deque
from collections.abc import Callable, Mapping
from typing import Any

from ..errors import UsageError
from .service_requests import ServiceRequest

MAX_WAITING_REQUESTS = 1000
"""Requests of one client that may wait: a choice, more than clients send before they read a reply."""


SIGNAL_INTERVAL = 0.25
"""Seconds of one wait for requests. A signal that arrives just before Python waits for a lock is heard only afterwards:
without a limit a server that is asked to end right after a reply would wait for ever."""


class ServiceClient:
    """Who sends requests. `send` takes a reply; it returns without an error after the client has gone."""

    def __init__(self, send: Callable[[Mapping[str, Any]], None]) -> None:
        self.send = send
        self.is_gone = False
        self.cancelled_ids = set[object]()
        """The ids of requests that the client no longer needs."""


class RequestQueue:
    """Requests by client. Any thread may add some; one thread takes them, one of each client in turns."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._waiting: OrderedDict[ServiceClient, deque[ServiceRequest]] = OrderedDict()
        self._is_closed = False

    def add_request(self, client: ServiceClient, request: ServiceRequest) -> None:
        """Let a request wait for its turn. Raises UsageError if too many of its client wait."""
        with self._changed:
            waiting = self._waiting.setdefault(client, deque())
            if len(waiting) >= MAX_WAITING_REQUESTS:
                raise UsageError(f"{MAX_WAITING_REQUESTS} requests are waiting: read replies before you send more")
            waiting.append(request)
            self._changed.notify()

    def cancel_request(self, client: ServiceClient, request_id: object) -> bool:
        """Forget a request that waits, and end one that is being answered; True if it was waiting."""
        with self._changed:
            waiting = self._waiting.get(client, deque())
            for request in waiting:
                if request.id == request_id:
                    waiting.remove(request)
                    return True
            client.cancelled_ids.add(request_id)
            return False

    def remove_client(self, client: ServiceClient) -> None:
        """Forget the requests of a client that has gone, and end the one that is being answered."""
        with self._changed:
            client.is_gone = True
            self._waiting.pop(client, None)

    def close(self) -> None:
        """Take no more requests: `take_request` returns None when none is left."""
        with self._changed:
            self._is_closed = True
            self._changed.notify()

    def take_request(self) -> tuple[ServiceClient, ServiceRequest] | None:
        """The next request; waits for one. None if the queue is closed and empty."""
        with self._changed:
            while not (turn := self.take_waiting_request()) and not self._is_closed:
                self._changed.wait(SIGNAL_INTERVAL)
            return turn

    def take_waiting_request(self) -> tuple[ServiceClient, ServiceRequest] | None:
        """The next request; None if none waits."""
        with self._changed:
            for client, waiting in self._waiting.items():
                if waiting:
                    self._waiting.move_to_end(client)
                    return client, waiting.popleft()
            return None
