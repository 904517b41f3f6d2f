"""The Inspector panel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ...language.translation import translate
from ..fields.fields import Fields
from ..theme.palette import DARK
from .end_view import EndView
from .file_field import FileField
from .graph_view import GraphView
from .heading import draw_heading
from .node_view import NodeView
from .rows import Rows
from .value_rows import ValueRows

if TYPE_CHECKING:
    from .context import InspectorContext


class Inspector:
    """Values, links and descriptions of the active element; of the graph if there is none."""

    def __init__(self, context: InspectorContext) -> None:
        self._context = context
        self._fields = Fields(DARK)
        self._files = FileField(self._fields, context.session.sandbox)
        self._values = ValueRows(self._fields, self._files)
        self._node = NodeView(self._fields, self._values)
        self._end = EndView(self._fields, self._files)
        self._graph = GraphView(self._fields, self._values)

    def draw(self) -> None:
        """Draw into the current window."""
        fields = self._fields
        fields.palette, fields.places, fields.items = self._context.palette, self._context.places, self._context.items
        fields.store = self._context.interface.store
        self._values.begin()
        dragged = fields.dragging
        fields.begin(imgui.is_mouse_down(imgui.MouseButton_.left))
        rows = Rows(self._context, fields)
        self._draw(rows)
        rows.finish()
        if dragged and not fields.dragging:
            self._context.session.seal()
        left = fields.end()
        if left:
            self._values.take_abandoned(self._context, left)
        self._context.interface.dragging |= fields.dragging

    def close(self) -> None:
        """Stop the threads and release textures."""
        self._files.close()

    def _draw(self, rows: Rows) -> None:
        session = rows.context.session
        graph, active = session.graph, session.active
        if session.borrowed:
            sentence = translate("This group comes from {file}: make it local to edit it here.", file=session.borrowed)
            rows.note(sentence, rows.palette.warning)
        nodes = tuple(sorted(session.selection & graph.nodes.keys(), key=lambda id: (id != active, id)))
        if len(nodes) > 1:
            self._node.several(rows, nodes)
        elif active in graph.nodes:
            self._node.draw(rows, active)
        elif end := active.port:
            self._end.draw(rows, end)
        elif active.kind == "frame":
            self._graph.frame(rows, active)
        elif active.kind == "comment":
            self._graph.comment(rows, active)
        elif active.kind == "dot":
            draw_heading(rows, translate("Dot"), rows.palette.dim)
            rows.note(translate("A dot only routes links. It does not change the picture."))
        else:
            self._graph.draw(rows)
        imgui.dummy((1.0, imgui.get_font_size()))
