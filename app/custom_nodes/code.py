"""Code that a user wrote for a node of a graph."""

from __future__ import annotations

import re
from typing import ClassVar, Literal

from halation.nodes import Node
from msgspec import Struct

from ..glsl import Text

Language = Literal["glsl", "isf"]
"""GLSL as the house writes it, and the Interactive Shader Format. Both are types of nodes in documents."""


class Code(Struct, frozen=True):
    """`text` stands in the graph, or in a `file` beside it (as the graph spells it).

    `vertex` is the vertex shader that lies beside a file in the Interactive Shader Format, if there is one.
    """

    language: Language
    text: str
    file: str = ""
    vertex: str = ""

    @property
    def name(self) -> str:
        """What messages call it."""
        return self.file or "its code"


class CodeFault(Exception):
    """Code that says no node: why, and in which line; 0 if in none of its lines."""

    def __init__(self, line: int, sentence: str) -> None:
        self.line, self.sentence = line, sentence
        super().__init__(f"line {line}: {sentence}" if line else sentence)


class CustomNode(Node):
    """What the classes of all nodes share that are made of code. `title` is what it calls itself."""

    code: ClassVar[Code]
    title: ClassVar[str]
    text: ClassVar[Text | None] = None
    """Its functions for the compiler's library, if they go there."""


def strip_prefix(message: str) -> str:
    """A driver's message with names as the user wrote them."""
    return re.sub(r"\bw[0-9a-f]{8}x?_(?=\w)", "", message)
