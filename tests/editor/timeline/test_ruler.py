"""The ruler of the timeline under the mouse."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.authoring.commands import SetFrameRange
from halation.editor.timeline import ruler
from halation.graph import Key, Keys, Port
from imgui_bundle import imgui
from still_acts import make_graph
from still_editor import open_still_editor


def test_who_takes_the_current_frame_stops_what_is_played(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, make_graph(), size=(900.0, 120.0)) as still:
        session, timeline = still.editor.session, still.editor.timeline
        session.apply(SetFrameRange(1, 48))
        still.show("Timeline")
        timeline.play(session, imgui.get_time())
        assert timeline.playing
        for part, frame in ((0.25, 12), (0.75, 36)):
            still.click("Timeline", "ruler", part=(part, 0.5))
            assert not timeline.playing and abs(session.time.frame - frame) <= 2


def test_the_frame_under_the_mouse_is_told_with_its_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Seconds count from the first frame of the range, at the rate of the document."""
    told = list[str]()
    monkeypatch.setattr(ruler, "tip", told.append)
    graph = make_graph().animate(Port("bloom", "intensity"), Keys((Key(10, 0.0), Key(34, 1.0))))
    with open_still_editor(tmp_path, graph, size=(900.0, 120.0)) as still:
        still.editor.session.apply(SetFrameRange(10, 58))
        still.show("Timeline")
        left, _, right, _ = still.places["ruler"]
        first, last = (still.places[f"ruler {frame}"] for frame in (10, 58))
        step = ((last[0] + last[2]) - (first[0] + first[2])) / 2.0 / 48.0
        for frame, words in (
            (10, "frame 10, 0.00 s · a key"),
            (16, "frame 16, 0.25 s"),
            (34, "frame 34, 1.00 s · a key"),
        ):
            x = (first[0] + first[2]) / 2.0 + (frame - 10) * step
            told.clear()
            still.pane.point(still.find_point("ruler", ((x - left) / (right - left), 0.5)))
            still.show("Timeline", 2)
            assert told[-1] == words
