"""Panels drawn once for all tests that look at them."""

from __future__ import annotations

import random
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from gui_screens import write_many_things
from still_editor import StillEditor, open_still_editor
from still_screens import Screens
from still_window import Drawing


def make_folder() -> Path:
    """A new folder whose path is as wide on every machine: it moves what is drawn beside it."""
    root = Path("/tmp" if sys.platform == "linux" else tempfile.gettempdir())
    while True:
        with suppress(FileExistsError):
            (folder := root / f"still{random.randrange(10**7, 10**8)}").mkdir()
            return folder


@pytest.fixture(scope="session")
def draw() -> Iterator[Callable[..., dict[str, Drawing]]]:
    folder = make_folder()
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

    yield draw
    shutil.rmtree(folder, ignore_errors=True)
