"""What a render to files shall be: the form's state and what it asks for. Draws nothing."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from ....nodes import Kind
from ..editor import Editor
from ..services.exporting import Export, Options

Sizing = Literal["as it is", "scale", "size"]

Depth = Literal["", "half", "float"]

DEPTHS: tuple[tuple[Depth, str], ...] = (
    ("", "as the format has it"), ("half", "16 bit"), ("float", "32 bit (16 in PNG and TIFF)"),
)
FORMATS = (".exr", ".png", ".jpg", ".tif", ".webp", ".hdr")
VIEWED = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp"})
"""Formats that show a picture as a display does."""


@dataclass
class Form:
    """What was chosen. `files` are the paths that were typed, by output; "" takes the suggestion."""

    chosen: dict[str, bool] = field(default_factory=dict[str, bool])
    files: dict[str, str] = field(default_factory=dict[str, str])
    format: str = ".exr"
    sizing: Sizing = "as it is"
    scale: float = 0.5
    size: tuple[int, int] = (1920, 1080)
    precision: Depth = ""
    view: str = ""

    def suggested(self, editor: Editor, output: str) -> Path:
        """Where an output goes if nothing else is said."""
        last = editor.store.folder("export")
        session = editor.session
        folder = Path(last) if last else session.path.absolute().parent if session.path else Path.home()
        name = session.name if len(session.root.outputs) == 1 else f"{session.name}_{output}"
        return folder / f"{name}{self.format}"

    def file(self, editor: Editor, output: str) -> Path:
        """Where an output goes."""
        typed = self.files.get(output, "")
        return Path(typed).expanduser() if typed else self.suggested(editor, output)

    def wanted(self, editor: Editor) -> tuple[str, ...]:
        """The outputs that are chosen; at first those that are pictures."""
        kinds = {name: output.kind for name, output in editor.session.root.outputs.items()}
        return tuple(name for name, kind in kinds.items() if self.chosen.get(name, kind in (Kind.IMAGE, Kind.FIELD)))

    def reform(self, format: str) -> None:
        """Another format for all files."""
        self.format = format
        self.files = {name: str(Path(path).with_suffix(format)) for name, path in self.files.items() if path}

    def options(self) -> Options:
        """The choices as the exporter wants them."""
        made = Options(precision=self.precision or None, view=self.view)
        if self.sizing == "scale":
            return replace(made, scale=self.scale)
        return replace(made, size=self.size) if self.sizing == "size" else made

    def start(self, editor: Editor) -> Export:
        """Begin. Raises UsageError, OutputError or GraphError."""
        files = [(name, self.file(editor, name)) for name in self.wanted(editor)]
        made = editor.exports.start(editor.session.root, files, dict(editor.session.bindings), self.options())
        if files:
            editor.store.used("export", files[0][1])
        return made


def title(export: Export) -> str:
    """What a render is called: its files."""
    first = export.destinations[0][1].name
    more = len(export.destinations) - 1
    return f"{first} and {more} more" if more else first


def state_text(export: Export) -> str:
    """Where a render is."""
    if export.state == "running":
        if not export.total:
            return "starting"
        return f"{export.done} of {export.total} passes" if export.done < export.total else "writing"
    return {"done": "done", "failed": "failed", "cancelled": "cancelled"}[export.state]
