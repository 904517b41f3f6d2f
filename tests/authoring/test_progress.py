"""How far a render is, and how long it still takes if all frames take as long."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.render_queue import queued_render
from halation.authoring.render_queue.queued_render import QueuedRender


def read(monkeypatch: pytest.MonkeyPatch, name: str, **facts: Any) -> Any:
    """A figure of a render that began 12 seconds ago, and whose first pass began 10 seconds ago."""
    monkeypatch.setattr(queued_render, "time", SimpleNamespace(monotonic=lambda: 112.0))
    whole: dict[str, Any] = {
        "state": "running", "done": 0, "total": 10, "reused": 0, "_partial_frame": 0.0, "_first_pass_at": 102.0,
        "started_at": 100.0, "ended_at": 0.0,
    }  # fmt: skip
    return getattr(QueuedRender, name).fget(SimpleNamespace(**(whole | facts)))


@pytest.mark.parametrize(
    ("facts", "fraction"),
    [({}, 0.0), ({"done": 5}, 0.5), ({"done": 5, "_partial_frame": 0.5}, 0.55), ({"total": 0}, 0.0),
     ({"state": "done", "done": 3}, 1.0), ({"done": 10, "_partial_frame": 0.5}, 1.0)],
)  # fmt: skip
def test_the_part_that_is_done(monkeypatch: pytest.MonkeyPatch, facts: dict[str, Any], fraction: float) -> None:
    assert read(monkeypatch, "fraction", **facts) == pytest.approx(fraction)


@pytest.mark.parametrize(
    ("facts", "left"),
    [
        ({"done": 5}, 10.0), ({"done": 2}, 40.0), ({"done": 4, "_partial_frame": 1.0}, 10.0),
        ({"done": 6, "reused": 1}, 8.0), ({"done": 10}, 0.0), ({"done": 10, "_partial_frame": 0.5}, 0.0), ({}, None),
        ({"done": 3, "reused": 3}, None), ({"done": 5, "state": "waiting"}, None),
        ({"done": 5, "_first_pass_at": 0.0}, None),
    ],
)  # fmt: skip
def test_the_time_that_is_left(monkeypatch: pytest.MonkeyPatch, facts: dict[str, Any], left: float | None) -> None:
    """Frames that were there already took no time, so they say nothing about the others."""
    assert read(monkeypatch, "seconds_left", **facts) == (left if left is None else pytest.approx(left))


def test_the_time_that_it_took(monkeypatch: pytest.MonkeyPatch) -> None:
    assert read(monkeypatch, "seconds") == 12.0 and read(monkeypatch, "seconds", ended_at=105.5) == 5.5
    assert read(monkeypatch, "seconds", started_at=0.0) == 0.0
