"""A text field on the canvas for titles of frames, texts of comments, names of nodes and ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec import Struct

from ...authoring.commands import EditComment, EditFrame, RenameEnd, RenameNode
from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.edits.elements import entry
from .brush import TEXT, DrawContext
from .geometry import Rect
from .scene import CanvasScene

if TYPE_CHECKING:
    from .context import CanvasContext


class NameField(Struct):
    """The text field on an element, and which element that is."""

    context: CanvasContext
    key: ElementId = NO_ELEMENT
    rect: Rect | None = None
    """Where the field is, on the screen."""
    _text: str = ""
    _starting: bool = False

    def begin(self, key: ElementId) -> None:
        """Open a field on an element."""
        facts = entry(self.context.session.graph, key)
        match key.kind:
            case "frame":
                self._text = str(facts.get("title", ""))
            case "comment":
                self._text = str(facts.get("text", ""))
            case _:
                self._text = key.name
        self.key, self._starting = key, True

    def draw(self, brush: DrawContext, scene: CanvasScene) -> None:
        """Draw the field, and apply the text when the user leaves it.

        imgui gives a field the focus in the frame after it was asked to. So a field without focus is one that was left
        only after it has had the focus once.
        """
        self.rect = None
        if not self.key:
            return
        box = scene.boxes.get(self.key)
        if box is None:
            self.key = NO_ELEMENT
            return
        s, is_multiline = brush.to.scale, box.sort == "comment"
        low, _ = brush.project_corners(box.rect)
        imgui.set_cursor_screen_pos(low)
        imgui.push_font(brush.fonts.text, TEXT * max(brush.zoom, 0.6))
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (11.0 * s, (8.0 if is_multiline else 7.0) * s))
        if self._starting:
            imgui.set_keyboard_focus_here()
        if is_multiline:
            flags = int(imgui.InputTextFlags_.word_wrap) | int(imgui.InputTextFlags_.ctrl_enter_for_new_line)
            size = (max(box.w, 80.0) * s, max(box.h, 40.0) * s)
            _, self._text = imgui.input_text_multiline("##naming", self._text, size, flags)
        else:
            imgui.set_next_item_width(max(min(box.w, 400.0) * s, 120.0))
            flags = int(imgui.InputTextFlags_.auto_select_all)
            _, self._text = imgui.input_text("##naming", self._text, flags)
        imgui.pop_style_var()
        imgui.pop_font()
        active, high = imgui.is_item_active(), imgui.get_item_rect_max()
        self.rect = (*low, high.x, high.y)
        if self._starting:
            self._starting = not active
        elif imgui.is_item_deactivated() or not active:
            escaped = imgui.is_key_pressed(imgui.Key.escape)
            key, self.key = self.key, NO_ELEMENT
            if not escaped:
                self.context.log.attempt(lambda: _set_name(self.context, key, self._text))


def _set_name(context: CanvasContext, element: ElementId, text: str) -> None:
    match element.kind:
        case "frame":
            context.session.apply(EditFrame(element, title=text.strip()))
        case "comment":
            context.session.apply(EditComment(element, text.rstrip()))
        case "input" | "output":
            context.session.apply(RenameEnd(element, text.strip()))
        case _:
            context.session.apply(RenameNode(element, text.strip()))
