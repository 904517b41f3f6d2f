"""Keys, text and the mouse from the window system to the interface, so that no chord is lost at a low frame rate.

The interface library looks at its keyboard once a frame. When Ctrl+S is pressed and released between two frames, it
sees that S went down and that Ctrl is up: the chord is lost, and S runs as a shortcut of its own. The window system
sends the modifiers with every event, so this queue keeps each event with its modifiers and hands the events over in
their order. It ends a frame's share where the modifiers change after a press; the rest comes with the next frame.

While a text field is edited, what is typed arrives as characters alone, all of them in the next frame: the library
takes one key at a time, and text would trail behind the hand.

The mouse is one hand: it moves, then presses, then moves, then lets go. On a slow machine all of that comes between two
frames, and a widget that is pressed before a frame has found it under the pointer, or let go before a frame has seen it
dragged, misses its drag. So moves and each change of a button have frames of their own (`_Share`). Whether two clicks
are a double click is decided by when they were made, not by when their frames are drawn.

A key or a click may open a field that takes text, and the field has the focus only some frames later: the popup opens,
it asks for the focus, the focus arrives. What is typed in the meantime belongs to the field. So keys wait until a frame
has passed that changed nothing of what decides where they go (`_Focus`). No popup has to declare its field.
"""

from __future__ import annotations

import ctypes
import math
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cache, partial
from types import MappingProxyType
from typing import Any, Literal

from imgui_bundle import imgui
from msgspec import Struct

import glfw  # isort: skip


class InputEvent(Struct, frozen=True):
    """One event of the window system."""

    modifiers: frozenset[imgui.Key]
    """The modifiers that are held after the event."""
    presses: bool
    """Whether the event asks for something, which the modifiers decide on: a key or a button down, text, the wheel."""
    forward: Callable[[imgui.IO], object]
    """Tells the interface library of the event."""
    is_character: bool = False
    """Whether it is typed text, or a key that only serves to type it: in a text field the text says it all."""
    is_text: bool = False
    """Whether it is the typed text itself."""
    is_release: bool = False
    """Whether it only lets a key or a button go: the modifiers do not matter to it."""
    is_key: bool = False
    """Whether it goes to what has the focus: a key that went down, or text."""
    follows_key: bool = False
    """Whether it is the text of the key before it. Input methods send text without a key."""
    moves_focus: bool = False
    """Whether it may change what has the focus: a key that goes down, a button that goes down or up."""
    pointer: Literal["", "move", "button", "wheel"] = ""
    """What the mouse does, if it is the mouse."""
    since_press: float = math.inf
    """For a button that goes down, seconds since it went down before."""


class _Share(Struct):
    """What the interface gets in one frame."""

    has_pressed: bool = False
    """Whether an event asks for something by now, so that the modifiers must stay as they are."""
    pointer: Literal["", "move", "button", "wheel"] = ""
    """What the mouse does in this frame."""

    def takes(self, event: InputEvent) -> bool:
        """True if an event of the mouse, or a key, may follow what the mouse has done in this frame."""
        if not self.pointer:
            return True
        if event.pointer:
            return event.pointer == self.pointer != "button"
        return not (event.is_key and self.pointer == "move")  # the panel under the pointer gets the key

    def add(self, event: InputEvent) -> None:
        """Count an event in."""
        self.has_pressed |= event.presses
        self.pointer = event.pointer or self.pointer


class _Focus(Struct, frozen=True):
    """What decides where a key goes, and what is about to change that."""

    takes_text: bool
    will_take_text: bool
    active: int
    popups: tuple[int, ...]
    is_asked_for: bool
    next_active: int
    window: int
    window_count: int
    hovered_window: int
    """The panel under the mouse, whose shortcuts run."""

    @classmethod
    def read(cls) -> _Focus:
        """The focus after the last frame."""
        context = imgui.get_current_context()
        return cls(
            imgui.get_io().want_text_input,
            context.want_text_input_next_frame > 0,
            context.active_id,
            tuple(popup.popup_id for popup in context.open_popup_stack),
            context.nav_any_request,
            context.nav_next_activate_id,
            context.nav_window.id_ if context.nav_window is not None else 0,
            context.windows_active_count,
            context.hovered_window.id_ if context.hovered_window is not None else 0,
        )


PATIENCE = 20
"""Frames after which keys no longer wait for the focus. Opening the slowest dialog takes 5; a panel that asks for the
focus again and again must not swallow keys for ever."""

DOUBLE_CLICK = 0.3
"""Seconds within which two clicks are a double click: the default of the interface library."""

SINGLE_CLICK = 0.5
"""Seconds after which a click is surely a single one: the default of the interface library."""

FOREVER = 3600.0
"""Seconds, more than any frame takes."""


