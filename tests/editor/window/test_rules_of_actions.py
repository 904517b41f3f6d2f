"""Rules that every action keeps, whatever it does: switches switch back, opposites cancel, edits are taken back."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from halation import document
from halation.authoring.commands import ReplaceGraph
from halation.graph import Port
from still_acts import make_graph, prepare
from still_editor import StillEditor, open_still_editor
from still_pictures import make_graph as make_handled_graph
from still_states import list_changes, read_state

OPPOSITE = (
    ("viewer.nudge_left", "viewer.nudge_right"), ("viewer.nudge_up", "viewer.nudge_down"),
    ("viewer.nudge_left_far", "viewer.nudge_right_far"), ("viewer.nudge_up_far", "viewer.nudge_down_far"),
    ("viewer.brighter", "viewer.darker"), ("viewer.look_left", "viewer.look_right"),
    ("viewer.look_up", "viewer.look_down"), ("time.next", "time.previous"), ("keys.later", "keys.earlier"),
    ("view.larger", "view.smaller"),
    ("select.invert", "select.invert"), ("viewer.swap", "viewer.swap"), ("node.mute", "node.mute"),
    ("node.collapse", "node.collapse"), ("keys.mode", "keys.mode"), ("viewer.nearer", "viewer.farther"),
    ("viewer.other", "viewer.other"),
)  # fmt: skip
"""Actions, and those that take back what they do."""

SYSTEM = ("file.", "help.", "tutorial.", "lesson.", "flipbook.", "view.panel", "view.layout", "view.reset",
          "view.screen", "view.maximize", "view.full", "viewer.save", "viewer.find", "viewer.copy")  # fmt: skip
"""Actions that ask the system or the window."""


def select_node(still: StillEditor) -> None:
    still.select("bloom")


def select_two(still: StillEditor) -> None:
    still.select("bloom", "vignette")


def choose_keys(still: StillEditor) -> None:
    still.editor.scope = "animation"
    still.editor.session.time.seek(20)
    still.editor.curves.choose(frozenset([(Port("bloom", "knee"), 12.0, 0)]))


def choose_points(still: StillEditor) -> None:
    session = still.editor.session
    session.apply(ReplaceGraph("Start", make_handled_graph("roto")))
    still.select("node")
    session.views.show(Port("node", "out"))
    still.show("Viewer", 2)
    still.compute()
    still.show("Viewer", 2)
    still.editor.actions.run("viewer.all_points")


STATES: dict[str, Callable[[StillEditor], None]] = {
    "a node": select_node, "two nodes": select_two, "keys": choose_keys, "points": choose_points,
}  # fmt: skip


@contextmanager
def open_state(folder: Path, name: str) -> Iterator[StillEditor]:
    shutil.rmtree(folder / "state", ignore_errors=True)
    with open_still_editor(folder, make_graph(), size=(900.0, 700.0)) as still:
        prepare(still)
        session = still.editor.session
        session.views.show(Port("outputs", "image"))
        session.views.show(Port("noise", "out"), "B")
        for title in ("Viewer", "Graph", "Animation"):
            still.show(title, 2)
        still.compute()
        STATES[name](still)
        still.show("Viewer", 2)
        yield still


def run(still: StillEditor, id: str) -> None:
    still.editor.actions.run(id)
    for title in ("Graph", "Animation", "Viewer"):
        still.show(title, 2)


def write(still: StillEditor) -> object:
    return json.loads(document.dumps(still.editor.session.root))


@pytest.mark.parametrize("name", STATES)
def test_edits_are_one_step_that_can_be_taken_back(tmp_path: Path, name: str) -> None:
    with open_state(tmp_path, name) as still:
        actions = still.editor.actions
        ids = [action.id for action in actions.all if actions.is_enabled(action) and not action.id.startswith(SYSTEM)]
        for id in ids:
            session = still.editor.session
            before, steps = write(still), session.history.position
            if id in ("edit.undo", "edit.redo"):
                continue
            run(still, id)
            after, count = write(still), session.history.position - steps
            assert (before != after) <= (count == 1) and count in (0, 1), id
            if count:
                session.undo()
                assert write(still) == before, f"{id} is not taken back"
                session.redo()
                assert write(still) == after, f"{id} is not done again"
                session.undo()
            still.editor.dialogs.close()
            still.editor.dialogs.open.clear()
            STATES[name](still) if name != "points" else None


CHANGED = "steps", "log", "canvas.center", "timeline.report", "preferences.ui_scale", "viewer.compare"
"""What may be otherwise afterwards: the view was fitted first, a scale was automatic, playing has reported."""


@pytest.mark.parametrize(("first", "second"), OPPOSITE)
def test_opposite_actions_cancel(tmp_path: Path, first: str, second: str) -> None:
    count = 0
    for name in STATES:
        with open_state(tmp_path, name) as still:
            still.editor.viewer.zoom = 1.0
            run(still, "viewer.actual")
            before = read_state(still)
            run(still, first)
            count += bool({*list_changes(before, read_state(still))} - {"steps", "log"})
            run(still, second)
            left = {way: new for way, new in list_changes(before, read_state(still)).items() if way not in CHANGED}
            assert not left, name
    assert count > 0


def test_keys_that_are_held_repeat_opposites_alike_and_never_a_switch(tmp_path: Path) -> None:
    """Who goes too far by holding a key goes back by holding another; files and dialogs are asked for once."""
    with open_state(tmp_path, "a node") as still:
        actions = {action.id: action for action in still.editor.actions.all}
    assert {"edit.undo", "edit.redo", "time.next", "viewer.darker", "viewer.smaller_brush"} <= {
        id for id, action in actions.items() if action.repeats
    }
    assert [pair for pair in OPPOSITE if len({actions[id].repeats for id in pair}) > 1] == []
    once = [id for id, action in actions.items() if action.checked or id.startswith(("file.", "help.", "view."))]
    assert len(once) > 50 and [id for id in once if actions[id].repeats] == []


def test_switches_are_on_where_they_say_so(tmp_path: Path) -> None:
    """One that can be switched off is as before the second time; of others, which exclude each other, one stays on."""
    with open_state(tmp_path, "a node") as still:
        ids = [action.id for action in still.editor.actions.all if action.checked and not action.id.startswith(SYSTEM)]
    kinds = set[bool]()
    for id in ids:
        with open_state(tmp_path, "a node") as still:
            actions = still.editor.actions
            if not actions.is_enabled(actions[id]):
                continue
            states, on = [read_state(still)], [actions.is_checked(actions[id])]
            for _ in range(2):
                run(still, id)
                states.append(read_state(still))
                on.append(actions.is_checked(actions[id]))
            changes = [{*list_changes(states[0], state)} - {*CHANGED} for state in states[1:]]
            if on[1] and on[2]:
                assert (changes[0] == changes[1] and bool(changes[0]) is not on[0]) or id == "viewer.compare", id
            else:
                assert on == [on[0], not on[0], on[0]] and not changes[1], id
            kinds.add(on[2])
    assert kinds == {True, False}
