"""How results are shown, and what is wanted for that."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.authoring.commands import AddInput, AddNode
from halation.authoring.session import Session
from halation.color.display import to_display
from halation.editor.viewer.geometry import Sight
from halation.editor.viewer.looking import (
    choose_meaning,
    choose_range,
    choose_view,
    display_pixels,
    look_of,
    measures,
    picture_only,
)
from halation.editor.viewer.measuring import make_opaque_color
from halation.editor.viewer.picking import ports_of, title
from halation.editor.viewer.state import ViewerState
from halation.editor.viewer.wanted import list_wanted_ports
from halation.graph import Graph, Output, Port
from halation.inputs.provider import MediaProvider
from halation.nodes import Kind
from halation.renderer.viewing.look import Look
from halation.resources.sandbox import UNRESTRICTED

SIGHT = Sight((0.0, 0.0), (800, 400), (400, 200), zoom=2.0, pan=(3.0, 4.0))


def unread() -> np.ndarray:
    raise AssertionError("nothing needs to be read for this")


def test_kinds_decide_how_they_are_shown() -> None:
    state = ViewerState()
    up = np.full((4, 4, 3), (0.0, 1.0, 0.0))
    assert choose_meaning(state, Kind.IMAGE, unread) == "image"
    assert choose_meaning(state, Kind.FIELD, unread) == "field"
    assert choose_meaning(state, Kind.VECTOR, lambda: up) == "normal"
    assert choose_meaning(state, Kind.VECTOR, lambda: 3.0 * up) == "vector"
    state.meaning = "image"
    assert choose_meaning(state, Kind.VECTOR, unread) == "image"


def test_ranges_are_measured_unless_they_are_given() -> None:
    state = ViewerState()
    data = np.linspace(-1.0, 4.0, 1001).reshape(-1, 1, 1)
    low, high = choose_range(state, "field", lambda: data)
    assert (low, high) == pytest.approx((-1.0, 4.0), abs=0.03)
    low, high = choose_range(state, "vector", lambda: data)
    assert low == -high
    assert choose_range(state, "image", unread) == (0.0, 1.0)
    state.low, state.high = 2.0, 5.0
    assert choose_range(state, "field", unread) == (2.0, 5.0)


def test_an_output_asks_for_a_view_and_so_does_what_feeds_it() -> None:
    session = Session(sandbox=UNRESTRICTED)
    noise = session.apply(AddNode("noise"))
    graph = Graph().add(noise, session.graph.nodes[noise]).add_output("image", Output(view="none"))
    graph = graph.connect(Port(noise, "out"), Port("outputs", "image"))
    assert choose_view(graph, Port("outputs", "image")) == "none"
    assert choose_view(graph, Port(noise, "out")) == "none"
    assert choose_view(graph, Port(noise, "value")) == ""


def test_the_look_has_what_the_viewer_is_set_to() -> None:
    state = ViewerState(compare="toggle", toggled=True, background="white", region=(0.5, 0.25, 0.25, 0.75))
    look = look_of(state, SIGHT, "field", (2.0, 3.0), "none", (0.1, 0.1, 0.1))
    assert (look.zoom, look.pan, look.compare, look.view) == (2.0, (3.0, 4.0), "b", "none")
    assert (look.low, look.high, look.checker, look.background) == (2.0, 3.0, False, (1.0, 1.0, 1.0))
    assert look.region == (100.0, 50.0, 100.0, 100.0)
    state.view = "Raw"
    assert look_of(state, SIGHT, "image", (0.0, 1.0), "none", (0.1, 0.1, 0.1)).view == "Raw"
    saved = picture_only(look)
    assert (saved.zoom, saved.pan, saved.region, saved.compare) == (1.0, (0.0, 0.0), None, "b")


def test_what_scopes_measure_is_what_the_display_shows() -> None:
    pixels = np.random.default_rng(5).random((6, 5, 4)).astype(np.float32)
    pixels[..., 3] = 1.0
    exposed = pixels * np.float32([2.0, 2.0, 2.0, 1.0])
    expected = to_display(exposed, "none", bits=32)[..., :3].clip(0.0, 1.0)
    assert np.allclose(display_pixels(pixels, Look(exposure=1.0, view="none")), expected, atol=1e-6)
    assert np.allclose(display_pixels(pixels, Look(exposure=1.0, view="none", gamma=2.0)), expected**0.5, atol=1e-6)


def test_scopes_see_transparency_over_black_and_light_without_alpha_as_it_is() -> None:
    half = np.asarray([[[0.5, 0.5, 0.5, 0.5]]], np.float32)
    assert display_pixels(half, Look(view="none"))[0, 0] == pytest.approx([0.5] * 3, abs=1e-5)
    glow = np.asarray([[[1.0, 1.0, 1.0, 0.0]]], np.float32)
    assert display_pixels(glow, Look(view="none"))[0, 0] == pytest.approx([1.0] * 3, abs=1e-5)


def test_scopes_see_data_in_its_range() -> None:
    data = np.asarray([[[2.0], [3.0], [9.0]]], np.float32)
    assert display_pixels(data, Look(meaning="field", low=2.0, high=4.0))[0, :, 0].tolist() == [0.0, 0.5, 1.0]
    assert display_pixels(np.zeros((1, 1, 3), np.float32), Look(meaning="normal")).tolist() == [[[0.5] * 3]]


@pytest.fixture
def editor() -> Any:
    return SimpleNamespace(
        session=Session(sandbox=UNRESTRICTED),
        viewer=ViewerState(),
        interface=SimpleNamespace(dragging=False),
        preview=SimpleNamespace(
            renderer=SimpleNamespace(pictures=MediaProvider(sandbox=UNRESTRICTED)),
            memory=(0, 2**29),
            find_visible_image=lambda side: None,
        ),
        store=SimpleNamespace(current=SimpleNamespace(proxy_while_dragging=True)),
    )


def test_only_what_is_seen_is_wanted(editor: Any) -> None:
    session = editor.session
    assert list_wanted_ports(editor) == ({}, 1.0)
    noise, light = session.apply(AddNode("noise")), "beauty"
    session.apply(AddInput(light, "Image"))
    session.views.show(Port(noise, "value"))
    session.views.show(Port("inputs", light), "B")
    assert list_wanted_ports(editor) == ({"A": Port(noise, "value")}, 1.0)
    editor.viewer.compare, editor.viewer.proxy = "wipe", 0.5
    assert list_wanted_ports(editor) == ({"A": Port(noise, "value"), "B": Port("inputs", light)}, 0.5)
    editor.viewer.compare, editor.viewer.table = "off", True
    assert list_wanted_ports(editor)[0] == {"A": Port(noise, "value"), f"inputs.{light}": Port("inputs", light)}


def test_slow_pictures_are_wanted_coarser_while_dragging(editor: Any) -> None:
    list_wanted_ports(editor)
    editor.viewer.pace.took(1.0, 0.2)
    editor.interface.dragging = True
    assert list_wanted_ports(editor)[1] == 0.5
    editor.store.current.proxy_while_dragging = False
    assert list_wanted_ports(editor)[1] == 1.0


def test_everything_can_be_chosen_by_its_name(editor: Any) -> None:
    session = editor.session
    session.apply(AddInput("beauty", "Image"))
    noise = session.apply(AddNode("noise"))
    session.apply(AddNode("exposure", link=Port(noise, "out")))
    groups = {heading: [title(session.graph, port) for port in ports] for heading, ports in ports_of(session.graph)}
    assert groups["Nodes"] == ["exposure", "noise.out", "noise.value", "noise.vector"]
    assert groups["Inputs"] == ["beauty"]


def test_picked_colors_are_straight_and_opaque() -> None:
    assert make_opaque_color((0.2, 0.1, 0.4, 0.5)) == pytest.approx((0.4, 0.2, 0.8, 1.0))
    assert make_opaque_color((0.2, 0.1, 0.4, 0.0)) == pytest.approx((0.2, 0.1, 0.4, 1.0))
    assert make_opaque_color((0.3,)) == pytest.approx((0.3, 0.3, 0.3, 1.0))


@pytest.mark.parametrize(
    ("meaning", "kind", "range_", "needed"),
    [
        ("auto", Kind.IMAGE, (0.0, 0.0), False),
        ("auto", Kind.FIELD, (0.0, 0.0), True),
        ("auto", Kind.VECTOR, (0.0, 1.0), True),
        ("image", Kind.FIELD, (0.0, 0.0), False),
        ("normal", Kind.VECTOR, (0.0, 0.0), False),
        ("field", Kind.IMAGE, (0.0, 0.0), True),
        ("vector", Kind.VECTOR, (3.0, 3.0), True),
        ("field", Kind.FIELD, (0.0, 5.0), False),
        ("vector", Kind.VECTOR, (-1.0, 1.0), False),
    ],
)
def test_the_picture_is_measured_where_its_range_is_open(meaning, kind, range_, needed) -> None:
    """Shown as data without a range of the user, or with a meaning that its numbers decide."""
    assert measures(ViewerState(meaning=meaning, low=range_[0], high=range_[1]), kind) is needed
