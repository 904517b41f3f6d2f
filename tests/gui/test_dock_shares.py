"""Docks keep their share of the window when it shrinks."""

from __future__ import annotations

from halation import presets

import glfw  # isort: skip
from imgui_bundle import glfw_utils  # isort: skip


def test_the_viewer_keeps_a_share_of_a_small_window(gui) -> None:
    def body(ui) -> None:
        ui.settled()

        def measure() -> tuple[float, float]:
            left, top, right, bottom = ui.editor.places["Viewer"]
            return right - left, bottom - top

        across, down = measure()
        ui.ask(lambda: glfw.set_window_size(glfw_utils.glfw_window_hello_imgui(), 640, 400))
        ui.wait(10)
        small_across, small_down = measure()
        assert small_across > 0.8 * across * 640 / 1400
        assert small_down > 0.6 * down * 400 / 900  # bars keep their height

    gui(body, presets.paths()[0], size=(1400, 900))


def test_a_panel_fills_the_window_and_the_others_come_back(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        before = {title: ui.editor.places[title] for title in ("Viewer", "Graph", "Inspector")}
        for key, title in (("F11", "Viewer"), ("Shift+F11", "Graph")):
            ui.keys(key)
            ui.wait(10)
            left, _, right, _ = ui.editor.places[title]
            assert right - left > 1380 and "Inspector" not in ui.editor.places
            ui.keys(key)
            ui.wait(10)
            for name, corners in before.items():
                assert all(abs(a - b) <= 2 for a, b in zip(ui.editor.places[name], corners, strict=True)), name

    gui(body, presets.paths()[0], size=(1400, 900))
