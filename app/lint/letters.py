"""Characters of texts that the chosen font has no glyph for."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePath
from typing import Protocol

from halation.nodes import Node, TextBlock, Typeface, TypesetText

from ..errors import HalationError
from ..graph import Graph, Problem
from ..graph.rules import Rule
from .sheet import bodies

MISSING_GLYPH = Rule(
    "missing-glyph",
    "warning",
    "A text has characters that its font cannot draw: a box is drawn in place of each.",
    "Choose a font that has them.",
)

_SHOWN = 8
"""Characters that a sentence names: more are not read."""


class Typesetter(Protocol):
    """Makes outlines of texts."""

    def typeset(self, block: TextBlock) -> TypesetText: ...


def find_missing_glyphs(graph: Graph, typesetter: Typesetter) -> Iterator[Problem]:
    """The nodes whose text has such characters, in groups of the file too. A font that cannot be used has none."""
    for body, inside, at in bodies(graph):
        for id, item in body.nodes.items():
            if not isinstance(item, Node) or type(item).shader != "input/text":
                continue
            text, path, family, weight = (item.setting(name) for name in ("text", "font", "family", "weight"))
            typeface = Typeface(path and str(PurePath(body.folder, path)), family, weight)
            try:
                typeset = typesetter.typeset(TextBlock(text, typeface))
            except HalationError:
                continue
            if typeset.missing:
                names = ", ".join(f"'{letter}' (U+{ord(letter):04X})" for letter in typeset.missing[:_SHOWN])
                more = ", ..." if len(typeset.missing) > _SHOWN else ""
                sentence = f"'{inside}{id}': the font {typeset.font} has no glyph for {names}{more}: choose another one"
                yield Problem(f"{inside}{id}", "text", sentence, MISSING_GLYPH, f"{at}nodes.{id}.values.text")
