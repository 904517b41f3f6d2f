"""Signals in the middle of a call: what it has made is removed, whichever call it was."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
from halation.resources.atomic_write import check_writable, replace_file, write_bytes_atomically
from halation.resources.interrupts import END_REQUESTS, delay_interrupts
from halation.resources.sandbox import Sandbox

SIGNALS = (signal.SIGINT, *END_REQUESTS)


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """Each signal raises KeyboardInterrupt, as in a command."""
    before = {number: signal.signal(number, signal.default_int_handler) for number in SIGNALS}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def write_new(path: Path, sandbox: Sandbox) -> None:
    write_bytes_atomically(path, b"new", sandbox)


def leave_alone(path: Path, sandbox: Sandbox) -> None:
    with replace_file(path, sandbox) as replacement:
        replacement.temporary.write_bytes(b"half")


@pytest.mark.parametrize("number", SIGNALS)
def test_a_block_is_done_whole(number: signal.Signals) -> None:
    steps: list[int] = []
    with pytest.raises(KeyboardInterrupt), delay_interrupts():
        signal.raise_signal(number)
        steps.append(1)
        with delay_interrupts():
            signal.raise_signal(number)
            steps.append(2)
        steps.append(3)
    assert steps == [1, 2, 3]
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(number)


def test_a_block_that_fails_is_interrupted_too() -> None:
    with pytest.raises(KeyboardInterrupt) as caught, delay_interrupts():
        signal.raise_signal(signal.SIGINT)
        raise OSError("full")
    assert isinstance(caught.value.__context__, OSError)


def test_what_is_ignored_stays_so() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with delay_interrupts():
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN


def test_other_threads_leave_signals_alone() -> None:
    handlers: list[object] = []

    def work() -> None:
        with delay_interrupts():
            handlers.append(signal.getsignal(signal.SIGINT))

    thread = Thread(target=work)
    thread.start()
    thread.join()
    assert handlers == [signal.default_int_handler]


@pytest.mark.parametrize("work", [check_writable, write_new, leave_alone])
@pytest.mark.parametrize("name", ["open", "unlink", "replace"])
@pytest.mark.parametrize("is_before", [True, False], ids=["before", "after"])
def test_no_temporary_file_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, is_before: bool, work: Callable[[Path, Sandbox], None]
) -> None:
    """The signal arrives right before or after a call that makes, renames or removes a file."""
    call: Callable[..., Any] = getattr(Path, name)
    target = tmp_path / "picture.exr"
    target.write_bytes(b"old")

    def interrupted(self: Path, *words: Any, **options: Any) -> Any:
        if is_before:
            signal.raise_signal(signal.SIGINT)
        answer = call(self, *words, **options)
        if not is_before:
            signal.raise_signal(signal.SIGINT)
        return answer

    with monkeypatch.context() as patch, suppress(KeyboardInterrupt):
        patch.setattr(Path, name, interrupted)
        work(target, Sandbox(""))
    assert list(tmp_path.iterdir()) == [target] and target.read_bytes() in (b"old", b"new")
