"""Everything that a person can do to a document."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Node

from .clipboard import Clipboard
from .coding import Coding
from .decor import Decor
from .ends import Ends
from .files import Files
from .grouping import Grouping
from .layout import Layout
from .selecting import Selecting
from .values import Values
from .viewing import Viewing
from .wiring import Wiring


class Session(Viewing, Files, Selecting, Wiring, Values, Decor, Layout, Grouping, Ends, Clipboard, Coding):
    """A document that is open in the editor; a new one at first.

    Every method that makes no sense raises HalationError with one sentence and changes nothing.
    """

    def __init__(self, types: Mapping[str, type[Node]] | None = None) -> None:
        super().__init__(types)
        self.new()
