"""Stages of a job with a memory, one after the other: without a cluster."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from halation.cluster.assignments import Assignment
from halation.cluster.chunk import ChunkStage, StageReport
from halation.cluster.staged_assignments import StagedAssignments


def name_memory(frame: int) -> Any:
    """Stands for what a frame stores."""
    return (f"memory {frame}",)


def open_queue(frames: Iterable[int], first: int = 1, *, checks: bool = False) -> StagedAssignments:
    return StagedAssignments([*frames], first, "/shared", checks=checks)


def take(queue: StagedAssignments, slots: int = 1) -> Assignment:
    assignment = queue.take(slots)
    assert assignment is not None and assignment.stage is not None
    return assignment


def finish(queue: StagedAssignments, assignment: Assignment, seconds: float = 1.0, **facts: Any) -> None:
    """Say that a stage is finished, whose files have its kind and frame as names."""
    assert assignment.stage is not None
    kind, frames = assignment.stage.kind, assignment.frames
    names = {frame: (f"{kind}{frame}",) for frame in frames}
    memories = {} if kind == "ahead" else {frame: name_memory(frame) for frame in frames}
    report = StageReport(dict.fromkeys(frames, seconds), names, memories, **{"frame_bytes": 1000, **facts})
    assert queue.finish_stage(report, assignment) == set()


def kind_of(assignment: Assignment) -> tuple[str, tuple[int, ...]]:
    assert assignment.stage is not None
    return assignment.stage.kind, assignment.frames


def test_a_check_comes_first_and_alone_and_leaves_out_what_is_there() -> None:
    queue = open_queue(range(1, 9), checks=True)
    check = take(queue)
    assert kind_of(check) == ("check", (1, 2, 3, 4, 5, 6, 7, 8)) and check.stage == ChunkStage(
        "check", "/shared", check.frames, 0
    )
    assert queue.take(4) is None
    report = StageReport(dict.fromkeys((1, 2, 6, 7, 8), 0.0), {}, {})
    assert queue.finish_stage(report, check) == {1, 2, 6, 7, 8}
    survey = take(queue)
    assert kind_of(survey) == ("history", (1, 2)) and survey.stage is not None and survey.stage.is_survey
    finish(queue, survey)
    assert kind_of(take(queue)) == ("history", (3, 4))  # no history behind what the last frame needs
    assert queue.stage_frames == {"ahead": 0, "history": 2}


def test_a_check_that_finds_everything_leaves_nothing() -> None:
    queue = open_queue(range(1, 5), checks=True)
    check = take(queue)
    queue.finish_stage(StageReport(dict.fromkeys(check.frames, 0.0), {}, {}), check)
    assert queue.take(1) is None


@pytest.mark.parametrize(("is_first", "count"), [(True, 4), (False, 1)])
def test_the_start_of_a_process_is_no_cost_of_frames(is_first: bool, count: int) -> None:
    """Frames of 9 and 1 seconds: four of 1, or one of 8.2."""
    queue = open_queue(range(1, 41))
    finish(queue, take(queue), seconds=0.01)
    finish(queue, take(queue), seconds=0.01)
    queue.note_cost([9.0, 1.0], is_first=is_first)
    assert kind_of(take(queue)) == ("frames", tuple(range(1, 1 + count)))


def test_the_only_frame_of_a_first_chunk_is_a_cost() -> None:
    queue = open_queue(range(1, 41))
    finish(queue, take(queue), seconds=0.01)
    finish(queue, take(queue), seconds=0.01)
    queue.note_cost([2.0], is_first=True)
    assert kind_of(take(queue)) == ("frames", (1, 2))


def test_pieces_of_a_history_take_four_seconds() -> None:
    queue = open_queue([60])
    finish(queue, take(queue), seconds=1.0)
    for first in (3, 7, 11):
        piece = take(queue)
        assert kind_of(piece) == ("history", tuple(range(first, first + 4)))
        assert queue.take(9) is None  # one worker at a time
        finish(queue, piece, seconds=1.0)


@pytest.mark.parametrize(
    ("slots", "counts"), [(1, [12, 6, 3, 1, 1, 1]), (2, [6, 4, 3, 2, 2, 1]), (3, [4, 3, 2, 2, 2, 1])]
)
def test_a_worker_gets_half_of_its_share_of_what_is_left_so_that_all_end_together(
    slots: int, counts: list[int]
) -> None:
    queue = open_queue(range(1, 25))
    queue.note_cost([0.001])
    while (assignment := take(queue, slots)).stage.kind == "history":  # pyright: ignore[reportOptionalMemberAccess]
        finish(queue, assignment, 1e-4)
    taken = [assignment, *(take(queue, slots) for _ in counts[1:])]
    assert [len(one.frames) for one in taken] == counts
    assert [frame for one in taken for frame in one.frames] == [*range(1, sum(counts) + 1)]


@pytest.mark.parametrize(("gigabytes", "window"), [(1, 8), (2, 4), (8, 4)])
def test_results_take_eight_gigabytes_and_four_frames_at_least(gigabytes: int, window: int) -> None:
    queue = open_queue(range(1, 101))
    finish(queue, take(queue), seconds=1e-4, frame_bytes=gigabytes << 30)
    assert kind_of(take(queue)) == ("history", tuple(range(3, 1 + window)))


def test_each_frame_is_told_what_lies_before_it_and_which_files_are_old() -> None:
    queue = open_queue(range(1, 4), first=1)
    finish(queue, take(queue))
    frames = take(queue)
    assert frames.stage is not None and (frames.stage.kind, frames.stage.frames) == ("frames", ())
    assert frames.frames == (1,) and frames.stage.frame_before == 0
    later = take(queue)
    assert later.stage is not None and later.frames == (2,) and later.stage.frame_before == 1
    queue.finish([1, 2])
    last = take(queue)
    assert last.stage is not None and (last.frames, last.stage.drops) == ((3,), ("history1",))
    assert len(queue) == 1


@pytest.mark.parametrize("slots", [1, 3])
def test_who_computes_ahead_is_told_what_the_first_frame_stores_and_others_what_the_one_before_does(slots: int) -> None:
    """The first frame's stays for that, long after its files are removed."""
    queue, kinds = open_queue(range(1, 60)), list[str]()
    while len(queue):
        assignment = take(queue, slots)
        kind, frames = kind_of(assignment)
        kinds.append(kind)
        before = 1 if kind == "ahead" else frames[0] - 1
        assert assignment.stage is not None
        assert assignment.stage.memories == (name_memory(before) if before else ()), (kind, frames)
        if kind == "frames":
            queue.finish(frames)
        else:
            finish(queue, assignment, frame_bytes=1000, ahead_pays=True)
    assert kinds.count("ahead") > 5 and kinds.index("frames") < len(kinds) - kinds[::-1].index("ahead")


