"""How the editor looks: every panel and dialog in both themes, at two sizes of the interface and in a small window.

    HALATION_SHOTS=folder python -m pytest tests/gui/test_screens.py    keeps a picture of every screen
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from gui_screens import SCREENS, made

ALL = bool(os.environ.get("HALATION_SHOTS"))
LOOKS = (("dark", 1.0, (1600, 1000)), ("light", 2.0, (1900, 1060)), ("light", 1.0, (1024, 700)),
         ("dark", 2.0, (1900, 1060)))


@pytest.mark.parametrize(("index", "look"), list(enumerate(LOOKS)), ids=lambda one: str(one))
def test_screens(gui, tmp_path: Path, index: int, look) -> None:
    theme, scale, size = look
    chosen = SCREENS if ALL else SCREENS[index :: len(LOOKS)]

    def body(ui) -> None:
        ui.settled()
        for screen in chosen:
            for name in screen(ui):
                print(name)
                ui.shot(f"{theme}_{scale:g}_{size[0]}/{name}.png")
                assert ui.editor.faults.keys() <= {"Nowhere"}, ui.editor.faults

    gui(body, made(tmp_path), size=size, likes={"theme": theme, "ui_scale": scale})
