"""What the menu of a row of the Animation panel does to the animation of its value."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from halation.authoring.commands import SetFrameRange
from halation.graph import Expression, Graph, Key, Keys, Output, Port
from halation.nodes import Kind, catalogue
from still_editor import StillEditor, open_still_editor

KEYED, WRITTEN = Port("bloom", "intensity"), Port("bloom", "radius")


@pytest.fixture
def still(tmp_path: Path) -> Iterator[StillEditor]:
    graph = Graph().add_output("image", Output(Kind.IMAGE, 4)).add("bloom", catalogue()["bloom"]())
    graph = graph.animate(KEYED, Keys((Key(1, 0.0), Key(11, 1.0)))).animate(WRITTEN, Expression("frame * 0.01"))
    with open_still_editor(tmp_path, graph, size=(900.0, 600.0)) as still:
        still.editor.session.apply(SetFrameRange(1, 12))
        still.editor.session.time.seek(6)
        still.select("bloom")
        still.show("Animation", 3)
        yield still


def list_entries(still: StillEditor, port: Port) -> dict[str, tuple[float, float, float, float]]:
    """What can be chosen in the menu of a row, and where it is."""
    still.click("Animation", f"keys row {port}", 1, (0.3, 0.5))
    return {
        shape.text.split("##")[0].split("  ")[-1]: (*shape.points[0], *shape.points[1])
        for shape in still.pane.widgets
        if shape.kind == "menu_item"
    }


def choose(still: StillEditor, port: Port, entry: str) -> None:
    still.pane.click(list_entries(still, port)[entry], still.find("Animation").draw)
    still.calm("Animation")


def test_an_animation_is_removed(still: StillEditor) -> None:
    session = still.editor.session
    for port in (KEYED, WRITTEN):
        steps = len(session.history.steps)
        choose(still, port, "Remove Animation")
        assert port not in session.graph.animation and len(session.history.steps) == steps + 1
    assert session.graph.animation == {}


def test_a_key_is_set_and_removed_at_the_current_frame(still: StillEditor) -> None:
    choose(still, KEYED, "Set Key")
    keys = still.editor.session.graph.animation[KEYED]
    assert isinstance(keys, Keys) and keys.frames == (1, 6, 11) and keys.keys[1].value == pytest.approx(0.5)
    choose(still, KEYED, "Remove Key")
    keys = still.editor.session.graph.animation[KEYED]
    assert isinstance(keys, Keys) and keys.frames == (1, 11)


def test_an_expression_is_baked(still: StillEditor) -> None:
    choose(still, WRITTEN, "Bake to Keys")
    keys = still.editor.session.graph.animation[WRITTEN]
    assert isinstance(keys, Keys) and {key.frame: key.value for key in keys.keys}[6] == pytest.approx(0.06)
