"""Counts the parts of a document that take longer to read than their text suggests, and refuses too many of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, cast

from msgspec import Struct, field

from . import limits
from .records import GraphRecord

_WORD = re.compile(r"[\w.]+|[^\w\s]")
"""A name, a number or a sign: what an expression is read by."""


class PartTally(Struct):
    """The parts of a graph and of all groups in its file so far."""

    ends: int = 0
    links: int = 0
    keys: int = 0
    words: int = 0
    formulas: set[str] = field(default_factory=set[str])

    def add(self, record: GraphRecord) -> tuple[str, str] | None:
        """Count the parts of a body. Returns the name of the section that holds too many and a sentence, or None."""
        return next(self._find_faults(record), None)

    def _find_faults(self, record: GraphRecord) -> Iterator[tuple[str, str]]:
        for section, entries in (("inputs", record.inputs), ("outputs", record.outputs), ("controls", record.controls)):
            self.ends += len(entries)
            if len(entries) > limits.MAX_ENDS:
                yield section, _refuse(limits.MAX_ENDS, section, "there")
            if self.ends > limits.MAX_ALL_ENDS:
                yield section, _refuse(limits.MAX_ALL_ENDS, "inputs, outputs and controls", "in all groups together")
        self.links += len(record.links)
        if self.links > limits.MAX_LINKS:
            yield "links", _refuse(limits.MAX_LINKS, "links", "in all groups together")
        for entry in record.animation.values():
            if isinstance(entry, dict):
                self._add_animation(cast("Mapping[str, Any]", entry))
            if self.keys > limits.MAX_KEYS:
                yield "animation", _refuse(limits.MAX_KEYS, "keys", "of all values together")
            if self.words > limits.MAX_WORDS:
                yield "animation", _refuse(limits.MAX_WORDS, "words and signs", "in all expressions together")
        allowed = record.settings.get("allow")
        if isinstance(allowed, dict) and len(cast("Mapping[str, Any]", allowed)) > limits.MAX_ALLOWED:
            yield "settings.allow", _refuse(limits.MAX_ALLOWED, "entries", "there")

    def _add_animation(self, entry: Mapping[str, Any]) -> None:
        keys, text = entry.get("keys"), entry.get("expression")
        if isinstance(keys, list):
            self.keys += len(cast("list[object]", keys))
        if isinstance(text, str) and len(text) <= limits.MAX_FORMULA:
            self.words += text.count(".") if text in self.formulas else len(_WORD.findall(text))
            self.formulas.add(text)


def _refuse(most: int, parts: str, where: str) -> str:
    return f"{where} are more than {most:,} {parts}; that is no graph"
