"""Which workers get frames, what runs on them, and where their files are: without a cluster."""

from __future__ import annotations

import pytest
from halation.cluster.path_map import PathMap, parse_path_map
from halation.cluster.workers import WorkerRoster
from halation.errors import UsageError

GPU, SECOND, PLAIN = "tcp://10.0.0.1:4000", "tcp://10.0.0.1:4001", "tcp://10.0.0.2:4000"
FACTS = {
    GPU: {"nthreads": 4, "resources": {"GPU": 1}},
    SECOND: {"nthreads": 2, "resources": {"GPU": 3}},
    PLAIN: {"nthreads": 8, "resources": {}},
}


def open_roster(*, wants_gpu: bool, **more: dict[str, object]) -> WorkerRoster:
    roster = WorkerRoster(wants_gpu=wants_gpu)
    assert roster.is_empty and not roster.usable and roster.slots == 0
    assert roster.update({**FACTS, **more}) == [*FACTS, *more]
    return roster


def test_a_thread_is_a_slot() -> None:
    roster = open_roster(wants_gpu=False)
    assert not roster.needs_gpu and not roster.is_empty
    assert roster.usable == [GPU, SECOND, PLAIN] and roster.slots == 14
    assert roster.count_slots_by_machine() == {"10.0.0.1": 6, "10.0.0.2": 8}
    assert GPU in roster and "tcp://10.0.0.9:1" not in roster


def test_where_some_have_a_gpu_only_they_render_and_each_gpu_is_a_slot() -> None:
    """A worker with more devices than threads renders as much as it has threads."""
    roster = open_roster(wants_gpu=True)
    assert roster.needs_gpu and roster.usable == [GPU, SECOND]
    assert roster.slots == 1 + 2 and roster.count_slots_by_machine() == {"10.0.0.1": 3}
    roster.update({PLAIN: FACTS[PLAIN]})
    assert not roster.needs_gpu and roster.usable == [PLAIN] and roster.slots == 8


def test_a_worker_that_says_nothing_of_itself_has_one_slot() -> None:
    roster = WorkerRoster(wants_gpu=True)
    roster.update({PLAIN: {}})
    assert roster.slots == 1 and not roster.needs_gpu


def test_a_chunk_goes_to_workers_that_have_not_tried_it() -> None:
    roster = open_roster(wants_gpu=False)
    assert roster.choose(()) is None  # any
    assert roster.choose({GPU}) == [SECOND, PLAIN]
    assert roster.choose({GPU, SECOND, PLAIN}) == [GPU, SECOND, PLAIN]
    roster.refusals[PLAIN] = "it is full"
    assert roster.choose(()) == [GPU, SECOND] and roster.choose({GPU}) == [SECOND]
    assert roster.has_others({GPU}) and not roster.has_others({GPU, SECOND})
    assert roster.slots == 6 and roster.count_slots_by_machine() == {"10.0.0.1": 6}


def test_the_longest_beginning_of_a_path_that_leads_to_a_folder_counts(tmp_path) -> None:
    show, shot = tmp_path / "show", tmp_path / "shot"
    show.mkdir()
    shot.mkdir()
    pairs = [("/farm", str(show)), ("/farm/a", str(shot)), ("/farm/b", str(tmp_path / "none"))]
    for order in (pairs, pairs[::-1]):
        paths = PathMap(order)
        assert paths.locate("/farm/a/x.exr") == str(shot / "x.exr")
        assert paths.locate("/farm/b/x.exr") == str(show / "b" / "x.exr")  # no folder here has that name
        assert paths.locate("/farm/ab/x.exr") == str(show / "ab" / "x.exr")  # a name is not cut
        assert paths.locate("/farm/a") == str(shot)
        assert paths.locate("/elsewhere/x.exr") == "/elsewhere/x.exr"


def test_pairs_of_folders_are_read() -> None:
    texts = ["/farm/show/=/show", "/a/../b=C:\\show", "/c=\\\\server\\show"]
    assert parse_path_map(texts) == (("/farm/show", "/show"), ("/b", "C:\\show"), ("/c", "\\\\server\\show"))


@pytest.mark.parametrize("text", ["/farm", "farm=/show", "/farm=show", "=/show", "/farm="])
def test_what_is_no_pair_of_absolute_folders_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="write --map FROM=TO"):
        parse_path_map([text])
