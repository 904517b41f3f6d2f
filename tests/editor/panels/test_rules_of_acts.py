"""Rules that every act of the mouse keeps, whatever it is on: nothing here knows what a panel shows.

What changes the document is one step that says what it changed, and can be taken back. A button of an action does what
the action does, and its tip says what the table of actions says. Where the wheel is turned, the point under the pointer
stays.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from gui_renders import list_renders
from halation import document
from halation.authoring.commands import ReplaceGraph
from halation.graph import Port
from halation.nodes import catalogue
from imgui_bundle import imgui
from still_acts import make_graph as make_plain_graph
from still_acts import prepare
from still_editor import StillEditor, open_still_editor
from still_pictures import find_value, make_graph
from still_screens import describe_kind, list_typical_nodes
from still_states import LEFT_ALONE, act, list_changes, read_state

ACTS = "click", "double-click", "menu", "drag"

RULED = "ruler in", "ruler out", "ruler now"
"""Marks on the ruler that are as wide as a finger."""

SIZE = 900.0, 700.0


def show_output(still: StillEditor) -> None:
    still.editor.session.views.show(Port("outputs", "image"))
    still.show("Viewer", 2)
    still.compute()


def choose(id: str) -> Callable[[StillEditor], None]:
    def prepare(still: StillEditor) -> None:
        still.editor.session.apply(ReplaceGraph("Start", make_graph(id)))
        still.select("node")

    return prepare


def select(*names: str) -> Callable[[StillEditor], None]:
    return lambda still: still.select(*names)


def show_keys(mode: str) -> Callable[[StillEditor], None]:
    def prepare(still: StillEditor) -> None:
        curves = still.editor.curves
        curves.mode = mode  # pyright: ignore[reportAttributeAccessIssue]
        curves.choose(frozenset([(Port("bloom", "knee"), 12.0, 0)]))
        curves.fit()

    return prepare


def show_queue(still: StillEditor) -> None:
    still.editor.exports.all = list_renders()


STAGES: dict[str, tuple[str, Callable[[StillEditor], None]]] = {
    "Viewer": ("Viewer", show_output), "Graph": ("Graph", select("bloom")), "Timeline": ("Timeline", select()),
    "a node": ("Inspector", select("bloom")), "an output": ("Inspector", select("outputs.image")),
    "nothing": ("Inspector", select()), "two": ("Inspector", select("bloom", "vignette")),
    "key sheet": ("Animation", show_keys("sheet")), "key curves": ("Animation", show_keys("curves")),
    "History": ("History", select()), "Scopes": ("Scopes", show_output), "Renders": ("Renders", show_queue),
} | {node.id: ("Inspector", choose(node.id)) for node in list_typical_nodes()}  # fmt: skip


@contextmanager
def open_stage(folder: Path, name: str) -> Iterator[StillEditor]:
    title, show = STAGES[name]
    shutil.rmtree(folder / "state", ignore_errors=True)
    with open_still_editor(folder, make_plain_graph(), size=SIZE) as still:
        prepare(still)
        show(still)
        still.show(title)
        yield still


def list_places(still: StillEditor, name: str) -> list[str]:
    """A place of every kind."""
    seen, places = set[object](), list[str]()
    for place in sorted(still.places):
        words = place.split()
        kind: object = place if words[0] in ("button", "fold") else words[0]
        if words[0] in ("field", "name", "key") and (value := find_value(still.editor.session.graph, words[-1])):
            kind = words[0], describe_kind(value)
        if name in catalogue() and words[0] not in ("field", "wheel", "on", "item"):
            continue  # the same on every node
        if kind not in seen and not place.startswith(LEFT_ALONE) and place != STAGES[name][0]:
            seen.add(kind)
            places.append(place)
    return places


def write(still: StillEditor) -> dict[str, object]:
    return json.loads(document.dumps(still.editor.session.root))


@pytest.mark.parametrize("name", STAGES)
def test_what_changes_the_document_is_one_step_that_can_be_taken_back(tmp_path: Path, name: str) -> None:
    """And moving the pointer afterwards changes nothing."""
    title = STAGES[name][0]
    with open_stage(tmp_path, name) as still:
        places = list_places(still, name)
    for place in places:
        for kind in ACTS if name not in catalogue() else ("click", "drag"):
            with open_stage(tmp_path, name) as still:
                session = still.editor.session
                before, steps = write(still), session.history.position
                act(still, title, place, kind)
                after, count = write(still), session.history.position - steps
                if place.startswith("history"):
                    continue
                assert (before != after) <= (count > 0), f"{kind} {place}: changed without a step"
                assert count <= 2 if kind == "double-click" else count <= 1, f"{kind} {place}: {count} steps"
                still.pane.point((5.0, 5.0))
                still.show(title, 2)
                assert write(still) == after, f"{kind} {place}: goes on without the button"
                for _ in range(count):
                    session.undo()
                assert write(still) == before, f"{kind} {place}: is not taken back"


@pytest.mark.parametrize("name", ["Viewer", "Timeline", "a node", "key sheet", "key curves", "Scopes"])
def test_a_button_does_what_its_action_does_and_says_so(tmp_path: Path, name: str) -> None:
    title, count = STAGES[name][0], 0
    with open_stage(tmp_path, name) as still:
        actions = {action.id: action for action in still.editor.actions.all}
        buttons = [place for place in sorted(still.places) if place.removeprefix("button ") in actions]
    for place in buttons:
        action, changes = actions[place.removeprefix("button ")], list[dict[str, str | None]]()
        for is_mouse in (True, False):
            with open_stage(tmp_path, name) as still:
                before = read_state(still)
                if is_mouse:
                    act(still, title, place, "click")
                else:
                    still.pane.point((5.0, 5.0))
                    still.editor.actions.run(action.id)
                    still.show(title, 3)
                changes.append(list_changes(before, read_state(still)))
        assert changes[0] == changes[1], place
        with open_stage(tmp_path, name) as still:
            act(still, title, place, "rest")
            words, keys = still.pane.list_texts(), still.editor.actions.shortcut(action.id)
        tip = next((word for word in words if word.startswith(action.label.removesuffix("..."))), "")
        assert tip and action.doc in tip and ("(" in tip.split("\n")[0]) == bool(keys), place
        count += 1
    assert count > 2 or name in ("a node", "Scopes")


TURNED = {
    "Viewer": ("viewer panel", "viewer image", (0, 1)), "Graph": ("", "node ", (0, 1)),
    "Timeline": ("ruler", "ruler ", (0,)),
    "key sheet": ("keys area", "key ", (0,)), "key curves": ("keys area", "key ", (0,)),
}  # fmt: skip
"""Stages -> where the wheel is turned, what then goes away from the pointer, and along which axes."""


@pytest.mark.parametrize("name", TURNED)
@pytest.mark.parametrize("part", [(0.5, 0.5), (0.3, 0.6)])
def test_the_wheel_leaves_the_point_under_the_pointer_where_it_is(tmp_path: Path, name: str, part) -> None:
    """All that is drawn goes away from it by the same factor, and comes back when the wheel is turned back."""
    title, (surface, moved, axes) = STAGES[name][0], TURNED[name]
    with open_stage(tmp_path, name) as still:
        still.show(title, 4)
        pane = (*still.pane.at, still.pane.at[0] + SIZE[0], still.pane.at[1] + SIZE[1])
        box = still.places.get(surface, pane)
        at = box[0] + (box[2] - box[0]) * part[0], box[1] + (box[3] - box[1]) * part[1]
        still.pane.point(at)
        still.show(title, 3)
        before = dict(still.places)
        for steps in (1.0, -1.0):
            imgui.get_io().add_mouse_wheel_event(0.0, steps)
            still.show(title, 4)
            factors = [
                (still.places[place][axis] - at[axis]) / (before[place][axis] - at[axis])
                for place in before.keys() & still.places.keys()
                if place.startswith(moved) and place not in RULED
                for axis in axes
                if abs(before[place][axis] - at[axis]) > 40.0
            ]
            assert max(factors) - min(factors) < 0.03
            assert min(factors) > 1.02 if steps > 0.0 else abs(factors[0] - 1.0) < 0.03
