"""The window rests while nothing happens, and wakes for what is no event of the window system."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path

import pytest
from gui_driver import headless
from halation import document, presets
from halation.editor.window.opening import run
from halation.editor.window.resting import AT_REST, FrameWaker
from halation.editor.window.window import Window
from halation.resources.sandbox import UNRESTRICTED

POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def test_a_window_at_rest_draws_hardly_ever(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        resting = ui.window.params.fps_idling
        ui.until(lambda: resting.enable_idling and resting.fps_idle == AT_REST)
        ui.move("Graph", (0.5, 0.9))
        ui.keys("Tab")
        ui.wait(3)
        assert resting.fps_idle > AT_REST  # a text cursor blinks
        ui.keys("Escape")
        ui.until(lambda: resting.fps_idle == AT_REST)
        ui.editor.log.add("something")
        ui.wait(2)
        assert resting.fps_idle > AT_REST  # the message will go

    gui(body, presets.paths()[0], size=(700, 500))


@pytest.mark.parametrize("news", [False, True])
def test_it_is_woken_for_news_alone(news: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    looked, woken = threading.Event(), threading.Event()
    monkeypatch.setattr("halation.editor.window.resting.glfw.post_empty_event", woken.set)
    asked: list[int] = []

    def has_news() -> bool:
        asked.append(1)
        if len(asked) > 2:
            looked.set()
        return news

    waker = FrameWaker(has_news)
    try:
        assert looked.wait(120.0)
        assert woken.is_set() == news
    finally:
        waker.close()


@POSIX
def test_a_signal_wakes_it(monkeypatch: pytest.MonkeyPatch) -> None:
    woken = threading.Event()
    monkeypatch.setattr("halation.editor.window.resting.glfw.post_empty_event", woken.set)
    before = signal.signal(signal.SIGUSR1, lambda *_: None)
    waker = FrameWaker(lambda: False)
    try:
        os.kill(os.getpid(), signal.SIGUSR1)
        assert woken.wait(120.0)
    finally:
        waker.close()
        signal.signal(signal.SIGUSR1, before)
    assert signal.set_wakeup_fd(-1) == -1  # as it was before


def test_a_file_that_changes_wakes_a_window_at_rest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HALATION_STATE", str(tmp_path / "state"))
    path = tmp_path / "look.json"
    graph = document.load(presets.paths()[0], sandbox=UNRESTRICTED)
    document.save(graph, path, sandbox=UNRESTRICTED)
    window: Window = headless(tmp_path, path)
    before, changed_at = window.params.callbacks.post_new_frame, [0]

    def frame() -> None:
        before()
        resting = window.params.fps_idling
        if not changed_at[0] and resting.enable_idling and resting.fps_idle == AT_REST:
            changed_at[0] = window.frames
            document.save(graph.disconnect(next(iter(graph.links))), path, sandbox=UNRESTRICTED)
        if any("loaded again" in entry.sentence for entry in window.editor.log.entries):
            window.editor.commands.closing = True

    window.params.callbacks.post_new_frame = frame
    run(window)
    assert changed_at[0]
