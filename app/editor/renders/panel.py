"""The Renders panel: a form for a new render, and the queue."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...language.translation import translate
from ..theme.style import UNSCROLLED, ui_scale
from ..toolkit.words import draw_empty_panel
from .form import RenderForm
from .form_view import draw_form, draw_start
from .queue_view import RenderQueueView

if TYPE_CHECKING:
    from .context import RendersContext

_FLAT = imgui.ChildFlags_.nav_flattened.value
"""The keyboard walks through both parts as one."""
_ROWS = 3
"""The rows of the form that are seen at least, however low the panel is."""
_FORM, _WIDE = 420.0, 760.0
"""The width of the form, and the panel width from which on the queue is beside it."""


class RendersPanel:
    """The form and the queue. A render uses the graph as it was when the render was added."""

    def __init__(self, context: RendersContext) -> None:
        self._context = context
        self._forms: dict[Path | None, RenderForm] = {}
        """The form of each document."""
        self._queue = RenderQueueView(context)
        self._foot = 0.0
        """The height of what is below the form, which does not scroll: what a render would write is always seen."""

    def close(self) -> None:
        """Release textures."""
        self._queue.close()

    def draw(self) -> None:
        """Draw into the current window."""
        if not self._context.session.root.outputs and not self._context.exports.all:
            sentence = translate("Add a graph output and link a node to it.")
            draw_empty_panel(self._context, icons.ICON_FA_FILM, translate("Nothing to render"), sentence)
            return
        form = self._forms.setdefault(self._context.session.path, RenderForm(self._context))
        room, scale = imgui.get_content_region_avail(), ui_scale()
        if room.x < _WIDE * scale:
            draw_form(self._context, form)
            draw_start(self._context, form, room.x)
            imgui.separator()
            self._queue.draw()
            return
        least, gap = _ROWS * imgui.get_frame_height_with_spacing(), imgui.get_style().item_spacing.y
        height = room.y - self._foot - gap
        # The parts are too high in the frame in which what is below the form grows. A scrollbar would take some of the
        # width for that frame, and move the buttons of the queue away from who clicks on them.
        imgui.begin_child("parts", ImVec2(0.0, 0.0), _FLAT, UNSCROLLED if height >= least else 0)
        imgui.begin_group()
        imgui.begin_child("form", ImVec2(_FORM * scale, max(height, least)), _FLAT)
        draw_form(self._context, form)
        imgui.end_child()
        imgui.begin_child("start", ImVec2(_FORM * scale, 0.0), _FLAT | imgui.ChildFlags_.auto_resize_y.value)
        draw_start(self._context, form, _FORM * scale)
        imgui.end_child()
        self._foot = imgui.get_item_rect_size().y
        imgui.end_group()
        imgui.same_line(0, 20 * scale)
        imgui.begin_child("queue", ImVec2(0, room.y), _FLAT)
        self._queue.draw()
        imgui.end_child()
        imgui.end_child()
