"""Which way each letter of a paragraph runs, by the Unicode Bidirectional Algorithm of python-bidi, and by script."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import groupby
from typing import Any
from unicodedata import bidirectional, category

from halation.nodes import TextDirection
from msgspec import Struct

from .bidi_brackets import resolve_brackets
from .harfbuzz import hb

_STRONG = {"L": 0, "R": 1, "AL": 1}
_MARKED = frozenset({"R", "AL", "AN", "RLE", "RLO", "LRO", "LRE", "RLI", "LRI", "FSI"})
_ISOLATES = str.maketrans({"\u2066": "\u202a", "\u2067": "\u202b", "\u2068": "\u202a", "\u2069": "\u202c"})
"""Isolates as embeddings: python-bidi's own levels are those of Unicode 6.2, which has no isolates."""


class TextRun(Struct, frozen=True):
    """Letters of a paragraph from `start` to `end` that run one way, in one script (ISO 15924)."""

    start: int
    end: int
    level: int
    script: str

    @property
    def is_backward(self) -> bool:
        """True if it runs from right to left."""
        return self.level % 2 == 1


def find_levels(paragraph: str, direction: TextDirection) -> tuple[int, list[int]]:
    """The level of a paragraph and of each of its letters; odd ones run from right to left."""
    classes = [bidirectional(letter) for letter in paragraph]
    base = (
        next((_STRONG[name] for name in classes if name in _STRONG), 0)
        if direction == "auto"
        else int(direction == "right to left")
    )
    if base == 0 and _MARKED.isdisjoint(classes):
        return 0, [0] * len(paragraph)
    return base, _resolve_levels(paragraph.translate(_ISOLATES), base)


def _resolve_levels(paragraph: str, base: int) -> list[int]:
    from bidi import algorithm

    storage: dict[str, Any] = algorithm.get_empty_storage()
    storage |= {"base_level": base, "base_dir": "LR"[base]}
    algorithm.get_embedding_levels(paragraph, storage)
    for place, letter in enumerate(storage["chars"]):
        letter["place"] = place
    algorithm.explicit_embed_and_overrides(storage)
    algorithm.resolve_weak_types(storage)
    resolve_brackets(storage, algorithm.MIRRORED)
    algorithm.resolve_neutral_types(storage, False)
    algorithm.resolve_implicit_levels(storage, False)
    levels = [base] * len(paragraph)
    for letter in storage["chars"]:
        levels[letter["place"]] = letter["level"]
    return levels


def split_runs(paragraph: str, levels: Sequence[int], start: int, end: int) -> list[TextRun]:
    """The runs of a line from left to right, by rule L2. Letters that belong to any script join those before them."""
    scripts = _find_scripts(paragraph)
    runs = [
        TextRun(places[0], places[-1] + 1, level, script)
        for (level, script), group in groupby(range(start, end), lambda place: (levels[place], scripts[place]))
        if (places := list(group))
    ]
    highest = max((run.level for run in runs), default=0)
    for level in range(highest, 0, -1):
        runs = _reverse_runs(runs, level)
    return runs


def _reverse_runs(runs: list[TextRun], level: int) -> list[TextRun]:
    """The runs with each sequence of at least this level in the opposite order."""
    ordered, sequence = list[TextRun](), list[TextRun]()
    for run in runs:
        if run.level >= level:
            sequence.insert(0, run)
        else:
            ordered += (*sequence, run)
            sequence = []
    return ordered + sequence


def _find_scripts(paragraph: str) -> list[str]:
    scripts, current = list[str](), ""
    for letter in paragraph:
        current = _find_script(letter) or current
        scripts.append(current)
    first = next((script for script in scripts if script), "Latn")
    return [script or first for script in scripts]


@lru_cache(maxsize=4096)  # chosen by judgement: the letters of a few scripts
def _find_script(letter: str) -> str:
    """The script of a letter; "" for marks, signs and spaces that all scripts share."""
    if category(letter)[0] == "Z":
        return ""
    buffer = hb.Buffer()
    buffer.add_str(letter)
    buffer.guess_segment_properties()
    script = buffer.script or ""
    return "" if script in ("Zyyy", "Zinh", "Zzzz") else script