class InputQueue:
    """The events that the interface has not seen yet."""

    def __init__(self) -> None:
        self._events: deque[InputEvent] = deque()
        self._held: set[imgui.Key] = set()
        self._forwarded: frozenset[imgui.Key] = frozenset()
        self._awaits_text = False
        """Whether the next text is that of the key before it."""
        self._focus: _Focus | None = None
        self._may_move_focus = False
        """Whether the last frame got an event that may change the focus."""
        self._waited = 0
        self._is_text_used = False
        """Whether the latest key was used as a key: then its character is no text for a field that it opened."""
        self.has_forwarded = False
        """Whether the last frame got anything."""
        self._press_times: dict[int, float] = {}
        """When each button of the mouse went down last."""

    def __len__(self) -> int:
        return len(self._events)

    def connect(self, window: Any) -> None:
        """Take the events of a GLFW window in place of the interface library."""
        address = int(ctypes.cast(window, ctypes.c_void_p).value or 0)
        glfw.set_key_callback(window, lambda _, key, code, action, bits: self.add_key(key, code, action, bits))
        glfw.set_char_callback(window, lambda _, character: self.add_text(character))
        glfw.set_mouse_button_callback(window, lambda _, button, action, bits: self.add_button(button, action, bits))
        glfw.set_scroll_callback(window, lambda _, across, down: self.add_wheel(across, down))
        glfw.set_cursor_pos_callback(window, lambda _, x, y: self.add_position(address, x, y))
        glfw.set_cursor_enter_callback(window, lambda _, entered: self.add_entry(address, entered))

    def add_key(self, key: int, scancode: int, action: int, bits: int) -> None:
        """A key went down or up; repeats are the interface library's own."""
        self._awaits_text |= action in (glfw.PRESS, glfw.REPEAT) and key not in _modifier_keys()
        if action == glfw.REPEAT:
            return
        is_down = action == glfw.PRESS
        if key in _modifier_keys():
            # Whether an event of a modifier counts the modifier itself differs between systems: the key decides.
            (self._held.add if is_down else self._held.discard)(_modifier_keys()[key])
            modifiers = frozenset(self._held)
        else:
            modifiers = self._update_held(bits)
        name = _translate_key(key, scancode)
        presses = is_down and key not in _modifier_keys()
        is_shift = _modifier_keys().get(key) == imgui.Key.mod_shift
        types = is_shift or glfw.KEY_SPACE <= key <= glfw.KEY_WORLD_2
        is_character = types and (presses or is_shift) and modifiers <= {imgui.Key.mod_shift}
        self._events.append(
            InputEvent(
                modifiers,
                presses,
                lambda io: io.add_key_event(name, is_down),
                is_character=is_character,
                is_release=not is_down and key not in _modifier_keys(),
                is_key=presses,
                moves_focus=presses,
            )
        )

    def add_text(self, character: int) -> None:
        """A character was typed. It comes right behind its key, whose modifiers are its own."""
        self._events.append(
            InputEvent(
                self._latest,
                True,
                lambda io: io.add_input_character(character),
                is_character=True,
                is_text=True,
                is_key=True,
                follows_key=self._awaits_text,
            )
        )
        self._awaits_text = False

    def add_button(self, button: int, action: int, bits: int) -> None:
        """A button of the mouse went down or up."""
        if button >= int(imgui.MouseButton_.count):
            return
        is_down, since_press = action == glfw.PRESS, math.inf
        if is_down:
            now = time.monotonic()
            since_press = now - self._press_times.get(button, -math.inf)
            self._press_times[button] = now
        self._events.append(
            InputEvent(
                self._update_held(bits),
                is_down,
                lambda io: io.add_mouse_button_event(button, is_down),
                moves_focus=True,
                pointer="button",
                since_press=since_press,
            )
        )

    def add_wheel(self, across: float, down: float) -> None:
        """The wheel was turned."""
        self._events.append(
            InputEvent(self._latest, True, lambda io: io.add_mouse_wheel_event(across, down), pointer="wheel")
        )

    def add_position(self, window: int, x: float, y: float) -> None:
        """The mouse moved; the interface library knows which of its windows that concerns."""
        move = partial(imgui.backends.glfw_cursor_pos_callback, window, x, y)
        self._events.append(InputEvent(self._latest, False, lambda _: move(), pointer="move"))

    def add_entry(self, window: int, entered: int) -> None:
        """The mouse came into the window or left it; in its order, or the moves before it would bring it back."""
        enter = partial(imgui.backends.glfw_cursor_enter_callback, window, entered)
        self._events.append(InputEvent(self._latest, False, lambda _: enter(), pointer="move"))

    def forward(self) -> None:
        """Hand over a frame's share; to be called before the interface begins the frame.

        Events leave in their order: the first that has to wait ends the share. The essay of this module says which do.
        """
        self.has_forwarded = bool(self._events)
        io, share = imgui.get_io(), _Share()
        io.mouse_double_click_time, io.mouse_single_click_delay = DOUBLE_CLICK, SINGLE_CLICK
        is_settled = self._is_focus_settled()
        while self._events:
            event = self._events[0]
            if event.follows_key and self._is_text_used:
                self._events.popleft()
                continue
            if event.is_key and not is_settled:
                return
            if event.is_character and io.want_text_input:
                self._events.popleft()
                if event.is_text:
                    event.forward(io)
                self._is_text_used = False
                continue
            if not share.takes(event):
                return
            if event.modifiers != self._forwarded and not event.is_release:
                if share.has_pressed:
                    return
                for modifier in event.modifiers ^ self._forwarded:
                    io.add_key_event(modifier, modifier in event.modifiers)
                self._forwarded = event.modifiers
            if event.pointer == "button" and event.presses:
                _decide_double_click(io, event.since_press < DOUBLE_CLICK)
            self._events.popleft().forward(io)
            share.add(event)
            if event.is_key and not event.is_text:
                self._is_text_used = event.is_character
            if event.moves_focus:
                self._may_move_focus, is_settled = True, False

    def _is_focus_settled(self) -> bool:
        """True if the last frame neither changed where keys go nor got an event that may do so."""
        before, self._focus = self._focus, _Focus.read()
        has_arrived = not imgui.get_current_context().input_events_queue
        is_settled = has_arrived and not self._may_move_focus and before in (None, self._focus)
        self._may_move_focus = False
        self._waited = 0 if is_settled or not self._events else self._waited + 1
        return is_settled or self._waited > PATIENCE

    @property
    def _latest(self) -> frozenset[imgui.Key]:
        return frozenset(self._held)

    def _update_held(self, bits: int) -> frozenset[imgui.Key]:
        """Update the held modifiers from an event, which knows of a release over another window too."""
        self._held = {modifier for bit, modifier in _BITS.items() if bits & bit}
        return frozenset(self._held)


