"""What panels say and what a drag in them changes, without a window."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.commands import AnimateValues, SetFrameRange
from halation.editor.matching.window import MatchWindow
from halation.editor.shared.action import Action
from halation.editor.theme.palette import DARK
from halation.editor.theme.style import mix, u32
from halation.editor.timeline.timeline import Timeline
from halation.editor.viewer import overlays
from halation.editor.viewer.geometry import share_height
from halation.graph import Graph, Key, Keys, Port
from halation.nodes import catalogue
from imgui_bundle import imgui
from still_editor import open_still_editor
from still_window import open_still

GRAPH = Graph().add("glow", catalogue()["bloom"]())


def test_a_page_of_a_node_names_its_values(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, GRAPH) as still:
        still.select("glow")
        still.editor.dialogs.open.add("node")
        still.show("Node")
        words = [shape.text for shape in still.pane.widgets if shape.kind == "text_wrapped"]
        bloom = catalogue()["bloom"]
        for value in (value for value in bloom.values.values() if not value.folded):
            assert value.name in words or value.name.replace("_", " ") in words, value.name
        assert {"image", *bloom.outputs} <= {*words}


@pytest.mark.parametrize(
    ("playing", "lead", "report", "words", "color"),
    [
        ("24 fps", None, "", "24 fps", DARK.text),
        ("24 fps", ("pre-roll", 3, 9), "", "pre-roll 3 of 9", DARK.accent),
        ("", ("frames", 3, 9), "", "planning 3 of 9 frames", DARK.accent),
        ("", None, "a report", "a report", DARK.dim),
        ("", None, "", "2 of 10 ready, 3 MiB", DARK.dim),
    ],
)
def test_the_timeline_says_what_is_ready(tmp_path: Path, playing, lead, report, words, color) -> None:
    with open_still_editor(tmp_path, GRAPH) as still:
        still.editor.session.apply(SetFrameRange(1, 10))
        timeline = Timeline(still.contexts.timeline)
        preview = SimpleNamespace(lead=lead, frames=(0, 1, 10, 11), frames_bytes=3 * 2**20)
        state = SimpleNamespace(playback=SimpleNamespace(words=playing), report=report)
        facts = {"preview": preview, "timeline": state, "palette": DARK, "places": {}, "fonts": None}
        timeline._context = SimpleNamespace(**facts, session=still.editor.session)  # pyright: ignore
        still.pane.draw(lambda: timeline._words((30.0, 40.0, 330.0, 60.0)))  # pyright: ignore
        (text,) = still.pane.shapes.list_kinds("text")
        assert (text.text, text.color) == (words, u32(color)) and text.points[0][0] == 30.0


def test_a_window_that_grew_moves_up_once() -> None:
    """One that was moved down by hand stays where it is."""
    with open_still() as pane:
        window = MatchWindow.__new__(MatchWindow)
        window._height = 100.0  # pyright: ignore[reportPrivateUsage]
        places = list[float]()

        def body(bottom: float, at: float | None = None) -> None:
            if at is not None:
                imgui.set_window_pos((20.0, at))
            window._stay_above(bottom)  # pyright: ignore[reportPrivateUsage]
            places.append(imgui.get_window_pos().y)

        pane.draw(lambda: body(500.0, 30.0))
        assert places[-1] == 0.0, "600 high: the top of the screen is the limit"
        pane.draw(lambda: body(500.0, 30.0))
        assert places[-1] == 30.0, "it has not grown again"
        window._height = 100.0  # pyright: ignore[reportPrivateUsage]
        pane.draw(lambda: body(650.0, 200.0))
        assert places[-1] == 50.0
        window._height = 100.0  # pyright: ignore[reportPrivateUsage]
        pane.draw(lambda: body(650.0, 40.0))
        assert places[-1] == 40.0, "there is room"


def test_the_depth_under_the_pointer_is_written_below_it(monkeypatch: pytest.MonkeyPatch) -> None:
    port = Port("lens", "focus")
    sight = SimpleNamespace(fraction=lambda at: (at[0] / 100.0, at[1] / 100.0))
    viewer = SimpleNamespace(hovered=True, picking=str(port))
    context: Any = SimpleNamespace(viewer=viewer, session=None, places={})
    drawn = list[tuple[object, ...]]()
    for name, part in {
        "find_focus_port": lambda session: port,
        "is_distance": lambda port: True,
        "depth_at": lambda context, at: at,
        "distance_in_words": str,
        "draw_label": lambda lines, at, words: drawn.append((at, words)) or (1.0, 2.0, 3.0, 4.0),
    }.items():
        monkeypatch.setattr(overlays, name, part)
    with open_still() as pane:
        pane.point((50.0, 80.0))
        pane.draw(lambda: overlays._draw_picked_depth(context, None, sight))  # pyright: ignore
        assert drawn == [((50.0, 106.0), "(0.5, 0.8)")] and context.places == {f"label {port}": (1.0, 2.0, 3.0, 4.0)}
        for change in ({"hovered": False}, {"picking": "other.port"}):
            vars(viewer).update({"hovered": True, "picking": str(port)} | change)
            pane.draw(lambda: overlays._draw_picked_depth(context, None, sight))  # pyright: ignore
        assert len(drawn) == 1


def test_the_numbers_of_the_viewer_have_limits(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, GRAPH, size=(1500.0, 500.0)) as still:
        viewer = still.editor.viewer
        still.editor.session.views.show(Port("glow", "out"))
        still.show("Viewer")
        left, top, right, bottom = still.places["field viewer gamma"]
        body, middle = still.find("Viewer").draw, ((left + right) / 2, (top + bottom) / 2)
        for by, limit in ((3000.0, 5.0), (-6000.0, 0.1)):
            still.pane.point(middle)
            still.pane.draw(body, 40)  # or it would be a double click
            imgui.get_io().add_mouse_button_event(0, True)
            still.pane.draw(body)
            still.pane.point((middle[0] + by, middle[1]))
            still.pane.draw(body, 2)
            imgui.get_io().add_mouse_button_event(0, False)
            still.pane.draw(body, 2)
            assert viewer.gamma == pytest.approx(limit)


def test_a_table_takes_no_more_than_two_fifths() -> None:
    assert share_height(500.0, 40.0, 0.0) == (460.0, 0.0)
    assert share_height(500.0, 40.0, 150.0) == (310.0, 150.0)
    assert share_height(500.0, 40.0, 300.0) == (260.0, 200.0)
    assert share_height(60.0, 40.0, 0.0) == (32.0, 0.0)


def test_names_of_values_are_fainter_than_those_of_nodes(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, GRAPH, size=(900.0, 400.0)) as still:
        still.editor.session.apply(AnimateValues({Port("glow", "intensity"): Keys((Key(1, 0.2), Key(9, 0.8)))}, "Move"))
        still.show("Animation")
        colors = {shape.text: shape.color for shape in still.pane.shapes.list_kinds("text")}
        assert colors["glow"] == u32(DARK.text) and colors["intensity"] == u32(mix(DARK.text, DARK.dim, 0.3))


def test_every_action_is_in_the_menus(tmp_path: Path) -> None:
    """Of all tables of actions in the modules of the editor."""
    tables = [
        value
        for name, module in sorted(sys.modules.items())
        if name.startswith("halation.editor.")
        for value in vars(module).values()
        if isinstance(value, tuple) and value and all(isinstance(action, Action) for action in value)
    ]
    with open_still_editor(tmp_path, GRAPH) as still:
        bound = {action.id for action in still.editor.actions.all}
        assert len(tables) > 10 and bound == {action.id for table in tables for action in table}
