"""The window itself: which panels are open, and pictures of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from gui_driver import headless
from halation import presets
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.window.layouts import find_panel
from halation.editor.window.opening import keep_layout, run
from halation.editor.window.window import Window


def visit(folder: Path, act: Callable[[Window], object]) -> None:
    """Open the window as the command does, act on it in its tenth frame, and close it some frames later."""
    window = headless(folder)
    keep_layout(window.params, folder / "state")
    before = window.params.callbacks.post_new_frame

    def frame() -> None:
        before()
        if window.frames == 10:
            act(window)
        if window.frames == 20:
            window.editor.commands.closing = True

    window.params.callbacks.post_new_frame = frame
    run(window)


def test_which_panels_are_open_is_remembered(tmp_path) -> None:
    seen = []

    def panel(window: Window):
        return find_panel(window.params, PanelTitle.HISTORY)

    visit(tmp_path, lambda window: seen.append(panel(window).is_visible) or setattr(panel(window), "is_visible", False))
    visit(
        tmp_path,
        lambda window: seen.append(panel(window).is_visible) or window.editor.commands.apply_layout("composite"),
    )
    visit(tmp_path, lambda window: seen.append(panel(window).is_visible))
    assert seen == [True, False, True]
    assert (tmp_path / "state" / "layout.ini").exists()


def test_a_screenshot_is_what_is_seen(gui, tmp_path) -> None:
    def body(ui) -> None:
        ui.settled()
        seen = ui.pixels()
        ui.editor.actions.run("view.screenshot")
        ui.until(lambda: ui.editor.dialogs.browse is not None)
        ui.editor.dialogs.browse.then(tmp_path / "window.png")
        saved = oiio.ImageBuf(str(tmp_path / "window.png")).get_pixels(oiio.UINT8)[..., :3]
        assert saved.shape == seen.shape
        # The mouse pointer that the tests draw is in one of them only.
        assert np.mean(np.any(saved != seen, axis=2)) < 0.01

    gui(body, presets.paths()[0])
