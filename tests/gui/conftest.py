"""`gui(body, path)` opens the real editor without a display, calls `body(ui)` beside it, and closes it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from gui_driver import CANVAS, drive
from halation.compiler.lowering import pictures
from halation.editor.window.window import Window

Gui = Callable[..., Window]


@pytest.fixture
def gui(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Gui:
    """Takes the arguments of `gui_driver.drive` but the folder; what an editor remembers is kept between calls."""
    monkeypatch.setenv("HALATION_STATE", str(tmp_path / "state"))
    monkeypatch.setattr(pictures, "DEFAULT_CANVAS", CANVAS)

    return lambda body, path=None, **options: drive(body, tmp_path, path, **options)
