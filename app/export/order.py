"""What an export is asked for, and what it reports."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from halation.nodes import Size
from msgspec import Struct, field

from ..graph import Graph, Port
from ..resources.sandbox import Sandbox

if TYPE_CHECKING:
    from ..renderer import Renderer

Encoding = Literal["linear", "srgb"]


class TableOptions(Struct, frozen=True):
    """How a table of colors is made."""

    encoding: Encoding | None = None
    """What the numbers are before and after the table; None for what suits the format."""
    low: float | None = None
    high: float | None = None
    """The range of the colors before the table; None for that of the picture, or a usual one."""
    side: int = 33
    """Colors along each side of the table: 33 is what most programs write, and all of them read."""
    checks: bool = False
    """Whether the table is compared with the graph."""


class ExportOrder(Struct, frozen=True):
    """A graph to export: the port that is shown, files of inputs by name, and where to write.

    Without an `output` the text is returned in the report. `open_renderer` is called where a kind has to render.
    """

    graph: Graph
    name: str
    target: Port
    sandbox: Sandbox
    open_renderer: Callable[[], Renderer]
    output: Path | None = None
    inputs: Mapping[str, str] = field(default_factory=dict[str, str])
    size: Size | None = None
    frame: int | None = None
    table: TableOptions = TableOptions()


class ExportReport(Struct, frozen=True):
    """The files that were written, what they do not hold of the graph, and figures; or a text in place of files."""

    files: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    figures: Mapping[str, float | str] = field(default_factory=dict[str, "float | str"])
    text: str = ""
