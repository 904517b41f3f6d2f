"""Runs the editor on the display, as `halation edit` does, and writes where things are to a file.

`python tests/display_editor.py GRAPH REPORT`: REPORT gets, in JSON, the places of the last frame and what a test asks
for. Whoever moves the mouse from outside has to know where to move it.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from halation.editor.window.opening import run
from halation.editor.window.painting import measure_window
from halation.editor.window.window import Window
from halation.resources.atomic_write import write_text_atomically
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui


def main(graph: Path, report: Path, state: Path, *, tears_off: bool = False) -> None:
    """Open a graph until the window is closed."""
    window = Window(graph, {}, UNRESTRICTED, version=(4, 5), state=state, size=(1200, 700))
    window.params.ini_disable = True
    window.params.imgui_window_params.enable_viewports = tears_off
    before = window.params.callbacks.after_swap

    def write_report() -> None:  # when the frame is shown: an idle editor may not draw another one
        if before is not None:
            before()
        corner = imgui.get_main_viewport().pos
        places = {
            name: (left - corner.x, top - corner.y, right - corner.x, bottom - corner.y)
            for name, (left, top, right, bottom) in window.editor.places.items()
        }
        editor = window.editor
        facts = {
            "frame": window.frames,
            "places": places,
            "zoom": editor.viewer.zoom,
            "path": str(editor.session.path),
            "steps": list(editor.session.history.steps),
            "selection": [element.name for element in editor.session.selection],
            "size": measure_window(),
            "windows": imgui.get_platform_io().viewports.size(),
            "black": float((window.device.read_window(measure_window()) == 0).all(2).mean()),
            "sentences": [entry.sentence for entry in editor.log.entries],
        }
        write_text_atomically(report, json.dumps(facts), sandbox=UNRESTRICTED)

    window.params.callbacks.after_swap = write_report
    run(window)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:4]), tears_off=sys.argv[4:] == ["tears_off"])
