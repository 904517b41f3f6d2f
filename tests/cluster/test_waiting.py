"""Frames that one worker cannot render wait for others, which may come late."""

from __future__ import annotations

import json

import pytest
from farms import FULL, check_whole, customize, end_group, make_graph, render_words, start_halation
from halation.cluster import workers
from halation.cluster.assignments import Assignment, WaitingAssignments
from halation.version import VERSION

NEAR, FAR, LATE = "tcp://near:1", "tcp://far:1", "tcp://late:1"


class Clock:
    """Stands in for `time`: the test says what time it is."""

    def __init__(self) -> None:
        self.now = 1000.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(workers, "time", clock)
    return clock


@pytest.fixture
def roster(clock):
    return workers.WorkerRoster(wants_gpu=False)


def connect(roster, *addresses: str) -> None:
    roster.update({address: {"nthreads": 1} for address in addresses})


def test_at_the_start_one_worker_waits_for_others_and_not_for_ever(roster, clock):
    connect(roster, NEAR)
    assert roster.expects_others({NEAR}) and not roster.has_others({NEAR})
    clock.now += workers.PATIENCE_SECONDS + 0.1
    connect(roster, NEAR)
    assert not roster.expects_others({NEAR})
    connect(roster, NEAR, LATE)
    assert roster.has_others({NEAR}) and roster.expects_others({NEAR})


def test_two_workers_that_agree_are_believed_unless_others_have_gone(roster, clock):
    connect(roster, NEAR, FAR)
    assert not roster.expects_others({NEAR, FAR})
    clock.now += 1000.0
    connect(roster, NEAR)
    assert roster.has_changed and roster.expects_others({NEAR, FAR})


def test_without_any_worker_a_job_waits(roster, clock):
    connect(roster, NEAR)
    connect(roster)
    clock.now += 1000.0
    assert roster.expects_others({NEAR})


def test_workers_of_this_process_get_no_company(roster):
    connect(roster, "inproc://1.2.3.4/5/6")
    assert not roster.expects_others({"inproc://1.2.3.4/5/6"})


def test_what_waits_is_ready_or_hopeless_once(roster, clock):
    waiting = WaitingAssignments(roster)
    connect(roster, NEAR)
    first, second = (Assignment((frame,), 1, frozenset({NEAR}), fault={"message": "full"}) for frame in (1, 2))
    waiting.add(first)
    assert (waiting.take_ready(), waiting.take_hopeless(), len(waiting)) == ([], [], 1)
    connect(roster, NEAR, FAR)
    assert waiting.take_ready() == [first] and not waiting
    connect(roster, NEAR)
    waiting.add(second)
    clock.now += workers.PATIENCE_SECONDS + 0.1
    assert waiting.take_ready() == [] and waiting.take_hopeless() == [second] and not waiting


def test_a_worker_that_could_not_be_asked_for_its_version_is_asked_again(roster):
    facts = {NEAR: {"nthreads": 1}, FAR: {"nthreads": 1}}
    assert roster.update(facts) == [NEAR, FAR]
    assert list(roster.check_versions({NEAR: VERSION, FAR: OSError("the connection is closed")})) == []
    assert roster.update(facts) == [FAR] and roster.usable == [NEAR, FAR]
    assert list(roster.check_versions({FAR: "0.0.7"})) == [FAR]
    assert roster.update(facts) == [] and roster.usable == [NEAR]


def fail(roster, address: str, *frames: int) -> list[bool]:
    """A chunk of one frame after the other fails on a worker."""
    return [roster.note_failure(address, (frame,), "full") for frame in frames]


def test_a_worker_that_fails_again_and_again_gets_no_more_frames(roster):
    connect(roster, NEAR, FAR)
    assert fail(roster, NEAR, 1, 2) == [False, False]
    roster.note_success(NEAR)
    assert fail(roster, NEAR, 3, 4, 5) == [False, False, True] and roster.usable == [FAR]
    assert "it has failed 3 times in a row: full" in roster.refusals[NEAR]


def test_the_only_worker_goes_on_until_there_is_another(roster):
    connect(roster, NEAR)
    assert not any(fail(roster, NEAR, 1, 2, 3, 4)) and roster.usable == [NEAR]
    connect(roster, NEAR, FAR)
    assert fail(roster, NEAR, 5) == [True]


def test_frames_that_all_workers_fail_with_cost_no_worker(roster):
    connect(roster, NEAR, FAR)
    assert fail(roster, NEAR, 1, 2, 3)[-1]
    assert roster.pardon((1,)) == [NEAR] and roster.usable == [NEAR, FAR]
    assert fail(roster, FAR, 1, 1, 1) == [False] * 3  # known to be bad: they say nothing about it
    assert fail(roster, NEAR, 4) == [True] and roster.pardon((9,)) == []


@pytest.mark.parametrize("kind", ["free", "memory", "chain"])
def test_a_worker_that_comes_after_one_with_a_full_disk_renders_what_waits(halation, shot, make_farm, tmp_path, kind):
    """Frames by themselves, with a memory that workers share, and one after the other."""
    pytest.importorskip("distributed", reason="Dask is not installed")
    graph = make_graph()
    if kind == "memory":
        graph["nodes"]["trail"] = {"type": "feedback"}
        graph["links"] |= {"trail.image": "lut.out", "blur.image": "trail.out"}
    if kind == "chain":
        graph["nodes"]["blur"] = {"type": "feedback"}
        del graph["animation"]
    (shot / "shot.json").write_text(json.dumps(graph))
    farm = make_farm()
    farm.start_worker(**customize(tmp_path / "full", FULL))
    process = start_halation(*render_words(farm), cwd=shot)
    assert process.stderr is not None
    lines = [process.stderr.readline()]
    while "frames wait for another worker" not in lines[-1]:
        assert lines[-1], lines
        lines.append(process.stderr.readline())
    assert "the disk is full" in lines[-1]
    farm.start_worker()
    _, err = process.communicate(timeout=100)
    assert process.returncode == 0, err
    check_whole(halation, shot)


def test_frames_wait_where_all_others_were_killed(halation, shot, make_farm, tmp_path):
    """The only worker that is left has a full disk, until one of the others is started again."""
    pytest.importorskip("distributed", reason="Dask is not installed")
    farm = make_farm()
    farm.start_worker()
    assert halation(*render_words(farm, "1")).code == 0
    end_group(farm.workers.pop())
    full = customize(tmp_path / "full", FULL)
    farm.start_worker(**full)
    process = start_halation(*render_words(farm), cwd=shot)
    assert process.stderr is not None
    while "frames wait for another worker" not in (line := process.stderr.readline()):
        assert line
    farm.start_worker()
    _, err = process.communicate(timeout=100)
    assert process.returncode == 0, err
    check_whole(halation, shot)
