"""A language that nobody speaks: each text of the catalogue with accents, 40 % longer, between brackets.

What it shows without brackets has been forgotten, and where a bracket is missing a text has been cut.
"""

from __future__ import annotations

import re
from functools import cache

from message_catalogue import list_messages

LONGER = 1.4
"""German words are that much longer than English ones: what holds these texts holds those of most languages."""

_LETTERS = str.maketrans(
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ",
    "àƀçđéƒĝħîĵķļɱñöþǫŕšţûṽŵẋýžÀƁÇĐÉƑĜĦÎĴĶĻṀÑÖÞǪŔŠŢÛṼŴẊÝŽ".replace("ɱ", "m").replace("ṽ", "v").replace("ẋ", "x"),
)
_PLACE = re.compile(r"(\{[^}]*\})")
"""Places that are filled in, and shortcuts that sentences name."""


def disguise(text: str) -> str:
    """A text in the language. Spaces at its ends stay outside of the brackets."""
    head, tail = text[: len(text) - len(text.lstrip())], text[len(text.rstrip()) :]
    inner = text.strip()
    parts = _PLACE.split(inner)
    words = "".join(part if _PLACE.fullmatch(part) else part.translate(_LETTERS) for part in parts)
    dots = "·" * max(round(len(inner) * LONGER) - len(inner) - 2, 0)
    return f"{head}«{words}{dots}»{tail}"


class PseudoTexts:
    """The language, as gettext offers one: texts that are not in the catalogue stay as they are."""

    def __init__(self) -> None:
        self._known = _list_known()

    def gettext(self, message: str, /) -> str:
        """The text of a message."""
        return self.pgettext("", message)

    def pgettext(self, context: str, message: str, /) -> str:
        """The text of a message with a context."""
        return disguise(message) if (context, message) in self._known else message

    def ngettext(self, one: str, many: str, count: int, /) -> str:
        """The text for a count."""
        return self.pgettext("", one) if count == 1 else disguise(many) if ("", one) in self._known else many


@cache
def _list_known() -> frozenset[tuple[str, str]]:
    return frozenset((message.context, message.forms[0]) for message in list_messages())
