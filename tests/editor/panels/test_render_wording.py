"""Renders in words: their files, how far they are, how long they take, and how they ended."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.renders import wording


def render(**changes: Any) -> Any:
    """A render of one picture by one process of this machine, which has not begun."""
    job = SimpleNamespace(
        cluster=changes.pop("cluster", ""), order=SimpleNamespace(processes=changes.pop("processes", 1))
    )
    facts: dict[str, Any] = {
        "destinations": (("image", Path("a/b.png")),), "passes": (0, 0), "has_many_files": False, "done": 0, "total": 1,
        "node": "", "frame": 7, "seconds_left": None, "workers": 0, "state": "running", "reused": 0, "seconds": 0.4,
    }  # fmt: skip
    return SimpleNamespace(job=job, **(facts | changes))


def test_the_title_is_the_first_file() -> None:
    files = [("image", Path("a/b.png")), ("depth", Path("a/c.exr")), ("id", Path("d.exr"))]
    assert [wording.title(render(destinations=files[:count])) for count in (1, 2, 3)] == [
        "b.png", "b.png and 1 more", "b.png and 2 more",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("facts", "words"),
    [
        ({}, "starting"), ({"passes": (0, 9)}, "0 of 9 passes"), ({"passes": (4, 9)}, "4 of 9 passes"),
        ({"passes": (9, 9)}, "writing"), ({"done": 1}, "writing"),
        ({"total": 5}, "starting"), ({"total": 5, "passes": (0, 9)}, "0 of 5 frames"),
        ({"total": 5, "done": 2}, "2 of 5 frames"),
        ({"total": 5, "has_many_files": True}, "starting"),
        ({"total": 5, "done": 2, "has_many_files": True}, "2 of 5 files"),
        ({"total": 5, "done": 5, "has_many_files": True}, "5 files"),
    ],
)  # fmt: skip
def test_progress(facts: dict[str, Any], words: str) -> None:
    assert wording.progress_text(render(**facts)) == words


@pytest.mark.parametrize(
    ("facts", "words"),
    [
        ({}, "reading the graph"), ({"node": "blur"}, "blur"), ({"node": "blur", "total": 5}, "frame 7: blur"),
        ({"node": "blur", "seconds_left": 12.0}, "blur   12 s left"), ({"seconds_left": 0.0}, "0.0 s left"),
        ({"total": 5, "processes": 3}, "3 processes"), ({"total": 5, "processes": 3, "node": "blur"}, "frame 7: blur"),
        ({"total": 1, "processes": 3}, "reading the graph"), ({"total": 5, "processes": 1}, "reading the graph"),
        ({"cluster": "farm:1"}, "farm:1"), ({"cluster": "farm:1", "workers": 1}, "1 worker on farm:1"),
        ({"cluster": "farm:1", "workers": 2, "node": "blur"}, "2 workers on farm:1"),
    ],
)  # fmt: skip
def test_what_is_under_way(facts: dict[str, Any], words: str) -> None:
    assert wording.under_way(render(**facts)) == words


@pytest.mark.parametrize(
    ("facts", "words"),
    [
        ({"state": "done", "done": 1}, "done in 0.4 s"),
        ({"state": "done", "done": 1, "reused": 1}, "up to date, checked in 0.4 s"),
        ({"state": "done", "done": 5, "total": 5}, "5 frames in 0.4 s"),
        ({"state": "done", "done": 5, "total": 5, "reused": 2}, "5 frames in 0.4 s, 2 already up to date"),
        ({"state": "done", "done": 5, "total": 5, "reused": 5}, "5 frames in 0.4 s, all already up to date"),
        ({"state": "done", "done": 5, "total": 5, "has_many_files": True}, "5 files in 0.4 s"),
        ({"state": "failed"}, "failed"), ({"state": "failed", "total": 5}, "failed"),
        ({"state": "failed", "total": 5, "done": 2}, "failed after 2 of 5 frames"),
        ({"state": "failed", "total": 5, "done": 2, "has_many_files": True}, "failed after 2 of 5 files"),
    ],
)  # fmt: skip
def test_how_it_ended(facts: dict[str, Any], words: str) -> None:
    assert wording.state_text(render(**facts)) == words


def test_its_turn() -> None:
    waiting = render(state="waiting")
    assert [wording.state_text(waiting, place) for place in (0, 1, 2)] == [
        "next",
        "1 before this one",
        "2 before this one",
    ]


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.0, "0.0 s"), (0.44, "0.4 s"), (9.94, "9.9 s"), (9.96, "10 s"), (59.4, "59 s"), (59.6, "1:00"), (185.0, "3:05"),
     (3599.0, "59:59"), (3600.0, "1:00:00"), (3750.0, "1:02:30"), (36000.0, "10:00:00")],
)  # fmt: skip
def test_lengths_of_time(seconds: float, text: str) -> None:
    assert wording.time_text(seconds) == text
