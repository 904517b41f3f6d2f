"""Chunks are as long as they should be, and every frame is handed out once: without a cluster."""

from __future__ import annotations

import pytest
from halation.cluster.assignments import Assignment, AssignmentQueue, average_cost, count_chunk, count_least_chunk


@pytest.mark.parametrize(
    ("cost", "count"), [(0.0, 1), (0.1, 40), (0.5, 8), (0.9, 4), (3.9, 1), (4.0, 1), (9.0, 1), (1e-6, 1000)]
)
def test_a_chunk_takes_four_seconds_and_has_a_thousand_frames_at_most(cost: float, count: int) -> None:
    assert count_chunk(cost) == count


@pytest.mark.parametrize(
    ("cost", "slots", "count"),
    [(0.0, 100, 1), (0.5, 100, 1), (0.6, 100, 1), (0.1, 100, 5), (0.001, 100, 500), (0.001, 900, 1000)],
)
def test_a_worker_is_busy_while_all_others_are_handed_a_chunk_in_five_milliseconds_each(
    cost: float, slots: int, count: int
) -> None:
    assert count_least_chunk(cost, slots) == count


def test_newer_frames_count_more() -> None:
    assert average_cost(0.0, [2.0]) == 2.0
    assert average_cost(1.0, []) == 1.0
    assert average_cost(1.0, [2.0]) == pytest.approx(1.1)
    assert average_cost(1.0, [2.0, 3.0]) == pytest.approx(0.9 * 1.1 + 0.3)


@pytest.mark.parametrize("slots", [1, 3])
@pytest.mark.parametrize("cost", [0.02, 0.7, 6.0])
def test_chunks_become_shorter_towards_the_end_and_have_all_frames_in_order(slots: int, cost: float) -> None:
    queue, taken = AssignmentQueue(range(5, 205), is_chain=False), list[int]()
    queue.note_cost([cost])
    while left := len(queue):
        assignment = queue.take(slots)
        assert assignment is not None and assignment.attempts == 0 and not assignment.tried
        share = left // (2 * max(1, slots))
        assert len(assignment.frames) == max(1, min(share, int(4.0 / cost)))
        taken += assignment.frames
    assert taken == [*range(5, 205)]


def test_a_chain_is_one_chunk() -> None:
    queue = AssignmentQueue([3, 4, 9], is_chain=True)
    assert queue.take(4) == Assignment((3, 4, 9))
    assert len(queue) == 0


def test_what_was_put_back_goes_first_and_counts() -> None:
    queue = AssignmentQueue(range(8), is_chain=False)
    first, second = queue.take(1), queue.take(1)
    assert first is not None and second is not None
    queue.put_back(second)
    queue.put_back(first)
    assert len(queue) == 8
    assert [queue.take(1), queue.take(1)] == [second, first]
    assert len(queue) == 6


def test_of_a_chunk_whose_process_ended_three_frames_are_tried_alone() -> None:
    """One is planned, one rendered, one written. The others were not begun: nobody has tried them."""
    queue = AssignmentQueue(range(9), is_chain=False)
    queue.note_cost([0.1])
    before = queue.take(1)
    assert before == Assignment((0, 1, 2, 3))
    rest = AssignmentQueue((), is_chain=False)
    assert rest.put_suspects((1, 2, 3, 4, 5), Assignment((0, 1, 2, 3, 4, 5)), "near") == ()
    tried = frozenset({"near"})
    expected = [*(Assignment((frame,), 1, tried) for frame in (1, 2, 3)), Assignment((4, 5))]
    assert [rest.take(1) for _ in range(4)] == expected
    assert len(rest) == 0


def test_a_frame_ends_three_processes_and_no_more() -> None:
    queue = AssignmentQueue([7], is_chain=False)
    for worker in ("near", "far"):
        assignment = queue.take(1)
        assert assignment is not None and worker not in assignment.tried
        assert queue.put_suspects(assignment.frames, assignment, worker) == ()
    assert (last := queue.take(1)) == Assignment((7,), 2, frozenset({"near", "far"}))
    assert last is not None and queue.put_suspects(last.frames, last, "late") == (7,)
    assert len(queue) == 0


def test_a_chunk_of_many_frames_is_never_given_up_as_a_whole() -> None:
    queue = AssignmentQueue((), is_chain=False)
    assert queue.put_suspects((1, 2), Assignment((1, 2), 5), "near") == ()
    assert len(queue) == 2


def test_a_video_is_tried_three_times_as_a_whole() -> None:
    queue = AssignmentQueue((), is_chain=True, is_whole=True)
    for attempts in (0, 1):
        assert queue.put_suspects((4, 5), Assignment((4, 5), attempts, frozenset({"far"})), "near") == ()
        assert queue.take(1) == Assignment((4, 5), attempts + 1, frozenset({"far", "near"}))
    assert queue.put_suspects((4, 5), Assignment((4, 5), 2), "near") == (4, 5)


@pytest.mark.parametrize(("is_first", "count"), [(True, 3), (False, 1)])
def test_the_start_of_a_process_is_no_cost_of_frames(is_first: bool, count: int) -> None:
    """Costs of 9, 1 and 2: 1.1 without the first one, where newer ones count a tenth, and else 7.5."""
    queue = AssignmentQueue(range(100), is_chain=False)
    queue.note_cost([9.0, 1.0, 2.0], is_first=is_first)
    assert queue.take(1) == Assignment((*range(count),))


def test_costs_are_those_of_later_frames_unless_it_is_the_first_chunk_of_a_worker() -> None:
    queue = AssignmentQueue(range(100), is_chain=False)
    queue.note_cost([1.9, 0.5])
    assert queue.take(1) == Assignment((0, 1))


def test_of_a_chain_whose_process_ended_three_frames_are_tried_one_by_one() -> None:
    queue = AssignmentQueue(range(8), is_chain=True)
    before = queue.take(2)
    assert before is not None and queue.put_suspects(before.frames[1:], before, "near") == ()
    for frame in (1, 2, 3):
        assert queue.take(2) == Assignment((frame,), 1, frozenset({"near"}))
        assert queue.take(2) is None  # those after it need it
        queue.finish([frame])
    assert queue.take(2) == Assignment((4, 5, 6, 7))
