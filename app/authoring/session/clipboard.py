"""Copying and pasting as text."""

from __future__ import annotations

from ...errors import GraphError
from ..edits import clipboard, deleting, naming
from ..edits.elements import Place
from .state import State


class Clipboard(State):
    """Parts of a graph as JSON, which can be pasted into any graph and into any text."""

    def copy(self) -> str:
        """The selection as text."""
        return clipboard.copy_elements(self.graph, self._something("copy"))

    def cut_out(self) -> str:
        """The selection as text, and removed."""
        text = self.copy()
        self.edit(
            f"Cut {naming.describe_elements(self.selection)}", deleting.delete_elements(self.graph, self.selection), ()
        )
        return text

    def paste(self, text: str, at: Place | None = None, keep_links: bool = False) -> tuple[str, ...]:
        """Add what was copied, or the content of a whole graph file; returns the keys, which are selected.

        The upper left corner comes to `at`, else near where it was. With `keep_links`, links from what is not part of
        the text stay where that exists.
        """
        part = clipboard.read_part(text, self.root.folder, self.types)
        graph, put = clipboard.paste_part(self.graph, part, self.positions, at, keep_links)
        self.edit(f"Paste {naming.describe_elements(put)}", graph, put)
        return put

    def duplicate(self, offset: Place = (24.0, 24.0)) -> tuple[str, ...]:
        """The selection once more, fed by the same; returns the keys, which are selected."""
        part = clipboard.cut_part(self.graph, self._something("duplicate"))
        graph, put = clipboard.paste_part(self.graph, part, self.positions, keep_links=True, offset=offset)
        self.edit(f"Duplicate {naming.describe_elements(self.selection)}", graph, put)
        return put

    def _something(self, verb: str) -> frozenset[str]:
        if not self.selection:
            raise GraphError(f"nothing is selected: select what to {verb}")
        return self.selection
