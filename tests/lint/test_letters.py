"""Characters that a font cannot draw are named."""

from __future__ import annotations

from halation.graph import Graph
from halation.inputs.provider import MediaProvider
from halation.lint.letters import MISSING_GLYPH, find_missing_glyphs
from halation.nodes.input.text import Text
from halation.resources.sandbox import UNRESTRICTED


def test_missing_characters_are_named():
    graph = Graph().add("title", Text(text="aक漢")).add("plain", Text(text="abc")).add("lost", Text(font="none.ttf"))
    (problem,) = find_missing_glyphs(graph, MediaProvider(sandbox=UNRESTRICTED))
    assert (problem.node, problem.socket, problem.rule) == ("title", "text", MISSING_GLYPH)
    assert "DejaVu Sans has no glyph for 'क' (U+0915), '漢' (U+6F22): choose another one" in problem.sentence