def _decide_double_click(io: imgui.IO, is_double: bool) -> None:
    """Let the next press be the second of a double click, or not, whenever the frame of the first one was drawn."""
    io.mouse_double_click_time = FOREVER if is_double else 0.0
    io.mouse_single_click_delay = max(SINGLE_CLICK, 2.0 * io.mouse_double_click_time)  # the library insists on more


_BITS: Mapping[int, imgui.Key] = MappingProxyType(
    {
        glfw.MOD_CONTROL: imgui.Key.mod_ctrl,
        glfw.MOD_SHIFT: imgui.Key.mod_shift,
        glfw.MOD_ALT: imgui.Key.mod_alt,
        glfw.MOD_SUPER: imgui.Key.mod_super,
    }
)
_SIGNS: Mapping[str, str] = MappingProxyType(
    {
        "`": "grave_accent",
        "-": "minus",
        "=": "equal",
        "[": "left_bracket",
        "]": "right_bracket",
        "\\": "backslash",
        ",": "comma",
        ";": "semicolon",
        "'": "apostrophe",
        ".": "period",
        "/": "slash",
    }
)


def _translate_key(key: int, scancode: int) -> imgui.Key:
    """The key by what the user's keyboard layout prints on it, as shortcuts are named, else by its place."""
    if not glfw.KEY_KP_0 <= key <= glfw.KEY_KP_EQUAL:
        label = None
        with suppress(glfw.GLFWError):
            label = glfw.get_key_name(key, scancode)
        if isinstance(label, bytes):
            label = label.decode("utf-8", "replace")
        if label and len(label) == 1 and label.isascii():
            name = f"_{label}" if label.isdigit() else _SIGNS.get(label, label.lower())
            if name in imgui.Key.__members__:
                return imgui.Key[name]
    return _keys_by_place().get(key, imgui.Key.none)


@cache
def _keys_by_place() -> Mapping[int, imgui.Key]:
    return MappingProxyType(dict(_pair_keys()))


def _pair_keys() -> Iterator[tuple[int, imgui.Key]]:
    """Each key of the window system with its key of the interface library: the two differ in how they spell names."""
    arrows = {"LEFT", "RIGHT", "UP", "DOWN"}
    for constant in (name for name in dir(glfw) if name.startswith("KEY_")):
        name = constant.removeprefix("KEY_")
        if name.isdigit():
            spelling = f"_{name}"
        elif name in arrows:
            spelling = f"{name.lower()}_arrow"
        elif name.startswith("KP_"):
            spelling = "keypad" + (name[3:] if name[3:].isdigit() else f"_{name[3:].lower()}")
        elif name.startswith("WORLD_"):
            spelling = "oem102"
        else:
            spelling = name.lower().replace("control", "ctrl")
        if spelling in imgui.Key.__members__ and spelling != "none":
            yield getattr(glfw, constant), imgui.Key[spelling]


@cache
def _modifier_keys() -> Mapping[int, imgui.Key]:
    """Both keys of each modifier."""
    return MappingProxyType(
        {
            getattr(glfw, f"KEY_{side}_{name}"): modifier
            for name, modifier in zip(("CONTROL", "SHIFT", "ALT", "SUPER"), _BITS.values(), strict=True)
            for side in ("LEFT", "RIGHT")
        }
    )
