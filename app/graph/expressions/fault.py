"""The error of an expression, which points at a character."""

from __future__ import annotations

from ...errors import GraphError

_SHOWN = 60
"""Characters of a long expression that a message shows."""


class ExpressionError(GraphError):
    """An expression cannot be parsed, or has no value at a frame. `position` is the index of the character in `text`.

    The message is the sentence, the line, and a caret below the character.
    """

    def __init__(self, text: str, position: int, sentence: str) -> None:
        self.text, self.position, self.sentence = text, position, sentence
        super().__init__(f"{sentence}\n{_draw_caret(text, position)}" if text.strip() else sentence)

    def __reduce__(self) -> tuple[type[ExpressionError], tuple[str, int, str]]:
        return ExpressionError, (self.text, self.position, self.sentence)


def _draw_caret(text: str, position: int) -> str:
    """The part of the line around a position, with a caret below."""
    start = text.rfind("\n", 0, position) + 1
    end = text.find("\n", position)
    end = len(text) if end < 0 else end
    first = max(start, position - _SHOWN // 2) if end - start > _SHOWN else start
    last = min(end, first + _SHOWN)
    head = "…" if first > start else ""
    tail = "…" if last < end else ""
    before = head + _replace_unprintable(text[first:position])
    return f"    {before}{_replace_unprintable(text[position:last])}{tail}\n    {' ' * _count_columns(before)}^"


def _replace_unprintable(text: str) -> str:
    return "".join(letter if letter.isprintable() else " " for letter in text)


def _count_columns(text: str) -> int:
    """The number of columns of a text in a terminal (Unicode Standard Annex 11)."""
    import unicodedata

    return sum(
        0 if unicodedata.combining(letter) else 2 if unicodedata.east_asian_width(letter) in "WF" else 1
        for letter in text
    )
