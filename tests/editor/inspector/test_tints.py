"""Fields of animated values are outlined in the color of what animates them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from drawn_shapes import DrawnShapes
from halation.authoring.commands import ReplaceGraph
from halation.authoring.session import Session
from halation.editor.inspector import keying
from halation.editor.inspector.keying import Keying
from halation.editor.theme.palette import PALETTES
from halation.editor.theme.style import u32
from halation.graph import Expression, Graph, Key, Keys, Port
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain

GAIN, STEPS, TINT = Port("gain", "gain"), Port("gain", "steps"), Port("gain", "tint")
RECT = (10.0, 20.0, 110.0, 42.0)


@pytest.fixture
def session() -> Session:
    graph = (
        Graph().add("gain", Gain()).animate(GAIN, Keys((Key(1, 0.0), Key(9, 1.0)))).animate(STEPS, Expression("frame"))
    )
    made = Session(TOYS, sandbox=UNRESTRICTED)
    made.apply(ReplaceGraph("Start", graph))
    return made


def test_looks_are_those_of_the_frame(session: Session) -> None:
    assert [keying.look_of(session, port) for port in (GAIN, STEPS, TINT)] == ["key", "expression", "still"]
    session.time.seek(5)
    assert keying.look_of(session, GAIN) == "keys"


@pytest.mark.parametrize("frame", [1, 5])
@pytest.mark.parametrize("name", PALETTES)
def test_keys_tint_their_field(monkeypatch: pytest.MonkeyPatch, session: Session, name: str, frame: int) -> None:
    shapes, palette = DrawnShapes(), PALETTES[name]
    imgui = SimpleNamespace(get_window_draw_list=lambda: shapes, get_style=lambda: SimpleNamespace(frame_rounding=4.0))
    monkeypatch.setattr(keying, "imgui", imgui)
    rows: Any = SimpleNamespace(context=SimpleNamespace(session=session), palette=palette)
    fields: Any = None
    session.time.seek(frame)
    for port in (STEPS, TINT):
        Keying(fields).tint(rows, port, RECT)
        assert not shapes.shapes, "its field looks otherwise"
    Keying(fields).tint(rows, GAIN, RECT)
    ground, border = shapes.shapes
    assert (ground.kind, border.kind) == ("filled rect", "rect")
    assert (
        ground.points == border.points == ((10.0, 20.0), (110.0, 42.0))
        and ground.lengths[0] == border.lengths[0] == 4.0
    )
    color = keying.color_of(palette, keying.look_of(session, GAIN))
    assert ground.color & 0xFFFFFF == border.color & 0xFFFFFF == u32(color) & 0xFFFFFF
    assert 0 < ground.color >> 24 < 64 < 128 < border.color >> 24 < 192, "text can be read on it, and it has an edge"
