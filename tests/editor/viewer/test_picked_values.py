"""What a click on the picture gives a value that asks for it: a place, a depth or a color."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from halation.authoring.commands import AddNode
from halation.editor.viewer import ground
from halation.graph import Port
from still_editor import StillEditor, open_still_editor


@pytest.fixture
def still(tmp_path: Path) -> Iterator[StillEditor]:
    with open_still_editor(tmp_path, size=(700.0, 500.0)) as still:
        for id in ("depth_of_field", "ramp", "constant"):
            still.editor.session.apply(AddNode(id))
        yield still


@pytest.mark.parametrize(("depth", "given"), [(3.14159265, 3.141593), (0.0, None), (-1.0, None), (2e10, 1e10)])
def test_a_distance_gets_the_depth_there_with_seven_digits(monkeypatch, still, depth: float, given: float | None):
    seen: list[Any] = []
    monkeypatch.setattr(ground, "_read", lambda *words: seen.append(words) or (depth,))
    still.editor.viewer.pixel, still.editor.viewer.picture = (10, 20), (64, 32)
    panel: Any = still.find("Viewer")
    assert panel._convert_pick(Port("depth_of_field", "focus_distance"), (0.5,)) == given
    ((context, name, place),) = seen
    assert (context, name) == (still.contexts.viewer, ground.DEPTH) and place == (0.16406, 0.64062)


def test_a_place_gets_the_pixel_and_a_color_what_is_there(still) -> None:
    panel: Any = still.find("Viewer")
    still.editor.viewer.pixel, still.editor.viewer.picture = (10, 20), (64, 32)
    assert panel._convert_pick(Port("ramp", "start"), (0.5, 0.25, 0.1, 0.5)) == (0.16406, 0.64062)
    assert panel._convert_pick(Port("constant", "color"), (0.5, 0.25, 0.1, 0.5)) == pytest.approx((1.0, 0.5, 0.2, 1.0))
