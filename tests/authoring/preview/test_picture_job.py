"""The steps of a picture's job, with runs that only count: what is done, what is left, and for which request."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.preview import picture_job
from halation.authoring.preview.picture_job import PictureJob
from halation.errors import DeviceError


def make_job(**facts: Any) -> Any:
    """A job that has not begun."""
    job = PictureJob.__new__(PictureJob)
    known = {"run": None, "plan": None, "finished_passes": 0, "preroll": (0, 0), "planned_frames": (0, 0)}
    known |= {"timings": None, "frame": 5, "ahead": False, "_runs": None, "_frame_renderer": None}
    known["lease"] = SimpleNamespace(close=lambda: None)
    for name, value in (known | facts).items():
        setattr(job, name, value)
    return job


class Run:
    """So many passes, one each step; `ready` until a file is waited for."""

    def __init__(self, total: int) -> None:
        self.total, self.left, self.is_ready, self.is_closed = total, total, True, False

    def step(self, seconds: float) -> bool:
        assert seconds == 0.04
        self.left -= 1
        return self.left > 0

    def close(self) -> None:
        self.is_closed = True


@pytest.mark.parametrize(
    ("ahead", "frame", "same", "expected"),
    [(True, 5, True, True), (False, 5, True, False), (True, 6, True, False), (True, 5, False, False)],
)
def test_a_job_is_ahead_of_a_request_for_its_frame_and_its_graph(
    ahead: bool, frame: int, same: bool, expected: bool
) -> None:
    cache = object()
    job = make_job(ahead=ahead, request=SimpleNamespace(frame=1, frame_cache=cache))
    asked: Any = SimpleNamespace(frame=frame, frame_cache=cache if same else object())
    assert job.is_ahead_of(asked) is expected


@pytest.mark.parametrize(
    ("run", "planned", "preroll", "expected"),
    [
        (None, (0, 0), (0, 0), None),
        (None, (0, 3), (0, 0), ("plan", 0, 3)),
        (None, (2, 3), (0, 9), ("plan", 2, 3)),
        (None, (3, 3), (0, 9), ("pre-roll", 0, 9)),
        (Run(1), (2, 3), (4, 9), ("pre-roll", 4, 9)),
        (Run(1), (3, 3), (9, 9), None),
        (Run(1), (0, 0), (0, 0), None),
        (Run(1), (3, 3), (-1, 0), None),
    ],
)
def test_what_of_the_history_is_under_way(
    run: Run | None, planned: tuple[int, int], preroll: tuple[int, int], expected: tuple[str, int, int] | None
) -> None:
    assert make_job(run=run, planned_frames=planned, preroll=preroll).preroll_progress == expected


def test_a_history_is_planned_and_run_frame_by_frame() -> None:
    """Two frames are planned, two of history are run before the frame itself."""
    runs, planned = [Run(2), Run(1), Run(3)], iter([(1, 2), (2, 2), None])
    plan = SimpleNamespace(tiling=None)
    renderer = SimpleNamespace(
        plan_next=lambda frame: next(planned), plan_frame=lambda frame: plan, find_lead_frames=lambda frame: [3, 4],
        start_runs=lambda frame, lease, timings: iter(runs),
    )  # fmt: skip
    job = make_job(_frame_renderer=renderer)
    assert job.is_ready
    seen = list[tuple[bool, object, int]]()
    for _ in range(9):
        seen.append((job.step(), job.preroll_progress, job.finished_passes))
    assert seen == [
        (False, ("plan", 1, 2), 0), (False, None, 0), (False, ("pre-roll", 0, 2), 0),
        (False, ("pre-roll", 0, 2), 0), (False, ("pre-roll", 1, 2), 2), (False, None, 3),
        (False, None, 3), (False, None, 3), (True, None, 6),
    ]  # fmt: skip
    assert job.run is runs[-1] and job.plan is plan
    runs[-1].is_ready = False
    assert not job.is_ready


def test_a_frame_without_a_history_is_done_after_its_only_run() -> None:
    run, closed = Run(2), list[bool]()
    job = make_job(run=run, lease=SimpleNamespace(close=lambda: closed.append(True)))
    assert (job.step(), job.step(), job.finished_passes) == (False, True, 2)
    job.close()
    assert run.is_closed and closed == [True]
    make_job(lease=SimpleNamespace(close=lambda: closed.append(True))).close()
    assert closed == [True] * 2


def test_a_picture_that_is_made_in_parts_cannot_be_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """The whole picture says so; where only its visible part is asked for, nothing is said."""
    plan: Any = SimpleNamespace(tiling=SimpleNamespace(why="it has 20 GB"), memories={})
    closed = list[bool]()
    lease = SimpleNamespace(close=lambda: closed.append(True))
    renderer: Any = SimpleNamespace(
        compile=lambda graph, request: plan, runner=SimpleNamespace(create_lease=lambda: lease)
    )
    cache = SimpleNamespace(find_frame_renderer=lambda ports: None)
    request: Any = SimpleNamespace(
        frame_cache=cache, graph=None, frame=1, ports={}, render_request=lambda ports, frame, region: None
    )
    with pytest.raises(DeviceError, match="it has 20 GB: look at a smaller proxy, or render it to a file"):
        PictureJob(renderer, request, {}, 1, False)
    assert closed == [True]
    glimpse: Any = SimpleNamespace(names=())
    monkeypatch.setattr(picture_job, "find_visible_part", lambda *_: SimpleNamespace(region=None))
    assert picture_job.begin_visible_part(renderer, request, glimpse) is None and closed == [True] * 2
    monkeypatch.setattr(picture_job, "find_visible_part", lambda *_: None)
    assert picture_job.begin_visible_part(renderer, request, glimpse) is None and closed == [True] * 2
