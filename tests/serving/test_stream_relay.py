"""Requests of a stream are handed to another process one at a time: here the test is that process."""

from __future__ import annotations

import contextlib
import io
import json
import os
from collections.abc import Iterator
from typing import Any

import pytest
from halation.errors import RenderError
from halation.serving import stream_relay
from halation.serving.stream_relay import StreamRelay

if not hasattr(os, "fork"):
    pytest.skip("POSIX: pipes do not wait there", allow_module_level=True)


class Stand:
    """A relay with the ends of its pipes: `write` is the client, `hear` and `say` are the process that answers."""

    def __init__(self) -> None:
        self.requests, self._client = os.pipe()
        self.handle, self._life = os.pipe()
        self.replies = io.BytesIO()
        self.relay: Any = StreamRelay(self.requests, self.replies)

    def write(self, *requests: object) -> None:
        for request in requests:
            os.write(self._client, request if isinstance(request, bytes) else json.dumps(request).encode() + b"\n")

    def end_requests(self) -> None:
        os.close(self._client)

    def end_process(self) -> None:
        os.close(self._life)

    def turn(self, count: int = 1) -> list[bool]:
        return [self.relay.wait(self.handle, 0.0) for _ in range(count)]

    def hear(self) -> list[Any]:
        """What the process reads: lines, or None at the end."""
        end = self.relay._requests.other
        os.set_blocking(end, False)
        try:
            text = os.read(end, 1 << 24)
        except BlockingIOError:
            return []
        return [json.loads(line) for line in text.splitlines()] if text else [None]

    def say(self, text: bytes) -> None:
        os.write(self.relay._replies.other, text)

    def answers(self) -> list[Any]:
        """What the client has got since it was asked last."""
        text = self.replies.getvalue()
        self.replies.seek(0)
        self.replies.truncate()
        return [json.loads(line) for line in text.splitlines()]


@pytest.fixture
def stand() -> Iterator[Stand]:
    stand = Stand()
    with stand.relay.open_pipes():
        yield stand


def ask(number: int, **more: object) -> dict[str, object]:
    return {"do": "check", "id": number, **more}


def test_a_request_is_handed_over_when_the_one_before_is_answered(stand: Stand) -> None:
    stand.write(ask(1), ask(2), b"\n", ask(3))
    assert stand.turn(4) == [False] * 4
    assert [request["id"] for request in stand.hear()] == [1]
    stand.say(b'{"id": 1, "pro')
    stand.turn()
    assert stand.hear() == stand.answers() == [], "half a line is no answer"
    stand.say(b'blems": []}\n')
    stand.turn(2)
    assert stand.answers() == [{"id": 1, "problems": []}] and [request["id"] for request in stand.hear()] == [2]


def test_a_line_that_comes_in_pieces_is_one_request(stand: Stand) -> None:
    line = json.dumps(ask(7, graph="a" * 5000)).encode()
    for start in range(0, len(line), 1000):
        stand.write(line[start : start + 1000])
        stand.turn()
        assert stand.hear() == []
    stand.write(b"\n")
    stand.turn(2)
    assert [(each["id"], each["graph"]) for each in stand.hear()] == [(7, "a" * 5000)]


def test_the_end_is_passed_on_after_the_last_answer(stand: Stand) -> None:
    stand.write(json.dumps(ask(1)).encode())  # without the end of a line
    stand.end_requests()
    stand.turn(3)
    assert [request["id"] for request in stand.hear()] == [1] and stand.hear() == []
    stand.say(b"{}\n")
    stand.turn(2)
    assert stand.hear() == [None] and stand.answers() == [{}]


def test_all_that_a_process_has_written_before_its_end_is_passed_on(stand: Stand, monkeypatch) -> None:
    monkeypatch.setattr(stream_relay, "_CHUNK", 4)
    stand.write(ask(1))
    stand.turn(30)
    assert len(stand.hear()) == 1
    stand.say(b'{"id": 1, "a": "long one"}\n{"b": 2}\n')
    stand.end_process()
    assert stand.turn() == [True] and stand.answers() == [{"id": 1, "a": "long one"}, {"b": 2}]


