"""Exports of a document to the formats of other programs, each by `halation export` in a process of its own.

So the window stays fast while a look is compiled at many values of its controls, a crash there does no harm, and what
is refused is refused with the same sentence as on the command line.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from msgspec import Struct, field

from ... import document
from ...graph import Graph
from ...resources.sandbox import Sandbox
from ..edits.paths import rebase_paths
from .command_process import CommandEnd, CommandProcess


class ExportChoices(Struct, frozen=True):
    """What to export, and how; "" and 0 stand for what is usual.

    `node` is the output of a node to export, `selection` are ids of nodes with commas between, to export these
    alone. `size` is like 960x540, for pages and passes. `frame` is one frame, None all of them. `encoding`,
    `color_range` such as 0,16 and `lut_size` are for tables of colors.
    """

    kind: str
    node: str = ""
    selection: str = ""
    size: str = ""
    frame: int | None = None
    encoding: str = ""
    color_range: str = ""
    lut_size: int = 0

    @property
    def words(self) -> list[str]:
        """The choices as words of the command."""
        options: Mapping[str, Any] = {
            "--to": self.kind,
            "--node": "" if self.selection else self.node,
            "--select": self.selection,
            "--size": self.size,
            "--frame": "" if self.frame is None else self.frame,
            "--encoding": self.encoding,
            "--range": self.color_range,
            "--lut-size": self.lut_size or "",
        }
        return [f"{name}={option}" for name, option in options.items() if option != ""]


class ExportOutcome(Struct, frozen=True):
    """How an export ended: why it was refused, or what it left out and its figures."""

    fault: str = ""
    notes: tuple[str, ...] = ()
    figures: Mapping[str, float | str] = field(default_factory=dict[str, "float | str"])


class GraphExport:
    """One export, which runs from the beginning on. `outcome` is None until it has ended."""

    def __init__(
        self,
        graph: Graph,
        choices: ExportChoices,
        output: Path,
        folder: Path,
        bindings: Mapping[str, str],
        sandbox: Sandbox,
    ) -> None:
        """Begin to write `output`. The graph as it is now, saved or not, goes into the temporary `folder`.

        Raises OutputError, and GraphError for what a file cannot hold.
        """
        self.choices, self.output = choices, output
        self.outcome: ExportOutcome | None = None
        file = folder / f"{output.stem}.json"
        document.save(rebase_paths(graph, str(folder)), file, sandbox=sandbox)
        inputs = [f"--input={name}={path}" for name, path in bindings.items() if not choices.selection]
        command = ["export", str(file), f"--output={output}", "--json", *choices.words, *inputs]
        self._process = CommandProcess(command, self._read_end)

    def stop(self) -> None:
        """Ask the process to end, which leaves no unfinished file."""
        self._process.stop()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until it has ended, at most so long; False if it still runs."""
        return self._process.wait(seconds)

    def _read_end(self, end: CommandEnd) -> None:
        if end.fault:
            self.outcome = ExportOutcome(end.fault)
            return
        report = end.report
        notes = tuple(str(note) for note in report.get("notes", ()))
        figures = {name: item for name, item in report.items() if name not in ("file", "notes")}
        self.outcome = ExportOutcome("", notes, figures)
