"""Someone who knows nothing of the editor and plays with it."""

from __future__ import annotations

import random

from gui_driver import Ui
from halation.editor.toolkit.keys import chord
from imgui_bundle import ImVec2

SIZE = (1400, 900)
"""Pixels of the window that is played with."""

KEYS = (
    "Tab",
    "Enter",
    "Escape",
    "Delete",
    "M",
    "H",
    "V",
    "Shift+V",
    "L",
    "F",
    "Home",
    "T",
    "Shift+T",
    "Ctrl+G",
    "Ctrl+Shift+G",
    "Ctrl+D",
    "Ctrl+C",
    "Ctrl+V",
    "Ctrl+X",
    "Ctrl+Z",
    "Ctrl+Shift+Z",
    "Ctrl+A",
    "W",
    "D",
    "R",
    "A",
    "Q",
    "I",
    "P",
    "1",
    "Ctrl+1",
    "Ctrl+P",
    "F1",
    "F2",
    "DownArrow",
    "UpArrow",
    "Shift+F",
    "Shift+C",
    "Shift+S",
    "Alt+X",
    "Alt+S",
    "Ctrl+Enter",
    "Ctrl+Backspace",
    "LeftBracket",
    "Shift+R",
    "Ctrl+S",
    "Ctrl+Comma",
    "O",
    "E",
)
"""Chords that are pressed."""

WORDS = ("blur", "0.5", "*2", "x", "bloom", "1+1", "-", "\u00c4")
"""What is typed."""


class Player:
    """Random acts, by a seed."""

    def __init__(self, ui: Ui, seed: int) -> None:
        self.ui, self.random = ui, random.Random(seed)

    def point(self) -> ImVec2:
        """Somewhere on the window, more often on something."""
        places = self.ui.editor.places
        if places and self.random.random() < 0.6:
            left, top, right, bottom = places[self.random.choice(sorted(places))]
            x, y = (left + right) / 2, (top + bottom) / 2
            if 0 < x < SIZE[0] and 0 < y < SIZE[1]:
                return ImVec2(x, y)
        return ImVec2(self.random.uniform(5, SIZE[0] - 5), self.random.uniform(5, SIZE[1] - 5))

    def act(self) -> None:
        """Do one thing."""
        ctx = self.ui.ctx
        kind = self.random.choice(("click", "click", "double", "drag", "drag", "wheel", "key", "key", "type"))
        if kind == "key":
            ctx.key_press(chord(self.random.choice(KEYS)))
        elif kind == "type":
            ctx.key_chars(self.random.choice(WORDS))
        else:
            ctx.mouse_move_to_pos(self.point())
            if kind == "click":
                ctx.mouse_click(self.random.choice((0, 0, 1)))
            elif kind == "double":
                ctx.mouse_double_click(0)
            elif kind == "wheel":
                ctx.mouse_wheel_y(self.random.choice((-2, -1, 1, 2)))
            else:
                self.drag()
        self.ui.editor.commands.closing = False
        ctx.yield_(1)

    def drag(self) -> None:
        """From here to somewhere."""
        ctx, button = self.ui.ctx, self.random.choice((0, 0, 1, 2))
        with self.ui.held(self.random.choice(("", "", "Ctrl", "Shift", "Alt"))):
            ctx.mouse_down(button)
            ctx.mouse_lift_drag_threshold(button)
            ctx.mouse_move_to_pos(self.point())
            ctx.yield_(1)
            ctx.mouse_up(button)