def test_a_request_whose_process_was_stopped_is_answered_and_the_next_goes_to_another_process(stand: Stand) -> None:
    assert stand.relay.fail_request(RenderError("too long")) is False and stand.answers() == []
    stand.write(ask(1), ask(2))
    stand.turn(2)
    assert stand.relay.fail_request(RenderError("too long")) is True
    facts = {"kind": "RenderError", "message": "too long", "exit_code": RenderError.exit_code}
    assert stand.answers() == [{"id": 1, "error": facts}] and stand.relay.fail_request(RenderError("again")) is False
    stand.hear()
    with stand.relay.open_pipes():
        stand.turn()
        assert [request["id"] for request in stand.hear()] == [2]


def test_a_waiting_request_is_cancelled_here_and_one_that_is_answered_over_there(stand: Stand) -> None:
    stand.write(ask(1), ask(2))
    stand.turn(2)
    stand.hear()
    stand.write({"do": "cancel", "request": 2}, {"do": "cancel", "request": 1}, {"do": "cancel", "request": 9})
    stand.turn(4)
    assert stand.answers() == [{"id": 2, "cancelled": True}]
    assert [(each["do"], each["request"]) for each in stand.hear()] == [("cancel", 1)]
    stand.say(b'{"id": 1, "cancelled": true}\n')
    stand.write(ask(9))  # nobody remembers that it was cancelled before it came
    stand.turn(4)
    assert [request["id"] for request in stand.hear()] == [9]


def test_what_a_pipe_does_not_hold_is_sent_when_there_is_room(stand: Stand) -> None:
    """A request of 3 MB, which no pipe here holds."""
    text = "x" * 3_000_000
    line, got, relay = json.dumps(ask(1, graph=text)).encode() + b"\n", b"", stand.relay
    os.set_blocking(stand._client, False)
    os.set_blocking(relay._requests.other, False)
    for _ in range(1000):
        if line:
            with contextlib.suppress(BlockingIOError):
                line = line[os.write(stand._client, line) :]
        stand.turn()
        try:
            got += os.read(relay._requests.other, 1 << 16)
        except BlockingIOError:
            continue
        if got.endswith(b"\n"):
            break
    assert json.loads(got)["graph"] == text


@pytest.mark.parametrize(("count", "is_refused"), [(100, False), (101, True)])
def test_a_line_that_is_too_long_is_refused_and_ends_the_stream(
    stand: Stand, monkeypatch, count: int, is_refused: bool
) -> None:
    monkeypatch.setattr(stream_relay, "MAX_LINE_BYTES", 100)
    stand.write(b"x" * count)
    stand.turn(2)
    answers = stand.answers()
    assert [answer["id"] for answer in answers] == [None] * is_refused
    assert stand.hear() == [None] * is_refused


def test_a_line_that_is_no_request_is_answered_at_once(stand: Stand) -> None:
    stand.write(b"[1]\n", {"id": "a", "do": "fly"})
    stand.turn(2)
    assert [(answer["id"], answer["error"]["kind"]) for answer in stand.answers()] == [
        (None, "UsageError"),
        ("a", "UsageError"),
    ]
    assert stand.hear() == []


def test_a_client_that_cannot_be_answered_any_more_ends_the_work_for_it(stand: Stand) -> None:
    stand.write(ask(1), ask(2))
    stand.turn(2)
    assert len(stand.hear()) == 1
    stand.replies.close()
    stand.write(b"no request\n")
    stand.turn()
    assert [(each["do"], each["request"]) for each in stand.hear()] == [("cancel", 1)]
    stand.say(b'{"id": 1}\n')
    stand.turn(2)
    assert stand.hear() == [None], "the second request is forgotten, and no other one is waited for"


def test_pipes_are_closed_and_the_process_has_them_as_its_streams(stand: Stand, monkeypatch) -> None:
    relay, moved = stand.relay, list[tuple[int, int]]()
    with relay.open_pipes():
        pipes = [relay._requests, relay._replies]
        ends = [end for pipe in pipes for end in (pipe.own, pipe.other)]
        monkeypatch.setattr(stream_relay.os, "dup2", lambda *pair: moved.append(pair))
        relay.enter()
        assert moved == [(pipes[0].other, 0), (pipes[1].other, 1)]
    for end in ends:
        with pytest.raises(OSError, match="Bad file"):
            os.fstat(end)
