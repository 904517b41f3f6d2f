"""When a window that nobody touches goes on drawing."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from halation.editor.window import resting
from halation.editor.window.resting import FrameWaker, Settling

PATIENCE = 30.0
"""Seconds in which a thread wakes the window, on any machine."""


def test_frames_follow_an_event_until_all_has_its_place() -> None:
    """On a quick machine for a second, longer than a tooltip waits; on a slow one as many as a dialog needs."""
    for frame_seconds, least in ((1 / 60, 60), (0.5, 6)):
        settling, time_now, frames = Settling(), 5.0, 0
        assert settling.choose_rate(False, time_now) == 0.0
        assert settling.choose_rate(True, time_now) > 0.0
        while settling.choose_rate(False, time_now):
            time_now += frame_seconds
            frames += 1
        assert least <= frames <= 62 and time_now - 5.0 >= 0.4


def test_each_event_begins_anew() -> None:
    settling = Settling()
    assert all(settling.choose_rate(True, 0.9 * number) for number in range(20))
    assert settling.choose_rate(False, 18.0) > 0.0


@contextmanager
def open_waker(monkeypatch: pytest.MonkeyPatch, has_news: Callable[[], bool]) -> Iterator[threading.Event]:
    """A waker, and what is set as soon as it has woken the window."""
    woken = threading.Event()
    monkeypatch.setattr(resting.glfw, "post_empty_event", woken.set)
    waker = FrameWaker(has_news)
    try:
        yield woken
    finally:
        waker.close()
        waker.close()  # a second time does nothing


def test_news_wake_the_window(monkeypatch) -> None:
    news, looked = threading.Event(), threading.Semaphore(0)

    def has_news() -> bool:
        looked.release()
        return news.is_set()

    with open_waker(monkeypatch, has_news) as woken:
        assert looked.acquire(timeout=PATIENCE) and looked.acquire(timeout=PATIENCE)
        assert not woken.is_set(), "nothing has changed"
        news.set()
        assert woken.wait(PATIENCE)
    assert not any(thread.name == "waker" for thread in threading.enumerate())


@pytest.mark.skipif(sys.platform == "win32", reason="signals and limits are POSIX")
def test_a_signal_wakes_the_window_and_others_hear_of_it_again_afterwards(monkeypatch) -> None:
    before = signal.set_wakeup_fd(-1)
    signal.set_wakeup_fd(before)
    handler = signal.signal(signal.SIGUSR1, lambda number, frame: None)
    try:
        with open_waker(monkeypatch, lambda: False) as woken:
            os.kill(os.getpid(), signal.SIGUSR1)
            assert woken.wait(PATIENCE)
    finally:
        signal.signal(signal.SIGUSR1, handler)
    after = signal.set_wakeup_fd(before)
    assert after == before
