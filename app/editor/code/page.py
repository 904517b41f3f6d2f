"""The text of one node, as it is being written."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2
from imgui_bundle.imgui_color_text_edit import TextEditor

from ...authoring.commands import SetCode
from ...custom_nodes import Code, CodeFault, CustomNode, node_type
from ...errors import ShaderError
from ...graph import Unknown
from ..theme.style import mix, u32

if TYPE_CHECKING:
    from .context import CodeContext

PAUSE = 0.25
"""Seconds without a key after which what was typed is taken over."""

BURST = 2.0
"""Seconds without a key after which typing is another step of undo."""


@dataclass(frozen=True)
class Fault:
    """What is wrong with a text; `line` is 0 if it is in none of its lines."""

    line: int
    sentence: str

    @property
    def words(self) -> str:
        """The sentence with its line."""
        said = self.sentence[:1].upper() + self.sentence[1:]
        return f"Line {self.line}: {self.sentence}" if self.line else said


@dataclass(eq=False)
class Page:
    """A widget, the text that was in it last, and the text that the document has."""

    context: CodeContext
    id: str
    place: tuple[str, ...]
    widget: TextEditor = field(default_factory=TextEditor)
    fault: Fault | None = None
    _text: str = ""
    _taken: str | None = None
    _typed: float = 0.0
    _waits: bool = False
    _bursts: int = 0
    _marked: tuple[object, ...] = ()
    _theme: str = ""
    _checked: tuple[Code | None, Fault | None] = (None, None)

    def __post_init__(self) -> None:
        widget = self.widget
        widget.set_language(TextEditor.Language.glsl())
        widget.set_tab_size(4)
        widget.set_insert_spaces_on_tabs(True)
        widget.set_show_whitespaces_enabled(False)
        widget.set_show_scrollbar_mini_map_enabled(False)
        widget.set_line_folding_enabled(False)
        widget.set_complete_paired_glyphs(False)
        widget.set_line_spacing(1.15)

    @property
    def path(self) -> str:
        """The path of the node, through groups."""
        return "/".join((*self.place, self.id))

    def draw(self, size: tuple[float, float]) -> None:
        """Draw the text, and take over what is typed once there is a pause."""
        widget, theme = self.widget, self.context.palette.name
        if theme != self._theme:
            self._theme, self._marked = theme, ()
            dark = theme == "dark"
            widget.set_palette(TextEditor.get_dark_palette() if dark else TextEditor.get_light_palette())
        self._follow()
        self._mark()
        widget.set_read_only_enabled(bool(self.context.session.borrowed))
        widget.render(f"##code {self.path}", ImVec2(*size))
        text = widget.get_text()
        now = time.monotonic()
        if text != self._text:
            if now - self._typed > BURST:
                self._bursts += 1
            self._text, self._typed, self._waits = text, now, True
        if self._waits and now - self._typed >= PAUSE:
            self.take()

    def take(self) -> None:
        """Make what was typed the code of the node."""
        if not self._waits:
            return
        self._waits = False
        if self.place != self.context.session.place or self.context.session.code(self.id) is None:
            return
        self._taken = self._text
        merge = f"code {self.path} {id(self)} {self._bursts}"
        self.context.log.attempt(lambda: self.context.session.apply(SetCode(self.id, self._text, merge)))

    def end_burst(self) -> None:
        """What is typed from now on is another step."""
        self._bursts += 1

    def go_to(self, line: int) -> None:
        """Put the cursor at the beginning of a line, counted from 1."""
        self.widget.set_cursor(TextEditor.DocPos(max(line - 1, 0), 0))
        self.widget.set_focus()

    def _follow(self) -> None:
        """Show what the document has, if that was changed elsewhere."""
        code = self.context.session.code(self.id)
        if code is None or code.text == self._taken or self._waits:
            return
        at = self.widget.get_main_cursor_position()
        first = self._taken is None
        self._taken = code.text
        self.widget.set_text(code.text)
        self._text = self.widget.get_text()
        if not first:
            self.widget.set_cursor(TextEditor.DocPos(min(at.line, self.widget.get_line_count() - 1), at.index))

    def _mark(self) -> None:
        """Show what is wrong at its line."""
        self.fault = self._found()
        wanted = (self.fault, self._theme, self._taken)
        if wanted == self._marked:
            return
        self._marked = wanted
        self.widget.clear_markers()
        if self.fault and self.fault.line:
            palette = self.context.palette
            line = min(self.fault.line, self.widget.get_line_count()) - 1
            back = u32(mix(palette.field, palette.error, 0.35), 0.8)
            self.widget.add_marker(line, u32(palette.error, 0.45), back, self.fault.sentence, self.fault.sentence)

    def _found(self) -> Fault | None:
        """What the text says no node for, else what the driver said when it was drawn last."""
        item = self.context.session.graph.nodes.get(self.id)
        if isinstance(item, Unknown):
            code = self.context.session.code(self.id)
            if code is not None and self._checked[0] != code:
                self._checked = code, _fault_of(code)
            return self._checked[1] or Fault(0, item.fault)
        error = self.context.preview.errors.get(self.path)
        if isinstance(item, CustomNode) and isinstance(error, ShaderError):
            if item.text is None or error.file == item.text.file:
                return Fault(error.line, error.fault.removeprefix("error:").strip())
            return Fault(0, f"{error.file}, line {error.line}: {error.fault}")
        return None


def _fault_of(code: Code) -> Fault | None:
    try:
        node_type(code)
    except CodeFault as fault:
        return Fault(fault.line, fault.sentence)
    return None
