"""The text editor of one code node."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle.imgui_color_text_edit import TextEditor
from msgspec import Struct, field

from ...authoring.commands import SetCode
from ...custom_nodes import Code, CodeFault, CustomNode, node_type
from ...errors import ShaderError
from ...graph import Unknown
from ...language.translation import translate
from ..theme.style import mix, u32

if TYPE_CHECKING:
    from .context import CodeContext

PAUSE = 0.25
"""Seconds without typing after which the text becomes the code of the node."""

BURST = 2.0
"""Seconds without typing after which a new undo step begins."""


class Fault(Struct, frozen=True):
    """An error in a text; `line` is 0 if it belongs to no line."""

    line: int
    sentence: str

    @property
    def text(self) -> str:
        """The sentence with its line number."""
        sentence = self.sentence[:1].upper() + self.sentence[1:]
        return translate("Line {line}: {sentence}", line=self.line, sentence=self.sentence) if self.line else sentence


class Page(Struct, eq=False):
    """The editor widget of a node, its last text, and the text in the document."""

    context: CodeContext
    id: str
    place: tuple[str, ...]
    widget: TextEditor = field(default_factory=TextEditor)
    fault: Fault | None = None
    _text: str = ""
    _committed: str | None = None
    _typed_at: float = 0.0
    _pending: bool = False
    _bursts: int = 0
    _marker_inputs: tuple[object, ...] = ()
    _theme: str = ""
    _checked_code: tuple[Code | None, Fault | None] = (None, None)

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
        """Draw the text; after a pause in typing it becomes the code of the node."""
        widget, theme = self.widget, self.context.palette.name
        if theme != self._theme:
            self._theme, self._marker_inputs = theme, ()
            dark = theme != "light"
            widget.set_palette(TextEditor.get_dark_palette() if dark else TextEditor.get_light_palette())
        self._follow()
        self._update_markers()
        widget.set_read_only_enabled(bool(self.context.session.borrowed))
        widget.render(f"##code {self.path}", ImVec2(*size))
        text = widget.get_text()
        time_now = imgui.get_time()
        if text != self._text:
            if time_now - self._typed_at > BURST:
                self._bursts += 1
            self._text, self._typed_at, self._pending = text, time_now, True
        if self._pending and time_now - self._typed_at >= PAUSE:
            self.commit()

    def commit(self) -> None:
        """Set the typed text as the code of the node."""
        if not self._pending:
            return
        self._pending = False
        if self.place != self.context.session.place or self.context.session.code_files.find_code(self.id) is None:
            return
        self._committed = self._text
        merge = f"code {self.path} {id(self)} {self._bursts}"
        self.context.log.attempt(lambda: self.context.session.apply(SetCode(self.id, self._text, merge)))

    def end_burst(self) -> None:
        """Begin a new undo step with the next text."""
        self._bursts += 1

    def go_to(self, line: int) -> None:
        """Put the cursor at the beginning of a line, counted from 1."""
        self.widget.set_cursor(TextEditor.DocPos(max(line - 1, 0), 0))
        self.widget.set_focus()

    def _follow(self) -> None:
        """Show the text of the document if something else has changed it."""
        code = self.context.session.code_files.find_code(self.id)
        if code is None or code.text == self._committed or self._pending:
            return
        at = self.widget.get_main_cursor_position()
        first = self._committed is None
        self._committed = code.text
        self.widget.set_text(code.text)
        self._text = self.widget.get_text()
        if not first:
            self.widget.set_cursor(TextEditor.DocPos(min(at.line, self.widget.get_line_count() - 1), at.index))

    def _update_markers(self) -> None:
        """Mark the line with the error."""
        self.fault = self._find_fault()
        inputs = (self.fault, self._theme, self._committed)
        if inputs == self._marker_inputs:
            return
        self._marker_inputs = inputs
        self.widget.clear_markers()
        if self.fault and self.fault.line:
            palette = self.context.palette
            line = min(self.fault.line, self.widget.get_line_count()) - 1
            back = u32(mix(palette.field, palette.error, 0.35), 0.8)
            self.widget.add_marker(line, u32(palette.error, 0.45), back, self.fault.sentence, self.fault.sentence)

    def _find_fault(self) -> Fault | None:
        """The error in the text, or else the shader error of the last render."""
        item = self.context.session.graph.nodes.get(self.id)
        if isinstance(item, Unknown):
            code = self.context.session.code_files.find_code(self.id)
            if code is not None and self._checked_code[0] != code:
                self._checked_code = code, _find_code_fault(code)
            return self._checked_code[1] or Fault(0, item.fault)
        error = self.context.preview.errors.get(self.path)
        if isinstance(item, CustomNode) and isinstance(error, ShaderError):
            if item.text is None or error.file == item.text.file:
                return Fault(error.line, error.fault.removeprefix("error:").strip())
            return Fault(0, f"{error.file}, line {error.line}: {error.fault}")
        return None


def _find_code_fault(code: Code) -> Fault | None:
    try:
        node_type(code)
    except CodeFault as fault:
        return Fault(fault.line, fault.sentence)
    return None
