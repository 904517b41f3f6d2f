"""When a window that nobody touches goes on drawing."""

from __future__ import annotations

from halation.editor.window.resting import Settling


def test_frames_follow_an_event_until_all_has_its_place() -> None:
    """On a quick machine for a second, longer than a tooltip waits; on a slow one as many as a dialog needs."""
    for frame_seconds, least in ((1 / 60, 60), (0.5, 6)):
        settling, time_now, frames = Settling(), 5.0, 0
        assert settling.choose_rate(False, time_now) == 0.0
        assert settling.choose_rate(True, time_now) > 0.0
        while settling.choose_rate(False, time_now):
            time_now += frame_seconds
            frames += 1
        assert least <= frames <= 62 and time_now - 5.0 >= 0.4


def test_each_event_begins_anew() -> None:
    settling = Settling()
    assert all(settling.choose_rate(True, 0.9 * number) for number in range(20))
    assert settling.choose_rate(False, 18.0) > 0.0
