"""Labels of widgets. The library takes a label for the identity of a widget too: here that depends on no language."""

from __future__ import annotations

from ...language.translation import translate


def make_label(text: str, id: str) -> str:
    """A label that shows `text`; the widget is `###id`, whatever the text is."""
    return f"{text}###{id}"


def translate_label(message: str, _context: str = "") -> str:
    """A label that shows a text in the chosen language, of a widget whose identity is the English text."""
    return make_label(translate(message, _context), message)
