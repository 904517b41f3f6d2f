"""A rendering to files as one value: built once, run in this process or sent as JSON to others.

The command line, the render queue of the editor and helper processes all speak of the same `RenderJob`. It holds what
decides which pixels are made and where they go. How progress is shown is not part of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from msgspec import field

from ...graph.frames import is_video
from ...resources.program import module_command
from ...resources.render_choices import DEFAULT_TIMEOUT, Dither
from ...resources.sandbox import Sandbox
from ...resources.struct_json import parse_struct
from .picture_settings import PictureSettings
from .render_entry import RenderEntry


class RenderJob(PictureSettings, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """What to render of which graph, how, and into which files.

    `graph` is the path of a graph file; "-" stands for the text in `document`, whose relative paths start at the
    current folder. `inputs` are files by the name of an input of the graph, where "" stands for its only one. `sets`
    are the texts of `--set` by the name of what they set. `destinations` are pairs of an output's name and a file; the
    name "" stands for all outputs.
    """

    sandbox: Sandbox
    """Which files may be read and written, wherever the job runs."""
    graph: str = "-"
    document: str = ""
    inputs: Mapping[str, str] = field(default_factory=dict[str, str])
    sets: Mapping[str, str] = field(default_factory=dict[str, str])
    frames: tuple[int, ...] = ()
    """Without any: all frames of the graph where a file's name has a place for the number, else the first."""
    memory: int = 0
    """Bytes that a frame may take; 0 for as many as there are."""
    deterministic: bool = False
    destinations: tuple[tuple[str, str], ...] = ()
    entries: tuple[RenderEntry, ...] = ()
    """Many files, each with inputs, values and destinations of its own instead of those of the job."""
    codec: str = ""
    dither: Dither = "blue"
    burn_in: bool = False
    """Write file, timecode and frame over every picture."""
    resume: bool = False
    processes: int = 1
    """How many processes share the frames; 0 for as many as are fastest."""
    timeout: float = DEFAULT_TIMEOUT
    """Seconds that a pass of code in the graph may take; 0 for no limit."""

    @property
    def files(self) -> tuple[tuple[str, Path], ...]:
        """The destinations, with paths."""
        return tuple((name, Path(path)) for name, path in self.destinations)

    @property
    def videos(self) -> tuple[Path, ...]:
        """The files that hold all frames."""
        destinations = (*self.destinations, *(pair for entry in self.entries for pair in entry.destinations))
        return tuple(Path(path) for _, path in destinations if is_video(path))

    @staticmethod
    def from_json(text: str) -> RenderJob:
        """The job in a text of `to_json`. Raises UsageError for any other text."""
        return parse_struct(text, RenderJob, "standard input is not a render job")


def worker_command() -> list[str]:
    """The command of a process that reads a job as JSON from standard input and renders it.

    It writes a line of JSON on standard error for every pass and frame, and a report as JSON on standard output. With
    `-P`, modules that lie beside a graph are not imported.
    """
    return [*module_command("halation.cli"), "worker"]
