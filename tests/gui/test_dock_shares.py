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
