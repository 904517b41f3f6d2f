"""The kinds of files that a graph can be exported to. The module of a kind is imported when it is used."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from types import MappingProxyType

from msgspec import Struct

from ..errors import UsageError
from .order import ExportOrder, ExportReport


class ExportKind(Struct, frozen=True):
    """A format: its name, the ending of its files, what it is, and the function that writes it."""

    name: str
    ending: str
    title: str
    module: str
    function: str
    is_text: bool = False
    """True if it can be printed in place of written."""

    def export(self, order: ExportOrder) -> ExportReport:
        """Write the files. Raises GraphError for a graph that the format cannot hold, OutputError, UsageError."""
        if order.output is None and not self.is_text:
            raise UsageError(f"--to {self.name}: name the file to write, such as -o {order.name}{self.ending}")
        report: ExportReport = getattr(import_module(f".{self.module}", __package__), self.function)(order)
        return report


KINDS: Mapping[str, ExportKind] = MappingProxyType(
    {
        kind.name: kind
        for kind in (
            ExportKind("isf", ".fs", "one shader in the Interactive Shader Format", "isf", "export_shader", True),
            ExportKind("web", ".html", "one page with the picture and a slider for each control", "web", "export_page"),
            ExportKind("glsl", "", "a folder with passes of GLSL, and readers for them", "folder", "export_folder"),
            ExportKind("wgsl", "", "a folder with passes of WGSL, and a reader", "wgsl.folder", "export_wgsl"),
            ExportKind(
                "python", ".py", "a script of numpy and scipy, for papers and teaching", "python", "export_script", True
            ),
            ExportKind("reshade", ".fx", "an effect of ReShade, for games", "reshade.files", "export_effect"),
            ExportKind("godot", "", "an effect for cameras of the game engine Godot", "godot.files", "export_godot"),
            ExportKind("unity", "", "an effect for cameras of the game engine Unity", "unity.files", "export_unity"),
            ExportKind("cube", ".cube", "a table of colors with a shaper, for grading programs", "lut", "export_cube"),
            ExportKind("clf", ".clf", "a table in the Common LUT Format (SMPTE ST 2136)", "lut", "export_clf"),
            ExportKind("png", ".png", "a table as a strip of squares, for game engines", "lut", "export_strip"),
        )
    }
)
"""All kinds, by name."""


def choose_kind(name: str, output: Path | None) -> ExportKind:
    """The kind of this name, or without a name that of the ending of the file. Raises UsageError."""
    names = ", ".join(KINDS)
    if name:
        if name not in KINDS:
            raise UsageError(f"--to {name}: choose one of {names}")
        return KINDS[name]
    if output is None:
        raise UsageError(f"say what to write with --to: {names}")
    for kind in KINDS.values():
        if kind.ending and kind.ending == output.suffix.lower():
            return kind
    raise UsageError(f"-o {output}: its ending does not say what to write: add --to {names.replace(', ', '|')}")
