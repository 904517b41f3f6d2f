"""Displays with more dots per inch: everything is as many times as large, once."""

from __future__ import annotations

import pytest
from halation import presets
from imgui_bundle import imgui

SIZE = (760, 500)
"""Small enough to fit twice into the 1920x1080 that the window library gives a window without a display."""

PLACES = ("Viewer", "Graph", "Inspector", "Scopes", "Timeline", "viewer panel")


def measure(gui, **options) -> tuple[dict[str, tuple[float, ...]], float, float]:
    """Where panels are, the height of text, and the height of a row of the inspector."""
    measured = []

    def body(ui) -> None:
        ui.settled()
        window_places = {name: ui.editor.places[name] for name in PLACES}
        measured.append((window_places, imgui.get_font_size(), imgui.get_frame_height()))

    gui(body, presets.paths()[0], size=SIZE, **options)
    return measured[0]


@pytest.mark.parametrize("scale", [1.25, 1.5, 2.0])
def test_panels_text_and_rows_grow_by_the_scale_of_the_display(gui, scale) -> None:
    places, text, row = measure(gui)
    scaled_places, scaled_text, scaled_row = measure(gui, content_scale=scale)
    assert scaled_text == pytest.approx(text * scale)
    assert scaled_row == pytest.approx(row * scale, abs=1.0)
    for name, corners in places.items():
        # Each border between docks is rounded to whole pixels, and so are paddings.
        assert scaled_places[name] == pytest.approx([scale * at for at in corners], abs=2 + 4 * scale), name


def test_the_first_step_to_a_larger_interface_starts_at_the_scale_of_the_display(gui) -> None:
    def body(ui) -> None:
        ui.editor.actions.run("view.larger")
        ui.wait(2)
        assert imgui.get_font_size() == pytest.approx(16.0 * 1.75)
        assert ui.editor.store.current.ui_scale == 1.75

    gui(body, presets.paths()[0], size=SIZE, content_scale=1.5)
