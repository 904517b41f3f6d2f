"""Explains faults of a text that is not JSON, in the words of its author.

Python's parser reports where it gave up: for a missing comma on the next line, for an extra comma at the bracket after
it. The author has to change what stands before, so that is reported, with its line.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from types import MappingProxyType

_PYTHON_WORDS: Mapping[str, str] = MappingProxyType(
    {"True": "true", "False": "false", "None": "null", "nan": "null", "inf": "null", "undefined": "null"}
)
_WORD = re.compile(r"[\w$]+")


def explain_syntax(text: str, error: json.JSONDecodeError) -> tuple[str, int]:
    """One clause that says what to change, and the offset in `text` that it is about."""
    position = error.pos
    before = len(text[:position].rstrip()) - 1
    last, following = text[before : before + 1] if before >= 0 else "", text[position:].lstrip()
    position = len(text) - len(following)
    reason = error.msg.removesuffix(" at")
    if reason.startswith("Illegal trailing comma") or (last == "," and following[:1] in ("}", "]")):
        # From Python 3.13 on the error stands at the comma itself, before that at the bracket behind it.
        comma = text.rfind(",", 0, position + 1)
        return f"there is a comma too many before the '{text[comma + 1 :].lstrip()[:1]}'", comma
    if not following and not reason.startswith(("Unterminated", "Invalid")):
        return "the text ends too early: a bracket or a value is missing at its end", max(before, 0)
    if following.startswith(("//", "/*", "#")):
        return "JSON has no comments: remove this one; the editor keeps notes in frames and comments", position
    if following.startswith("'"):
        return "write names and strings in double quotes", position
    if reason == "Expecting ',' delimiter":
        return f"a comma or a closing bracket is missing after {_quote_end(text, before)}", before
    if reason == "Expecting ':' delimiter":
        return f"a colon is missing after the name {_quote_end(text, before)}", before
    word = match[0] if (match := _WORD.match(following)) else ""
    if reason.startswith("Expecting property name"):
        return f"the name {word} needs double quotes" if word else "a name in double quotes is missing here", position
    if reason == "Expecting value":
        if word in _PYTHON_WORDS:
            return f"write {_PYTHON_WORDS[word]} instead of {word}", position
        return (f"{word} is no value; a text needs double quotes" if word else "a value is missing here"), position
    if reason.startswith("Unterminated string") or reason == "Invalid control character":
        return "the closing quote of a string is missing", error.pos
    if reason.startswith("Invalid \\"):
        return "write a backslash in a string twice", error.pos
    if reason == "Extra data":
        return "more text follows the end of the graph", position
    return reason[:1].lower() + reason[1:], error.pos


def _quote_end(text: str, position: int) -> str:
    """The last word or string before a fault, as the author wrote it."""
    line = text[text.rfind("\n", 0, position + 1) + 1 : position + 1]
    token = re.search(r'"[^"]*"$|[^\s,:\[\]{}"]+$|.$', line)
    written = token[0] if token else line
    return written if len(written) <= 40 else f"...{written[-37:]}"
