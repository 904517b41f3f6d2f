"""Requests of several clients are answered in turns."""

from __future__ import annotations

import threading
import time

import pytest
from halation.errors import UsageError
from halation.serving import request_queue
from halation.serving.request_queue import RequestQueue, ServiceClient
from halation.serving.service_requests import ServiceRequest


def client() -> ServiceClient:
    return ServiceClient(lambda reply: None)


def request(number: int) -> ServiceRequest:
    return ServiceRequest(action="check", id=number)


def taken(queue: RequestQueue) -> list[tuple[ServiceClient, object]]:
    queue.close()
    turns: list[tuple[ServiceClient, object]] = []
    while (turn := queue.take_request()) is not None:
        turns.append((turn[0], turn[1].id))
    return turns


def test_clients_take_turns():
    queue, busy, late, other = RequestQueue(), client(), client(), client()
    for number in range(5):
        queue.add_request(busy, request(number))
    assert queue.take_request() == (busy, request(0))
    queue.add_request(late, request(10))
    for number in (20, 21):
        queue.add_request(other, request(number))
    turns = [(who, number) for who, number in taken(queue)]
    # whoever has waited longest is next; nobody is delayed by more than one request of each other client
    assert turns.index((late, 10)) <= 2 and turns.index((other, 21)) <= 4
    assert [number for who, number in turns if who is busy] == [1, 2, 3, 4]


def test_a_client_that_goes_away_leaves_nothing():
    queue, one, two = RequestQueue(), client(), client()
    queue.add_request(one, request(1))
    queue.add_request(two, request(2))
    queue.remove_client(one)
    assert one.is_gone and taken(queue) == [(two, 2)]


def test_cancelling_is_for_requests_of_the_same_client():
    queue, one, two = RequestQueue(), client(), client()
    queue.add_request(one, request(1))
    assert not queue.cancel_request(two, 1) and queue.cancel_request(one, 1)
    assert taken(queue) == []


def test_too_many_requests_are_refused(monkeypatch):
    monkeypatch.setattr(request_queue, "MAX_WAITING_REQUESTS", 2)
    queue, one, two = RequestQueue(), client(), client()
    for number in range(2):
        queue.add_request(one, request(number))
    with pytest.raises(UsageError, match="2 requests are waiting"):
        queue.add_request(one, request(3))
    queue.add_request(two, request(4))


@pytest.mark.parametrize("comes", ["request", "end"])
def test_waiting_ends_at_once_with_a_request_or_with_the_queue(monkeypatch, comes):
    """Nobody waits until the queue looks by itself, which it does for the sake of signals."""
    monkeypatch.setattr(request_queue, "SIGNAL_INTERVAL", 60.0)
    queue, one = RequestQueue(), client()
    turns: list[object] = []
    thread = threading.Thread(target=lambda: turns.append(queue.take_request()), daemon=True)
    thread.start()
    end = time.monotonic() + 30.0
    while not queue._changed._waiters and time.monotonic() < end:  # pyright: ignore[reportAttributeAccessIssue]
        time.sleep(0.001)
    if comes == "request":
        queue.add_request(one, request(1))
    else:
        queue.close()
    thread.join(10)
    assert turns == [(one, request(1)) if comes == "request" else None]


def test_what_waits_is_handed_out_before_the_end():
    queue, one = RequestQueue(), client()
    queue.add_request(one, request(1))
    queue.close()
    assert [queue.take_request(), queue.take_request()] == [(one, request(1)), None]
