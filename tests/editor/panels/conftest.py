"""Panels drawn once for all tests that look at them."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from functools import cache
from typing import Any

import pytest
from gui_screens import write_many_things
from still_editor import StillEditor, open_still_editor
from still_screens import Screens
from still_window import Drawing


@pytest.fixture(scope="session")
def draw(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., dict[str, Drawing]]:
    folder = tmp_path_factory.mktemp("still")
    path = write_many_things(folder)

    @cache
    def draw(screens: Callable[[StillEditor], Screens], **options: Any) -> dict[str, Drawing]:
        """What each screen draws, on a screen with room for all that opens."""
        shutil.rmtree(folder / "state", ignore_errors=True)  # the files and folders that were opened last
        drawings = dict[str, Drawing]()
        with open_still_editor(folder, path, screen=(3000.0, 3000.0), **options) as still:
            for name, title in screens(still):
                still.show(title, 4)
                drawings[name] = still.pane.copy()
        return drawings

    return draw
