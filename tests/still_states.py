"""All that an act may change in a still editor, as plain texts, and acts of the mouse at a place."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

import msgspec
from halation import document
from imgui_bundle import imgui
from still_editor import StillEditor

LEFT_ALONE = (
    "button file.", "menu ", "cancel", "again", "play", "open folder", "menubar", "export write", "export start",
    "render",
)  # fmt: skip
"""Places whose clicks start programs or write files."""

UNSAID = ("find_pins", "sizes", "pace", "large_files", "reader", "snapshot", "panel", "picture", "pointer", "hovered",
          "pixel", "span", "recent_files", "folders", "free", "language", "layout", "window")  # fmt: skip
"""Parts of states that follow from what is drawn, or that belong to this machine."""

_SETTLED = 3
"""Frames after which nothing moves."""


def read_state(still: StillEditor) -> dict[str, str]:
    """All that an act may change, each by the way to it."""
    editor, session = still.editor, still.editor.session
    states: dict[str, Any] = {
        "document": json.loads(document.dumps(session.root)),
        "steps": session.history.steps,
        "selected": sorted(session.selection),
        "active": session.active,
        "place": "/".join(session.place),
        "views": {side: str(session.views.find_port(side)) for side in ("A", "B")},
        "frame": session.time.frame,
        "clipboard": imgui.get_clipboard_text(),
        "typing": imgui.get_io().want_text_input,
        "log": [entry.sentence for entry in editor.log.entries],
        "renders": [render.state for render in editor.exports.all],
        "viewer": editor.viewer, "canvas": editor.canvas, "animation": editor.curves, "code": editor.code,
        "timeline": editor.timeline, "dialogs": editor.dialogs, "preferences": editor.store.current,
        "scope": editor.scope,
    }  # fmt: skip
    return dict(_flatten(states, ""))


def list_changes(before: Mapping[str, str], after: Mapping[str, str]) -> dict[str, str | None]:
    """What is another, new, or gone (None)."""
    return {way: after.get(way) for way in before.keys() | after.keys() if before.get(way) != after.get(way)}


def act(still: StillEditor, title: str, place: str, kind: str) -> None:
    """Do something with the mouse at a place."""
    io, body = imgui.get_io(), lambda: still.show(title, 1)
    first, last = still.find_point(place, (0.3, 0.4)), still.find_point(place, (0.3, 0.4))
    last = last[0] + 23.0, last[1] + 11.0

    def press(is_down: bool, button: int = 0) -> None:
        io.add_mouse_button_event(button, is_down)
        body()

    still.pane.point(first)
    body()
    body()
    if kind == "rest":
        io.delta_time = 1.0
        body()
        io.delta_time = 1.0 / 60.0
    elif kind == "drag":
        press(True)
        for part in (0.5, 1.0):
            still.pane.point((first[0] + (last[0] - first[0]) * part, first[1] + (last[1] - first[1]) * part))
            body()
            body()
        press(False)
        still.pane.point((last[0] + 50.0, last[1] + 40.0))  # what was let go stays there
    elif kind == "turn":
        io.add_mouse_wheel_event(0.0, 1.0)
    else:
        for _ in range(2 if kind == "double-click" else 1):
            press(True, int(kind == "menu"))
            press(False, int(kind == "menu"))
    for _ in range(_SETTLED):
        body()


def _flatten(value: Any, way: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, msgspec.Struct):
        for name in value.__struct_fields__:
            if name not in UNSAID and not name.startswith("_"):
                yield from _flatten(getattr(value, name), f"{way}.{name}" if way else name)
    elif isinstance(value, Mapping):
        for name, part in value.items():
            yield from _flatten(part, f"{way}.{name}" if way else str(name))
    else:
        yield way, _spell(value)


def _spell(value: Any) -> str:
    """A value in few letters."""
    if value is None or isinstance(value, bool | int | str):
        return str(value).replace("\n", "/")
    if isinstance(value, float):
        return f"{value:.3g}"
    if isinstance(value, tuple | list):
        return f"({' '.join(_spell(part) for part in value)})"
    if isinstance(value, Mapping):
        return _spell([f"{name}: {_spell(part)}" for name, part in value.items()])
    if isinstance(value, set | frozenset):
        return _spell(sorted(_spell(part) for part in value))
    if isinstance(value, msgspec.Struct):
        return _spell(tuple(getattr(value, name) for name in value.__struct_fields__))
    return str(value) if type(value).__name__ in ("Port", "ElementId", "PosixPath") else type(value).__name__