def test_a_stage_ends_three_processes_before_it_is_given_up() -> None:
    queue = open_queue(range(1, 6))
    finish(queue, take(queue))
    piece = take(queue)
    assert kind_of(piece)[0] == "history" and len(piece.frames) == 2
    assert queue.put_suspects(piece.frames, piece, "a") == ()  # it is rendered frame by frame then
    for worker in ("a", "b"):
        single = take(queue)
        assert kind_of(single) == ("history", (3,)) and worker not in single.tried
        assert queue.put_suspects(single.frames, single, worker) == ()
    single = take(queue)
    assert (single.attempts, single.tried) == (2, frozenset({"a", "b"}))
    assert queue.put_suspects(single.frames, single, "c") == (4, 5)
    assert queue.explain_loss((4, 5), "it ends") == "it needs what frame 3 stores: it ends"
    assert queue.explain_loss((3,), "it ends") == queue.explain_loss((), "it ends") == "it ends"
    assert open_queue([1]).explain_loss((4,), "it ends") == "it ends"


def test_frames_whose_history_is_there_are_tried_alone() -> None:
    """As without stages: three alone and the rest together, and a frame three times."""
    queue = open_queue(range(1, 9))
    stage, tried = ChunkStage("frames", "/shared"), frozenset({"near"})
    before = Assignment((1, 2, 3, 4, 5), 0, frozenset(), stage)
    assert queue.put_suspects(before.frames, before, "near") == ()
    taken = [take(queue) for _ in range(4)]
    assert [(each.frames, each.attempts, each.tried) for each in taken] == [
        ((1,), 1, tried), ((2,), 1, tried), ((3,), 1, tried), ((4, 5), 0, frozenset()),
    ]  # fmt: skip
    single = Assignment((7,), 1, tried, stage)
    assert queue.put_suspects((7,), single, "far") == ()
    last = take(queue)
    assert (last.frames, last.attempts, last.tried) == ((7,), 2, frozenset({"near", "far"}))
    assert queue.put_suspects((7,), last, "late") == (7,)
    assert queue.put_suspects((1, 2), Assignment((1, 2), 2, tried, stage), "late") == ()


def test_what_cannot_be_computed_ahead_is_computed_with_the_history() -> None:
    queue = open_queue(range(3, 9))
    finish(queue, take(queue), ahead_pays=True)
    ahead = next(each for _ in range(4) if kind_of(each := take(queue, 2))[0] == "ahead")
    assert queue.give_up_stage(ahead, ahead.frames[0]) == ()
    assert kind_of(take(queue, 2)) == ("history", ahead.frames)


def test_a_check_that_fails_and_a_history_that_fails() -> None:
    queue = open_queue(range(1, 9), checks=True)
    assert queue.give_up_stage(take(queue), 1) == ()
    survey = take(queue)
    assert kind_of(survey) == ("history", (1, 2))
    finish(queue, survey)
    piece = take(queue)
    rest = queue.take_rest(piece, piece.frames[-1])
    assert rest.frames == piece.frames[-1:] and kind_of(take(queue))[0] == "frames"
    assert queue.give_up_stage(rest, 4) == (5, 6, 7, 8)
    assert kind_of(take(queue))[0] == "history"  # up to the frame that cannot be rendered
