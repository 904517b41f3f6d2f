"""The bar over selected keys: its ends scale them about the other end, its middle moves them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from halation.authoring.commands import SetFrameRange
from halation.graph import Graph, Key, Keys, Output, Port
from halation.nodes import Kind, catalogue
from still_editor import StillEditor, open_still_editor

PORT = Port("bloom", "intensity")
FRAMES = 10.0, 16.0, 22.0


@pytest.fixture
def still(tmp_path: Path) -> Iterator[StillEditor]:
    graph = Graph().add_output("image", Output(Kind.IMAGE, 4)).add("bloom", catalogue()["bloom"]())
    graph = graph.animate(PORT, Keys(tuple(Key(frame, frame / 100.0) for frame in FRAMES)))
    with open_still_editor(tmp_path, graph, size=(900.0, 600.0)) as still:
        still.editor.session.apply(SetFrameRange(1, 48))
        still.select("bloom")
        still.show("Animation")
        still.editor.curves.choose(frozenset((PORT, frame, 0) for frame in FRAMES))
        still.show("Animation", 3)
        yield still


def read_keys(still: StillEditor) -> tuple[Key, ...]:
    keys = still.editor.session.root.animation[PORT]
    assert isinstance(keys, Keys)
    return keys.keys


@pytest.mark.parametrize(
    ("place", "moved", "frames"),
    [
        ("keys right end", 12.0, [10.0, 22.0, 34.0]),
        ("keys right end", -6.0, [10.0, 13.0, 16.0]),
        ("keys left end", -6.0, [4.0, 13.0, 22.0]),
        ("keys left end", 6.0, [16.0, 19.0, 22.0]),
        ("bar", 5.0, [15.0, 21.0, 27.0]),
        ("bar", -7.0, [3.0, 9.0, 15.0]),
    ],
)
def test_what_the_bar_does(still: StillEditor, place: str, moved: float, frames: list[float]) -> None:
    first, last = (still.places[f"key {PORT} {frame:g}"] for frame in (FRAMES[0], FRAMES[-1]))
    wide = (last[0] - first[0]) / (FRAMES[-1] - FRAMES[0])
    left, right = still.places["keys left end"], still.places["keys right end"]
    still.places["bar"] = left[2] + 4.0, left[1], right[0] - 4.0, left[3]
    steps = len(still.editor.session.history.steps)
    still.pull("Animation", place, (moved * wide, 0.0))
    assert [key.frame for key in read_keys(still)] == pytest.approx(frames)
    assert len(still.editor.session.history.steps) == steps + 1
    assert [key.value for key in read_keys(still)] == [frame / 100.0 for frame in FRAMES]
