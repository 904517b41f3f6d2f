"""Messages to the user: the last ones are kept, a repeated one is there once, and errors of actions become messages."""

from __future__ import annotations

from typing import Any

import pytest
from halation.authoring.log import KEPT, Log
from halation.errors import UsageError


def make() -> tuple[Log, list[float]]:
    """A log, and the times that its clock will say."""
    times = [float(second) for second in range(10 * KEPT, 0, -1)]
    return Log(clock=times.pop), times


def test_the_same_message_twice_in_a_row_is_there_once_with_its_last_time() -> None:
    log, _ = make()
    for words in (("a",), ("a",), ("a", "error"), ("a", "error", "why"), ("b",), ("a",)):
        log.add(*words)  # type: ignore[arg-type]
    assert [(entry.sentence, entry.level, entry.detail, entry.at) for entry in log.entries] == [
        ("a", "info", "", 2.0), ("a", "error", "", 3.0), ("a", "error", "why", 4.0), ("b", "info", "", 5.0),
        ("a", "info", "", 6.0),
    ]  # fmt: skip


def test_the_last_messages_are_kept() -> None:
    log, _ = make()
    for number in range(KEPT + 3):
        log.add(str(number))
    assert len(log.entries) == KEPT and log.entries[0].sentence == "3"


def test_an_error_of_an_action_is_a_message() -> None:
    log, _ = make()

    def fail(error: Exception) -> Any:
        raise error

    assert log.attempt(lambda: 7) == 7 and not log.entries
    assert log.attempt(lambda: fail(UsageError("type a name")), default=3) == 3
    assert (log.entries[-1].sentence, log.entries[-1].level, log.entries[-1].detail) == ("type a name", "error", "")
    assert log.attempt(lambda: fail(ValueError("odd"))) is None
    entry = log.entries[-1]
    assert "ValueError" in entry.sentence and "odd" in entry.sentence and entry.level == "error"
    assert "Traceback" in entry.detail and "fail" in entry.detail
    with pytest.raises(KeyboardInterrupt):
        log.attempt(lambda: fail(KeyboardInterrupt()))  # type: ignore[arg-type]


def test_new_messages_are_shown_for_some_seconds() -> None:
    now = [100.0]
    log = Log(clock=lambda: now[0])
    log.add("first")
    now[0] += 4.0
    log.add("second")
    assert [entry.sentence for entry in log.toasts()] == ["first", "second"] and log.age(log.entries[0]) == 4.0
    now[0] += 2.0
    assert [entry.sentence for entry in log.toasts()] == ["second"], "six seconds are over for the first one"
    now[0] += 4.0
    assert log.toasts() == () and log.age(log.entries[1]) == 6.0
