"""Converts shortcuts between text, such as `Ctrl+Shift+S`, and key chords of the window library."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

from imgui_bundle import imgui

from ...errors import UsageError
from ...language.translation import mark, translate

_MODIFIERS: Mapping[str, int] = MappingProxyType(
    {
        "Ctrl": int(imgui.Key.mod_ctrl),
        "Shift": int(imgui.Key.mod_shift),
        "Alt": int(imgui.Key.mod_alt),
        "Super": int(imgui.Key.mod_super),
    }
)
_NAMES = MappingProxyType(
    {
        "Ctrl": mark("Ctrl", "key"),
        "Shift": mark("Shift", "key"),
        "Space": mark("Space", "key"),
        "Enter": mark("Enter", "key"),
        "Escape": mark("Escape", "key"),
        "Backspace": mark("Backspace", "key"),
        "Delete": mark("Delete", "key"),
        "Insert": mark("Insert", "key"),
        "Home": mark("Home", "key"),
        "End": mark("End", "key"),
        "Left": mark("Left", "key"),
        "Right": mark("Right", "key"),
        "Up": mark("Up", "key"),
        "Down": mark("Down", "key"),
        "Page Up": mark("Page Up", "key"),
        "Page Down": mark("Page Down", "key"),
    }
)
"""Keys that keyboards of other languages name otherwise."""

_SIGNS = MappingProxyType(
    {
        "Comma": ",",
        "Period": ".",
        "Slash": "/",
        "Backslash": "\\",
        "Minus": "-",
        "Equal": "=",
        "Semicolon": ";",
        "Apostrophe": "'",
        "LeftBracket": "[",
        "RightBracket": "]",
        "GraveAccent": "`",
        "LeftArrow": "Left",
        "RightArrow": "Right",
        "UpArrow": "Up",
        "DownArrow": "Down",
        "PageUp": "Page Up",
        "PageDown": "Page Down",
        "KeypadDecimal": "Num .",
    }
)


@cache
def chord(text: str) -> int:
    """The key chord that `text` names. Raises UsageError for an unknown key."""
    *modifiers, key = text.split("+")
    if key not in _keys() or not set(modifiers) <= _MODIFIERS.keys() or len(set(modifiers)) != len(modifiers):
        raise UsageError(translate("'{text}' is no shortcut; write it like 'Ctrl+Shift+S' or 'F5'", text=text))
    return _keys()[key] | sum(_MODIFIERS[name] for name in modifiers)


def text(chord: int) -> str:
    """The text of a chord, with its modifiers always in the same order, so that equal chords are equal texts."""
    modifiers = [name for name, bit in _MODIFIERS.items() if chord & bit]
    return "+".join([*modifiers, _names()[chord & ~sum(_MODIFIERS.values())]])


def display_shortcut(text: str) -> str:
    """A shortcut as shown to the user: `Ctrl+,` for `Ctrl+Comma`, and Cmd for Ctrl on macOS."""
    control = "Cmd" if sys.platform == "darwin" else "Ctrl"
    parts = (control if part == "Ctrl" else _SIGNS.get(part, part) for part in text.split("+"))
    return "+".join(translate(_NAMES[part], "key") if part in _NAMES else part for part in parts)


def is_enter_pressed(repeats: bool = True) -> bool:
    """True if Enter went down in this frame, on the keypad too; while it is held also again if it `repeats`."""
    return any(imgui.is_key_pressed(key, repeats) for key in (imgui.Key.enter, imgui.Key.keypad_enter))


def find_pressed_chord() -> str:
    """The chord whose key went down in this frame, "" if none did; Escape is never reported."""
    held = int(imgui.get_io().key_mods)
    for name, key in _keys().items():
        if name != "Escape" and imgui.is_key_pressed(imgui.Key(key), False):
            return text(key | held)
    return ""


@cache
def _keys() -> Mapping[str, int]:
    """Keys of the keyboard by name; modifiers alone are none."""
    names = list(imgui.Key.__members__)  # `dir` leaves out names that share a number
    not_keys = re.compile(r"^(mouse|gamepad|reserved|named|mod|none)|_(ctrl|shift|alt|super)$")
    plain = [name for name in names if not not_keys.search(name)]
    return MappingProxyType({_name_key(name): int(getattr(imgui.Key, name)) for name in plain})


@cache
def _names() -> Mapping[int, str]:
    return MappingProxyType({key: name for name, key in _keys().items()})


def _name_key(name: str) -> str:
    """`left_bracket` as LeftBracket, `_0` as 0."""
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))
