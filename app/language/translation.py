"""Looks texts up in the catalogue of the chosen language. English is the code itself and loads nothing."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Protocol

from .system_language import find_system_language

LANGUAGES: Mapping[str, str] = MappingProxyType({"en": "English", "de": "Deutsch"})
"""The languages by their codes, each by its own name. All but English have a catalogue."""


class Texts(Protocol):
    """The texts of one language, as the classes of Python's gettext offer them."""

    def gettext(self, message: str, /) -> str: ...

    def pgettext(self, context: str, message: str, /) -> str: ...

    def ngettext(self, one: str, many: str, count: int, /) -> str: ...


class _Voice:
    """The chosen language of this process: one window has one language, and so have all threads."""

    def __init__(self) -> None:
        self.code, self.texts = "en", None
        self.texts: Texts | None


_VOICE = _Voice()


def translate(message: str, /, _context: str = "", **places: object) -> str:
    """A text in the chosen language, with `{name}` replaced by what `places` has under that name.

    `_context` tells two meanings of one English text apart, such as the `view` of a menu and that of a color config.
    """
    texts = _VOICE.texts
    if texts is not None and message:
        message = texts.pgettext(_context, message) if _context else texts.gettext(message)
    return message.format(**places) if places else message


def translate_plural(one: str, many: str, count: int, /, **places: object) -> str:
    """The text for this count of things; `{count}` stands for the count."""
    texts = _VOICE.texts
    text = (one if count == 1 else many) if texts is None else texts.ngettext(one, many, count)
    return text.format(count=count, **places)


def mark(message: str, _context: str = "") -> str:
    """The text itself, which the catalogue takes from here; who shows it translates it."""
    return message


def mark_plural(one: str, many: str) -> tuple[str, str]:
    """The texts for one and for many, which the catalogue takes from here, for `translate_plural`."""
    return one, many


def language() -> str:
    """The code of the chosen language."""
    return _VOICE.code


def use_language(code: str) -> None:
    """Choose the language of all texts from now on; "" is that of the system, one without a catalogue is English."""
    code = code or find_system_language(LANGUAGES)
    if code != _VOICE.code:
        use_texts(code, _load(code))


def use_texts(code: str, texts: Texts | None) -> None:
    """Choose texts under a name; None is English."""
    _VOICE.code, _VOICE.texts = code, texts


def _load(code: str) -> Texts | None:
    if code not in LANGUAGES or code == "en":
        return None
    from gettext import GNUTranslations

    with (Path(__file__).parent / "catalogue" / f"{code}.mo").open("rb") as catalogue:
        return GNUTranslations(catalogue)
