"""Handles of keys that are pulled: the other one turns with it, with Alt it stays, with Shift the handle is level."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from halation.authoring.commands import SetFrameRange
from halation.graph import Graph, Key, Keys, Output, Port
from halation.nodes import Kind, catalogue
from imgui_bundle import imgui
from still_editor import StillEditor, open_still_editor

PORT = Port("bloom", "intensity")
HANDLE = f"handle {PORT} 20 0 right"
KEYS = Keys((Key(10, 0.2), Key(20, 0.5, "bezier", (-3.0, -0.05), (3.0, 0.05)), Key(30, 0.3)))


@pytest.fixture
def still(tmp_path: Path) -> Iterator[StillEditor]:
    graph = Graph().add_output("image", Output(Kind.IMAGE, 4)).add("bloom", catalogue()["bloom"]()).animate(PORT, KEYS)
    with open_still_editor(tmp_path, graph, size=(900.0, 600.0)) as still:
        still.editor.session.apply(SetFrameRange(1, 40))
        still.select("bloom")
        still.editor.curves.mode = "curves"
        still.show("Animation")
        still.editor.curves.fit()
        still.editor.curves.choose(frozenset({(PORT, 20.0, 0)}))
        still.show("Animation", 3)
        yield still


def pull(still: StillEditor, *keys: imgui.Key) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """The left and the right handle after the right one was pulled 40 pixels to the right and 60 up."""
    for key in keys:
        imgui.get_io().add_key_event(key, True)
    left, top, right, bottom = still.places[HANDLE]
    still.pull("Animation", HANDLE, (40.0, -60.0))
    for key in keys:
        imgui.get_io().add_key_event(key, False)
    still.show("Animation", 3)
    moved = still.places[HANDLE]
    if imgui.Key.mod_shift not in keys:
        wanted = ((left + right) / 2.0 + 40.0, (top + bottom) / 2.0 - 60.0)
        assert ((moved[0] + moved[2]) / 2.0, (moved[1] + moved[3]) / 2.0) == pytest.approx(wanted, abs=1.5)
    keyed = still.editor.session.root.animation[PORT]
    assert isinstance(keyed, Keys)
    key = keyed.keys[1]
    return key.left, key.right


def test_the_other_handle_turns_and_keeps_its_length_in_time(still: StillEditor) -> None:
    left, right = pull(still)
    assert right[0] > 3.0 and right[1] / right[0] > 0.05 / 3.0
    assert left[1] / left[0] == pytest.approx(right[1] / right[0], rel=1e-4) and left[0] < 0.0


def test_with_alt_the_other_handle_stays(still: StillEditor) -> None:
    left, right = pull(still, imgui.Key.mod_alt)
    assert left == (-3.0, -0.05) and right[0] > 3.0 and right[1] / right[0] > 0.05 / 3.0
    assert (PORT, 20.0) in still.editor.curves.free, "they are apart from then on"


def test_with_shift_it_is_level(still: StillEditor) -> None:
    left, right = pull(still, imgui.Key.mod_shift)
    assert right[0] > 3.0 and right[1] == pytest.approx(0.0, abs=1e-9) and left[1] == pytest.approx(0.0, abs=1e-9)
