"""Pictures get coarser while a value is dragged, if they are too slow."""

import pytest
from halation.editor.viewer.pacing import Pace, PictureTimer, choose_start_scale, coarsen_scale


@pytest.mark.parametrize(
    ("seconds", "scale"), [(0.02, 1.0), (0.06, 1.0), (0.1, 0.5), (0.24, 0.5), (0.25, 0.25), (9, 0.25)]
)
def test_slow_pictures_get_coarser(seconds: float, scale: float) -> None:
    assert coarsen_scale(1.0, 1.0, seconds) == scale


def test_coarser_is_relative_to_the_chosen_proxy() -> None:
    assert coarsen_scale(0.5, 0.5, 9.0) == 0.125


def test_a_drag_falls_and_never_rises_and_ends_at_full() -> None:
    pace = Pace()
    assert pace.at(1.0, True) == 1.0
    pace.took(1.0, 0.2)
    assert pace.at(1.0, True) == 0.5
    pace.took(0.5, 0.001)
    assert pace.at(1.0, True) == 0.5
    pace.took(0.5, 0.1)
    assert pace.at(1.0, True) == 0.25
    assert pace.at(1.0, False) == 1.0


def test_the_next_drag_starts_where_it_will_be_fast() -> None:
    pace = Pace()
    pace.at(1.0, False)
    pace.took(1.0, 0.5)
    assert pace.at(1.0, True) == 0.25


def test_a_scale_is_not_left_for_a_small_gain() -> None:
    assert choose_start_scale(1.0, 0.5, 0.05) == 0.5
    assert choose_start_scale(1.0, 0.5, 0.03) == 1.0
    assert choose_start_scale(1.0, 1.0, 0.05) == 1.0


def test_another_proxy_is_another_matter() -> None:
    pace = Pace()
    pace.at(1.0, False)
    pace.took(1.0, 0.5)
    assert pace.at(0.25, True) == 0.25


def test_work_is_measured_from_its_begin_to_its_end() -> None:
    watch = PictureTimer()
    frames = ((False, "a", 1.0), (True, "a", 2.0), (True, "a", 2.25), (False, "b", 2.375), (False, "b", 4.0))
    assert [watch.lap(*frame) for frame in frames] == [None, None, None, 0.375, None]


def test_pictures_of_one_drag_are_measured_one_by_one() -> None:
    watch = PictureTimer()
    frames = ((True, "a", 1.0), (True, "b", 1.125), (True, "b", 1.25), (True, "c", 1.375), (False, "c", 1.5))
    assert [watch.lap(*frame) for frame in frames] == [None, 0.125, None, 0.25, 0.125]


def test_a_picture_that_does_not_come_is_slow() -> None:
    watch = PictureTimer()
    frames = ((True, "a", 1.0), (True, "a", 1.25), (True, "a", 1.5), (True, "a", 1.75))
    assert [watch.lap(*frame) for frame in frames] == [None, None, 0.5, None]
