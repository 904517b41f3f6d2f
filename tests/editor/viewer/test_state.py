"""A viewer begins with the picture as it is, and what is switched on twice is off."""

from __future__ import annotations

import pytest
from halation.editor.viewer.state import CHANNELS, ViewerState


def test_it_begins_with_the_picture_as_it_is() -> None:
    """Brightness, channels, view and size as they are, whole, nothing beside it; only what is broken is marked."""
    state = ViewerState()
    assert (state.exposure, state.gamma, state.channels, state.proxy, state.zoom) == (0.0, 1.0, "color", 1.0, 0.0)
    assert (state.display, state.view, state.look, state.meaning) == ("", "", "", "auto")
    assert not state.compares and not state.toggled and state.region is None and state.pan == (0.0, 0.0)
    assert state.warn_nonfinite and not state.warn_clipping
    assert not (state.paused or state.finding or state.saving or state.copying or state.table or state.drawing_region)
    assert state.has_gizmos and not state.orbits and not state.picking
    assert state.wipe == (0.5, 0.5) and state.wipe_angle == 0.0 and state.low == state.high
    assert state.scopes == {"histogram", "waveform"} and state.scopes is not ViewerState().scopes


@pytest.mark.parametrize("channels", CHANNELS[1:])
def test_channels_that_are_asked_for_twice_are_all(channels) -> None:
    state = ViewerState()
    state.show(channels)
    assert state.channels == channels
    state.show("alpha" if channels != "alpha" else "red")
    state.show(channels)
    assert state.channels == channels
    state.show(channels)
    assert state.channels == "color"


def test_a_comparison_that_is_asked_for_twice_ends() -> None:
    state = ViewerState()
    for mode in ("wipe", "difference"):
        state.toggle_comparison(mode)
        assert state.compare == mode and state.compares
    state.toggle_comparison("difference")
    assert state.compare == "off" and not state.compares


@pytest.mark.parametrize(
    ("orbiting", "scene", "orbits"), [(True, "city", True), (True, "", False), (False, "city", False)]
)
def test_only_a_scene_is_orbited(orbiting, scene, orbits) -> None:
    assert ViewerState(orbiting=orbiting, scene=scene).orbits is orbits


def test_it_fits_from_anywhere() -> None:
    state = ViewerState(zoom=3.0, pan=(20.0, -5.0))
    state.fit()
    assert (state.zoom, state.pan) == (0.0, (0.0, 0.0))


@pytest.mark.parametrize(
    ("before", "count", "during"),
    [("wipe", 1, "off"), ("wipe", 2, "wipe"), ("off", 2, "beside"), ("off", 1, "off")],
)
def test_a_flipbook_compares_what_it_has_and_leaves_no_trace(before, count, during) -> None:
    state = ViewerState(compare=before, zoom=2.0)
    state.begin_flipbook(count, again=False)
    assert state.compare == during and state.zoom == 0.0
    state.begin_flipbook(3 - count, again=True)  # another one in its place
    state.end_flipbook()
    assert state.compare == before
