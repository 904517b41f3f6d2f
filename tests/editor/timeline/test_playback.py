"""Which frame is due, in made-up time."""

from __future__ import annotations

import pytest
from halation.authoring.commands import SetFrameRange
from halation.authoring.session import Session
from halation.editor.timeline.playback import Course, Playback
from halation.editor.timeline.state import TimelineState
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS


def run(playback: Playback, seconds: float, each: float, start: float = 100.0) -> list[int]:
    """Every frame that is shown if each takes so long to compute, looked at a thousand times a second."""
    shown, ready, last = [playback.frame], start, playback.frame
    for step in range(1, round(seconds * 1000) + 1):
        now = start + step / 1000.0
        busy = now < ready
        if not busy:
            playback.note(now)
        frame = playback.tick(now, busy)
        if frame is None:
            break
        if frame != last:
            last, ready = frame, now + each
            shown.append(frame)
    return shown


@pytest.mark.parametrize(
    ("loop", "wanted"),
    [
        ("loop", [1, 2, 3, 4, 1, 2, 3, 4, 1]),
        ("once", [1, 2, 3, 4, 4, 4, 4, 4, 4]),
        ("ping-pong", [1, 2, 3, 4, 3, 2, 1, 2, 3]),
    ],
)
def test_courses(loop, wanted):
    course = Course(1, 4, loop=loop)
    assert [course.at(place) for place in range(9)] == wanted
    assert Course(7, 7, loop=loop).at(3) == 7
    assert course.place(3) == 2 and course.place(40) == 0


def test_a_quick_machine_shows_every_frame_at_its_rate():
    playback = Playback()
    playback.start(Course(1, 48, 24.0), 1, 100.0)
    shown = run(playback, 1.99, 0.001)
    assert shown == list(range(1, 49)) and playback.dropped == 0
    assert playback.rate == pytest.approx(24.0, abs=0.6)
    assert playback.words.endswith("of 24 fps")


def test_a_slow_machine_drops_frames_and_says_so():
    playback = Playback()
    playback.start(Course(1, 48, 24.0), 1, 100.0)
    shown = run(playback, 1.99, 0.1)
    assert shown == sorted(shown) and 15 <= len(shown) <= 21
    assert playback.dropped == shown[-1] - len(shown)
    assert shown[-1] >= 44, "the clock decides"
    assert playback.words.endswith(f"of 24 fps, {playback.dropped} dropped")


def test_or_leaves_none_out():
    playback = Playback()
    playback.start(Course(1, 48, 24.0, every=True), 1, 100.0)
    shown = run(playback, 1.99, 0.1)
    assert shown == list(range(1, len(shown) + 1)) and 15 <= len(shown) <= 21 and playback.dropped == 0
    assert playback.ahead(0.5) == shown[-1] + 1


def test_a_frame_that_is_under_way_is_waited_for():
    playback = Playback()
    playback.start(Course(1, 48, 10.0), 1, 0.0)
    assert playback.ahead(0.25) == 4 and playback.ahead(0.01) == 2
    assert playback.tick(0.15, False, under_way=4) == 1, "it comes later"
    assert playback.tick(0.5, False, under_way=4) == 4, "it is late, but what is begun is shown"
    assert playback.dropped == 2
    assert playback.tick(0.5, True) == 4


def test_once_comes_to_an_end_and_begins_anew():
    playback = Playback()
    playback.start(Course(1, 6, 24.0, "once"), 3, 100.0)
    assert run(playback, 2.0, 0.0) == [3, 4, 5, 6] and not playback.playing
    playback.start(Course(1, 6, 24.0, "once"), 6, 100.0)
    assert playback.frame == 1


def test_somebody_else_seeks_or_changes_the_range():
    playback = Playback()
    course = Course(1, 48, 24.0)
    playback.start(course, 1, 0.0)
    playback.keep(course, 30, 1.0)
    assert playback.tick(1.0, False) == 30 and playback.tick(1.05, False) == 31
    playback.keep(Course(1, 10, 24.0), 31, 2.0)
    assert playback.tick(2.0, False) == 1


def test_the_part_that_is_played_and_what_is_seen():
    session, state = Session(TOYS, sandbox=UNRESTRICTED), TimelineState()
    session.apply(SetFrameRange(1, 100))
    state.set_part(session, 20, 140)
    assert state.span(session) == (20, 100)
    session.apply(SetFrameRange(1, 10))
    assert state.span(session) == (1, 10), "a part outside is none"
    session.apply(SetFrameRange(1, 100))
    state.set_part(session, 1, 100)
    assert state.part is None
    assert state.visible_range(session) == (0.5, 100.5)
    state.zoom(session, 50.0, 4.0)
    low, high = state.visible_range(session)
    assert high - low == pytest.approx(25.0) and (50.0 - low) / (high - low) == pytest.approx(0.495)
    state.pan(session, 1e6)
    assert state.visible_range(session)[0] == pytest.approx(99.0)
    for _ in range(9):
        state.zoom(session, 50.0, 0.5)
    assert state.view is None
    assert [state.next_loop() or state.loop for _ in range(3)] == ["once", "ping-pong", "loop"]


def test_a_frame_outside_of_a_course_is_its_beginning():
    assert [Course(3, 6).place(frame) for frame in (2, 3, 5, 6, 7)] == [0, 0, 2, 3, 0]
