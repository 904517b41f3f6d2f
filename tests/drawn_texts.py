"""Notes every text that the editor draws, with whether it fits where it is drawn."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import pytest
from imgui_bundle import imgui

TEXTS = {
    "text": 0, "text_unformatted": 0, "text_disabled": 0, "text_wrapped": 0, "text_colored": 1, "separator_text": 0,
}  # fmt: skip
"""Functions that draw a text -> which argument it is."""

LABELS = (
    "button", "small_button", "checkbox", "radio_button", "selectable", "menu_item", "begin_menu", "tree_node",
    "tree_node_ex", "input_int",
)  # fmt: skip
"""Functions that draw a widget with a label, their first argument."""

MENUS = ("menu_item", "begin_menu")
"""These make their window as wide as they are."""

_SLACK = 1.5
"""Pixels by which a text may exceed its place: widths are rounded."""


@dataclass(frozen=True)
class DrawnText:
    """A text on the screen, and by how many pixels it is too wide for its place."""

    text: str
    excess: float
    by: str


class TextRecorder:
    """Takes the place of the functions that draw text, and calls them."""

    def __init__(self) -> None:
        self.texts: set[DrawnText] = set()

    def note(self, text: str, excess: float, by: str) -> None:
        """Note a text."""
        if text.strip():
            self.texts.add(DrawnText(text, excess if excess > _SLACK else 0.0, by))

    @contextmanager
    def record(self) -> Iterator[None]:
        """Record while the window draws."""
        with pytest.MonkeyPatch.context() as patch:
            for name, index in TEXTS.items():
                patch.setattr(imgui, name, self._wrap_text(name, getattr(imgui, name), index))
            for name in LABELS:
                patch.setattr(imgui, name, self._wrap_label(name, getattr(imgui, name)))
            for name in ("input_text_with_hint",):
                patch.setattr(imgui, name, self._wrap_hint(getattr(imgui, name)))
            patch.setattr(imgui, "begin_combo", self._wrap_combo(imgui.begin_combo))
            patch.setattr(imgui, "table_setup_column", self._wrap_column(imgui.table_setup_column))
            patch.setattr(imgui.ImDrawList, "add_text", self._wrap_add(imgui.ImDrawList.add_text))
            yield

    def _wrap_text(self, name: str, draw: Callable[..., Any], index: int) -> Callable[..., Any]:
        def drawn(*args: Any) -> Any:
            answer = draw(*args)
            wraps = name == "text_wrapped" or imgui.internal.get_current_window().dc.text_wrap_pos >= 0
            right = imgui.get_item_rect_max().x - imgui.internal.get_current_window().clip_rect.max.x
            self.note(args[index], 0.0 if wraps else right, name)
            return answer

        return drawn

    def _wrap_label(self, name: str, draw: Callable[..., Any]) -> Callable[..., Any]:
        def drawn(label: str, *args: Any, **options: Any) -> Any:
            answer = draw(label, *args, **options)
            shown = label.split("##")[0]
            room = imgui.get_item_rect_max().x - imgui.get_item_rect_min().x
            width, clip = imgui.calc_text_size(shown).x, imgui.internal.get_current_window().clip_rect
            excess = width - room if name == "button" else 0.0
            if name == "selectable":  # it is wider than its text by what lies between two entries
                excess = imgui.get_item_rect_min().x + width - clip.max.x
            elif name not in ("button", *MENUS):
                excess = imgui.get_item_rect_max().x - clip.max.x
            self.note(shown, excess, name)
            return answer

        return drawn

    def _wrap_hint(self, draw: Callable[..., Any]) -> Callable[..., Any]:
        def drawn(label: str, hint: str, text: str, *args: Any) -> Any:
            answer = draw(label, hint, text, *args)
            room = imgui.get_item_rect_max().x - imgui.get_item_rect_min().x - 2 * imgui.get_style().frame_padding.x
            self.note(hint if not text else "", imgui.calc_text_size(hint).x - room, "hint")
            return answer

        return drawn

    def _wrap_combo(self, draw: Callable[..., Any]) -> Callable[..., Any]:
        def drawn(label: str, current: str, *args: Any) -> Any:
            opened = draw(label, current, *args)
            room = imgui.get_item_rect_max().x - imgui.get_item_rect_min().x - 2 * imgui.get_style().frame_padding.x
            self.note(current, 0.0 if opened else imgui.calc_text_size(current).x - room, "combo")
            return opened

        return drawn

    def _wrap_column(self, draw: Callable[..., Any]) -> Callable[..., Any]:
        def drawn(label: str, *args: Any) -> Any:
            return draw(label, *args)

        return drawn

    def _wrap_add(self, draw: Callable[..., Any]) -> Callable[..., Any]:
        recorder = self

        def drawn(lines: imgui.ImDrawList, *args: Any, **options: Any) -> Any:
            text = next(arg for arg in args if isinstance(arg, str))
            recorder.note(text, 0.0, "add_text")
            return draw(lines, *args, **options)

        return drawn


_MARKED = re.compile("«[^«»]*»")


def find_plain_words(text: str) -> str:
    """What is left of a text without the parts between brackets."""
    before = ""
    while text != before:
        before, text = text, _MARKED.sub("", text)
    return text


def is_cut(text: str) -> bool:
    """True if a bracket is missing."""
    return bool(set("«»") & set(find_plain_words(text)))
