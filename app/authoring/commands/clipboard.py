"""Commands that cut, paste and duplicate parts of a graph as JSON, which fits into any graph and any text."""

from __future__ import annotations

from ...language.translation import translate
from ..edits import clipboard, deleting, naming
from ..edits.clipboard import copy_elements
from ..edits.element_id import ElementId
from ..edits.elements import Place
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited, require_selection


class CutSelection(EditCommand[str], frozen=True):
    """Remove the selection; returns it as text."""

    def apply(self, document: OpenDocument) -> Edited[str]:
        text = copy_elements(document.graph, document.selection)
        graph = deleting.delete_elements(document.graph, document.selection)
        return Edited(
            translate("Cut {elements}", elements=naming.describe_elements(document.selection)), text, graph, ()
        )


class PasteText(EditCommand[tuple[ElementId, ...]], frozen=True):
    """Add what was copied, or the content of a whole graph file; gives the new elements, which are selected.

    The upper left corner comes to `at`, else near where it was. With `keep_links`, links from what is not part of the
    text stay where that exists.
    """

    text: str
    at: Place | None = None
    keep_links: bool = False

    def apply(self, document: OpenDocument) -> Edited[tuple[ElementId, ...]]:
        part = clipboard.read_part(self.text, document.root.folder, document.types, sandbox=document.sandbox)
        graph, keys = clipboard.paste_part(document.graph, part, document.positions, self.at, self.keep_links)
        return Edited(translate("Paste {elements}", elements=naming.describe_elements(keys)), keys, graph, keys)


class DuplicateSelection(EditCommand[tuple[ElementId, ...]], frozen=True):
    """Add a copy of the selection with the same sources; returns the new elements, which are selected."""

    offset: Place = (24.0, 24.0)

    def apply(self, document: OpenDocument) -> Edited[tuple[ElementId, ...]]:
        part = clipboard.cut_part(
            document.graph, require_selection(document, translate("nothing is selected: select what to duplicate"))
        )
        graph, keys = clipboard.paste_part(
            document.graph, part, document.positions, keep_links=True, offset=self.offset
        )
        return Edited(
            translate("Duplicate {elements}", elements=naming.describe_elements(document.selection)), keys, graph, keys
        )
