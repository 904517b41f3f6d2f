"""Flags and steps that several commands share."""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import parsing
from .outcome import note

if TYPE_CHECKING:
    from halation.nodes import ColorChange, ColorSettings, Missing, Render, Scene

    from ..graph import Graph
    from ..inputs.provider import MediaProvider
    from ..resources.color_program import ColorProgram
    from ..resources.mesh import Mesh
    from ..resources.picture import Picture
    from ..resources.provider import FrameFile, PictureProbe
    from ..resources.working_space import WorkingSpace

Inputs = Annotated[
    list[str] | None,
    typer.Option("-i", "--input", metavar="NAME=FILE[:LAYER]", help="Bind an input of the graph to a picture."),
]
Sets = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NODE.VALUE=X",
        help="Set a value, or a control by its name: a number, r,g,b,a, keys as 1@1,4@24, or =expression.",
    ),
]
Node = Annotated[
    str, typer.Option("--node", metavar="ID[.OUTPUT]", help="Take the output of this node instead of the graph's.")
]
SizeText = Annotated[
    str | None, typer.Option("--size", metavar="WxH", help="Size of canvas and pictures, instead of their own.")
]
Scale = Annotated[
    float, typer.Option("--scale", metavar="X", help="Render a proxy: 0.5 is half size, lengths in pixels included.")
]
OneFrame = Annotated[int | None, typer.Option(help="The one frame to render; by default the first of the graph.")]
Frames = Annotated[
    str | None,
    typer.Option(metavar="1-24x2,40", help="The frames to render; the file's name has #### for the number."),
]
Precision = Annotated[
    str | None, typer.Option(metavar="half|float", help="Precision of intermediates and of EXR files.")
]
Form = Annotated[
    str | None, typer.Option(metavar="fragment|compute", help="How passes run; by default what suits the device.")
]
Memory = Annotated[
    str | None,
    typer.Option(metavar="SIZE", help="Bytes that a frame may take, as 512M or 2G: what is larger is made by tiles."),
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, for machines.")]
Root = Annotated[
    Path | None,
    typer.Option("--root", metavar="FOLDER", help="Read and write nothing that does not lie below this folder."),
]
GraphFile = Annotated[Path, typer.Argument(help="A graph, as JSON; - reads it from standard input.")]


def rooted(command: Callable[..., int]) -> Callable[..., int]:
    """The same command with the flag `--root`, which holds for all that it reads and writes."""

    @functools.wraps(command)
    def run(*args: Any, root: Root = None, **options: Any) -> int:
        from ..resources.sandbox import fenced

        with fenced(root):
            return command(*args, **options)

    known = inspect.signature(command, eval_str=True)
    flag = inspect.Parameter("root", inspect.Parameter.KEYWORD_ONLY, default=None, annotation=Root)
    run.__signature__ = known.replace(parameters=[*known.parameters.values(), flag])  # type: ignore[attr-defined]
    run.__annotations__ = {**command.__annotations__, "root": Root}
    return run


def opened(path: Path, sets: Sequence[str]) -> Graph:
    """A graph with the values from the command line. Raises DocumentError, UsageError.

    The paths in one from standard input start at the current folder.
    """
    from .. import document

    piped = str(path) == "-"
    graph = document.loads(standard_input(), "-") if piped else document.load(path)
    for name, text in parsing.assignments(sets, "--set").items():
        graph = changed(graph, name, text)
    return graph


def changed(graph: Graph, name: str, text: str) -> Graph:
    """A graph with one value set as `--set` has it. Raises UsageError."""
    from ..errors import GraphError, UsageError
    from ..graph import animation_fault

    value = parsing.setting(text)
    try:
        graph = graph.override(name, value)
        for port, item in graph.animation.items():
            if item is value and (said := animation_fault(graph, port, item)):
                raise GraphError(said)
    except GraphError as fault:
        raise UsageError(f"--set {name}={text}: {str(fault).removeprefix(f'{name}: ')}") from None
    return graph


def standard_input() -> str:
    """All of it. Raises DocumentError."""
    from ..errors import DocumentError

    try:
        return sys.stdin.buffer.read().decode("utf-8-sig") if sys.stdin else ""
    except UnicodeDecodeError as error:
        raise DocumentError("-", "", f"the text is not UTF-8 (byte {error.start}); save it as UTF-8") from None


def bound(graph: Graph, inputs: Sequence[str]) -> dict[str, str]:
    """Pictures by input name; a bare path goes to the only input."""
    from ..errors import UsageError
    from ..graph import did_you_mean

    named: list[str] = []
    for item in inputs:
        if "=" in item:
            named.append(item)
        elif len(graph.inputs) == 1:
            named.append(f"{next(iter(graph.inputs))}={item}")
        else:
            known = ", ".join(graph.inputs) or "none"
            raise UsageError(f"-i {item}: write -i NAME=FILE; the inputs of this graph are {known}")
    found = parsing.assignments(named, "-i")
    for name, text in found.items():
        if name not in graph.inputs:
            hint = did_you_mean(name, graph.inputs) or "; it has none"
            raise UsageError(f"-i {name}={text}: the graph has no input '{name}'{hint}")
    return found


def report_problems(path: Path, graph: Graph) -> None:
    """Stop at errors, mention warnings. Raises GraphError that names the first error and counts the others."""
    from ..errors import GraphError
    from ..graph import problems

    found = problems(graph)
    errors = [problem for problem in found if problem.severity == "error"]
    if errors:
        how = "" if str(path) == "-" else f": halation check {path}"
        more = f" (and {len(errors) - 1} more{how})" if len(errors) > 1 else ""
        raise GraphError(f"{path}: {errors[0].sentence}{more}")
    for problem in found:
        note(f"{path}: {problem.sentence}")


class LazyResourceProvider:
    """The world outside of graphs that may not need it: what reads files is loaded when the first is asked for."""

    @cached_property
    def pictures(self) -> MediaProvider:
        """The real ones."""
        from ..inputs.provider import MediaProvider

        return MediaProvider()

    def bind(self, graph: Graph, inputs: Sequence[str]) -> dict[str, Picture]:
        """Pictures for the graph inputs that the command line names."""
        found = bound(graph, inputs)
        return self.pictures.bind(graph, found) if found else {}

    def frames(self, graph: Graph, inputs: Sequence[str]) -> tuple[int, int]:
        """The first and last frame of a graph, without reading any file where it says so itself."""
        from ..compiler import named_files
        from ..graph import keyed_range

        if graph.settings.frames:
            return graph.settings.frames
        if not inputs and not named_files(graph, {}):
            return keyed_range(graph)
        return self.pictures.frames(graph, self.bind(graph, inputs))

    def check_frames(self, graph: Graph, frames: range) -> None:
        """Raise InputError for a file that is missing in a sequence."""
        from ..compiler import named_files

        if named_files(graph, {}):
            self.pictures.check_frames(graph, frames)

    def at(self, path: str, frame: int, missing: Missing) -> FrameFile:
        """The file of a frame."""
        return self.pictures.at(path, frame, missing)

    def probe(self, picture: Picture) -> PictureProbe:
        """Size and precision of a picture."""
        return self.pictures.probe(picture)

    def recolor(self, change: ColorChange) -> ColorProgram:
        """The program of a change of color."""
        return self.pictures.recolor(change)

    def working(self, color: ColorSettings) -> WorkingSpace | None:
        """What shaders know of the working space."""
        return self.pictures.working(color)

    def render(self, path: str, named: Mapping[str, str]) -> Render:
        """What the file of a render holds."""
        return self.pictures.render(path, named)

    def mesh(self, scene: Scene) -> Mesh:
        """The triangles of a scene."""
        return self.pictures.mesh(scene)
