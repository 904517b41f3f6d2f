"""What a comment beside a parameter says of it: `// = 0.5, 0..1, >= 0, px, "Label": a sentence`."""

from __future__ import annotations

import re
from typing import get_args

from halation.nodes import Edge, Unit
from msgspec import Struct

from .code import CodeFault

UNITS: tuple[str, ...] = get_args(Unit)
EDGES: tuple[str, ...] = get_args(Edge)
WORDS = ("color", "handle", "vector", "optional")

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\s*\.\.\s*({_NUMBER})")
_LIMIT = re.compile(rf"(>=|<=)\s*({_NUMBER})")
_OPTIONAL = re.compile(rf"optional(?:\s+({_NUMBER}))?")
_TOKENS = re.compile(r'"[^"]*"|\([^)]*\)|[^,"(:]+|[,:"(]')
NOTE_HELP = (
    'a default (= 0.5), a range (0..1), limits (>= 0, <= 10), choices (one of a | b), a "Label", a unit '
    f"({', '.join(UNITS)}), {', '.join(WORDS)} or an edge ({', '.join(EDGES)})"
)


class ParameterNote(Struct):
    """What was said; `default` is text, empty for a picture."""

    default: str = ""
    low: float | None = None
    high: float | None = None
    minimum: float = float("-inf")
    maximum: float = float("inf")
    unit: str = ""
    label: str = ""
    doc: str = ""
    choices: tuple[str, ...] = ()
    color: bool = False
    handle: bool = False
    vector: bool = False
    edge: str = ""
    optional: float | None = None


def read_note(comment: str, line: int) -> ParameterNote:
    """A comment's meaning. One that does not begin as a note does is all sentence. Raises CodeFault."""
    text = comment.removeprefix("//").removeprefix("/*").removesuffix("*/").strip()
    note, items = ParameterNote(), list[str]()
    current = ""
    tokens = _TOKENS.findall(text)
    for number, token in enumerate(tokens):
        if token == ":":
            note.doc = "".join(tokens[number + 1 :]).strip()
            break
        if token == ",":
            items.append(current)
            current = ""
        else:
            current += token
    items.append(current)
    items = [item.strip() for item in items]
    for number, item in enumerate(items):
        if not _read_item(item, note):
            if number == 0 and not item.startswith(("=", '"', ">", "<")):
                return ParameterNote(doc=text)
            raise CodeFault(line, f"'{item}' says nothing of a parameter: write {NOTE_HELP}")
    return note


def _read_item(item: str, note: ParameterNote) -> bool:
    """Note one item; False if it is none."""
    if item.startswith("="):
        note.default = item[1:].strip()
        return bool(note.default)
    if item.startswith('"') and item.endswith('"') and len(item) > 1:
        note.label = item[1:-1].strip()
    elif range_match := _RANGE.fullmatch(item):
        note.low, note.high = float(range_match[1]), float(range_match[2])
    elif range_match := _LIMIT.fullmatch(item):
        if range_match[1] == ">=":
            note.minimum = float(range_match[2])
        else:
            note.maximum = float(range_match[2])
    elif range_match := _OPTIONAL.fullmatch(item):
        note.optional = float(range_match[1] or 0.0)
    elif item.startswith("one of "):
        note.choices = tuple(word.strip() for word in item.removeprefix("one of ").split("|") if word.strip())
        return len(note.choices) > 1
    elif item in UNITS:
        note.unit = item
    elif item in EDGES:
        note.edge = item
    elif item in WORDS:
        setattr(note, item, True)
    else:
        return False
    return True
