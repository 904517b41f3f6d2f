"""The ruler of the timeline under the mouse."""

from __future__ import annotations

from pathlib import Path

from halation.authoring.commands import SetFrameRange
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
