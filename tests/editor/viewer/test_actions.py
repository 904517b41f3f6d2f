"""What each action of the viewer does to its state, and when it is offered and ticked."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.commands import AssignViewer
from halation.editor.viewer.actions import VIEWER
from halation.editor.viewer.state import BACKGROUNDS, PROXIES, SCOPES, ViewerState
from halation.graph import Port

ACTIONS = {action.id: action for action in VIEWER}
FIRST, SECOND = Port("blur", "out"), Port("grade", "out")


@pytest.fixture
def context() -> Any:
    shown: dict[str, Port] = {}
    views = SimpleNamespace(
        find_port=shown.get, show=lambda port, side: shown.update({side: port}), numbered_ports={3: FIRST},
        recall=lambda number: shown.update(A=views.numbered_ports[number]),
    )  # fmt: skip
    applied: list[Any] = []
    session = SimpleNamespace(views=views, apply=applied.append)
    return SimpleNamespace(viewer=ViewerState(), session=session, shown=shown, applied=applied)


def run(context: Any, id: str) -> ViewerState:
    ACTIONS[id].run(context)
    return context.viewer


def is_ticked(context: Any, id: str) -> bool:
    checked = ACTIONS[id].checked
    assert checked is not None
    return checked(context)


@pytest.mark.parametrize(
    ("id", "name"),
    [
        ("unsqueeze", "unsqueezes"), ("overscan", "overscan"), ("pause", "paused"), ("clipping", "warn_clipping"),
        ("nonfinite", "warn_nonfinite"), ("table", "table"),
    ],
)  # fmt: skip
def test_switches_go_both_ways_and_are_ticked(context: Any, id: str, name: str) -> None:
    before = getattr(context.viewer, name)
    for expected in (not before, before):
        assert getattr(run(context, f"viewer.{id}"), name) is expected
        assert is_ticked(context, f"viewer.{id}") is expected


CHOICES = (
    tuple(f"viewer.background.{name}" for name in BACKGROUNDS),
    ("viewer.proxy.1", "viewer.proxy.2", "viewer.proxy.4", "viewer.proxy.8"),
    ("viewer.red", "viewer.alpha", "viewer.false_color", "viewer.luminance"),
    ("viewer.wipe", "viewer.beside", "viewer.difference", "viewer.toggle"),
)


@pytest.mark.parametrize("names", CHOICES)
def test_of_choices_one_is_ticked(context: Any, names: tuple[str, ...]) -> None:
    for chosen in names[1:]:
        run(context, chosen)
        assert [name for name in names if is_ticked(context, name)] == [chosen]


def test_proxies_are_the_scale_of_their_name(context: Any) -> None:
    for scale in PROXIES:
        action = ACTIONS[f"viewer.proxy.{round(1 / scale)}"]
        action.run(context)
        assert context.viewer.proxy == scale and action.label == f"1/{round(1 / scale)}"


def test_zoom_and_place(context: Any) -> None:
    assert is_ticked(context, "viewer.fit") and not is_ticked(context, "viewer.actual")
    context.viewer.pan = (3.0, 4.0)
    assert run(context, "viewer.actual").zoom == 1.0 and context.viewer.pan == (0.0, 0.0)
    assert is_ticked(context, "viewer.actual") and not is_ticked(context, "viewer.fit")
    assert run(context, "viewer.fit").zoom == 0.0
    assert run(context, "viewer.nearer").nearer == 2.0
    for _ in range(2):
        run(context, "viewer.farther")
    assert context.viewer.nearer == 0.5


@pytest.mark.parametrize(("way", "sign"), [("left", (1, 0)), ("right", (-1, 0)), ("up", (0, 1)), ("down", (0, -1))])
def test_looking_to_a_side_moves_the_picture_to_the_other(context: Any, way: str, sign: tuple[int, int]) -> None:
    run(context, f"viewer.look_{way}")
    first = context.viewer.shift
    run(context, f"viewer.look_{way}")
    assert context.viewer.shift == (2.0 * first[0], 2.0 * first[1]) == (0.25 * sign[0], 0.25 * sign[1])
    assert ACTIONS[f"viewer.look_{way}"].repeats


def test_exposure_goes_by_half_stops(context: Any) -> None:
    neutral = ACTIONS["viewer.neutral"]
    assert not neutral.enabled(context)
    for _ in range(3):
        run(context, "viewer.brighter")
    assert context.viewer.exposure == 1.5 and neutral.enabled(context)
    for _ in range(4):
        run(context, "viewer.darker")
    assert context.viewer.exposure == -0.5
    context.viewer.gamma = 2.2
    assert (run(context, "viewer.neutral").exposure, context.viewer.gamma) == (0.0, 1.0)
    context.viewer.gamma = 0.5
    assert neutral.enabled(context)


def test_a_and_b_are_toggled_and_swapped(context: Any) -> None:
    context.viewer.toggled = False
    assert run(context, "viewer.other").toggled and context.viewer.compare == "toggle", "B comes first"
    assert not run(context, "viewer.other").toggled and run(context, "viewer.other").toggled
    assert not ACTIONS["viewer.swap"].enabled(context)
    run(context, "viewer.swap")
    assert not context.shown
    context.shown["A"] = FIRST
    assert not ACTIONS["viewer.swap"].enabled(context)
    run(context, "viewer.swap")
    assert context.shown == {"A": FIRST}
    context.shown["B"] = SECOND
    assert ACTIONS["viewer.swap"].enabled(context)
    run(context, "viewer.swap")
    assert context.shown == {"A": SECOND, "B": FIRST}


def test_a_region_is_drawn_and_removed(context: Any) -> None:
    assert not is_ticked(context, "viewer.region")
    assert run(context, "viewer.region").drawing_region and is_ticked(context, "viewer.region")
    assert not run(context, "viewer.region").drawing_region
    context.viewer.region = (0.0, 0.0, 0.5, 0.5)
    assert is_ticked(context, "viewer.region")
    assert run(context, "viewer.region").region is None and not context.viewer.drawing_region


@pytest.mark.parametrize("name", SCOPES)
def test_scopes_come_and_go(context: Any, name: str) -> None:
    before = {*context.viewer.scopes}
    assert run(context, f"scopes.{name}").scopes == before ^ {name}
    assert is_ticked(context, f"scopes.{name}") is (name not in before)
    assert run(context, f"scopes.{name}").scopes == before


def test_bookmarks_are_recalled_and_assigned(context: Any) -> None:
    assert ACTIONS["viewer.recall.3"].enabled(context) and not ACTIONS["viewer.recall.4"].enabled(context)
    assert not ACTIONS["viewer.assign.4"].enabled(context)
    run(context, "viewer.recall.3")
    assert context.shown == {"A": FIRST} and ACTIONS["viewer.assign.4"].enabled(context)
    run(context, "viewer.assign.4")
    assert context.applied == [AssignViewer(4)]
    recalls = [action for action in VIEWER if action.id.startswith("viewer.recall.")]
    assert [action.shortcut for action in recalls] == [*"123456789"]


@pytest.mark.parametrize(("id", "name"), [("find_nonfinite", "finding"), ("copy", "copying"), ("save", "saving")])
def test_what_needs_a_picture_is_offered_with_one(context: Any, id: str, name: str) -> None:
    action = ACTIONS[f"viewer.{id}"]
    assert not action.enabled(context)
    context.shown["A"] = FIRST
    assert action.enabled(context) and getattr(run(context, f"viewer.{id}"), name) is True


def test_markers_are_cleared(context: Any) -> None:
    clear = ACTIONS["viewer.clear_markers"]
    assert not clear.enabled(context)
    context.viewer.markers = ((0.5, 0.5),)
    assert clear.enabled(context)
    context.viewer.measured = (0.0, 0.0, 1.0, 1.0)
    run(context, "viewer.clear_markers")
    assert context.viewer.markers == () and context.viewer.measured is None and not clear.enabled(context)
    context.viewer.measured = (0.0, 0.0, 1.0, 1.0)
    assert clear.enabled(context)


def test_the_shape_of_pixels_is_offered_where_they_are_not_square(context: Any) -> None:
    assert not ACTIONS["viewer.unsqueeze"].enabled(context)
    context.viewer.pixel_aspect = 2.0
    assert ACTIONS["viewer.unsqueeze"].enabled(context)
