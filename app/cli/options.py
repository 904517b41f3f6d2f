"""Options that several commands have, and how a command opens its graph and its inputs."""

from __future__ import annotations

import functools
import inspect
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.sandbox import Sandbox, read_process_sandbox
from . import parsing
from .outcome import print_note

if TYPE_CHECKING:
    from ..graph import Graph

Inputs = Annotated[
    list[str] | None,
    typer.Option("-i", "--input", metavar="NAME=FILE[:LAYER]", help="Read an input of the graph from this picture."),
]
Sets = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NODE.VALUE=X",
        help="Set a value of a node, or a control by its name, to a number, a color (r,g,b,a), animation keys "
        "(1@1,4@24: value@frame) or an =expression.",
    ),
]
Node = Annotated[
    str,
    typer.Option(
        "--node", metavar="ID[.OUTPUT]", help="Use the output of this node instead of the outputs of the graph."
    ),
]
SizeText = Annotated[
    str | None,
    typer.Option("--size", metavar="WxH", help="Use this size for the canvas and the pictures instead of their own."),
]
Scale = Annotated[
    float,
    typer.Option(
        "--scale", metavar="X", help="Render a smaller proxy: 0.5 is half the size, and lengths in pixels shrink too."
    ),
]
Outputs = typer.Option(
    "-o", "--output", metavar="[NAME=]FILE", help="The file to write; an .exr holds all outputs as layers."
)
View = Annotated[
    str, typer.Option(help="OpenColorIO view of PNG, JPEG, TIFF, WebP and DPX files; 'none' for plain sRGB.")
]
OneFrame = Annotated[int | None, typer.Option(help="Use this frame; by default the first frame of the graph.")]
Frames = Annotated[
    str | None,
    typer.Option(metavar="1-24x2,40", help="Render these frames; write #### in the file name for the frame number."),
]
Precision = Annotated[
    str | None, typer.Option(metavar="half|float", help="Precision of the pixels between passes and in EXR files.")
]
PassPrecision = Annotated[
    str | None, typer.Option(metavar="half|float", help="Precision of the pixels between passes.")
]
Form = Annotated[
    str | None,
    typer.Option(
        metavar="fragment|compute",
        help="Run passes as fragment or as compute shaders; by default what is faster on the device.",
    ),
]
Memory = Annotated[
    str | None,
    typer.Option(
        metavar="SIZE", help="Memory that one frame may use, such as 512M or 2G; a larger frame is rendered in tiles."
    ),
]
Cluster = Annotated[
    str,
    typer.Option(
        "--cluster", metavar="ADDRESS", help="Share the work among the workers of a Dask scheduler, or of local:4."
    ),
]
PathMaps = Annotated[
    list[str] | None,
    typer.Option("--map", metavar="FROM=TO", help="Where workers have a folder that has another path there."),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object to standard output, for scripts.")]
Root = Annotated[
    Path | None,
    typer.Option("--root", metavar="FOLDER", help="Read and write only files in this folder and below."),
]


def locate_graph(text: str) -> Path:
    """The graph file that the user named by its path, or a preset by its name; "-" is standard input.

    Raises DocumentError with a suggestion for a name that is neither.
    """
    if text == "-" or (os.path.lexists(text) and not Path(text).is_dir()):
        return Path(text)
    from ..document import locating

    return locating.locate_graph(text)


def expand_preset(text: str) -> Path:
    """The path that the user named, or the file of a preset if there is no such path and a preset has this name."""
    if os.path.lexists(text):  # also a folder
        return Path(text)
    from ..custom_nodes.plugins import find_graph_or_preset

    return find_graph_or_preset(text)


GraphFile = Annotated[
    Path,
    typer.Argument(
        parser=locate_graph,
        metavar="GRAPH",
        help="A graph file (JSON), the name of a preset, or - for standard input.",
    ),
]


def add_root(command: Callable[..., int]) -> Callable[..., int]:
    """Give a command the option `--root`, which restricts all files that it reads and writes.

    This is the only place that adds the option and makes the sandbox, so no command can have one without the other.
    """

    @functools.wraps(command)
    def run(*args: Any, root: Root = None, **options: Any) -> int:
        outer = read_process_sandbox()
        return command(*args, sandbox=outer if root is None else outer.narrow(root), **options)

    signature = inspect.signature(command, eval_str=True)
    parameters = [parameter for name, parameter in signature.parameters.items() if name != "sandbox"]
    root_parameter = inspect.Parameter("root", inspect.Parameter.KEYWORD_ONLY, default=None, annotation=Root)
    run.__signature__ = signature.replace(parameters=[*parameters, root_parameter])  # type: ignore[attr-defined]
    annotations = {parameter.name: parameter.annotation for parameter in parameters}  # typer need not compile them too
    run.__annotations__ = {**annotations, "root": Root, "return": int}
    return run


def open_graph(
    path: Path, sets: Mapping[str, str] = MappingProxyType({}), document: str = "", *, sandbox: Sandbox
) -> Graph:
    """Load a graph and set the values of `--set` in it. Raises DocumentError, UsageError.

    The path "-" stands for the text `document`, or for standard input if that is empty; relative paths in it start at
    the current folder.
    """
    from ..document import load, loads

    graph = (
        loads(document or read_standard_input(), "-", sandbox=sandbox)
        if str(path) == "-"
        else load(path, sandbox=sandbox)
    )
    for name, text in sets.items():
        graph = override_value(graph, name, text)
    return graph


def override_value(graph: Graph, name: str, text: str) -> Graph:
    """The graph with one value set to what the user typed after `--set`. Raises UsageError."""
    from ..errors import GraphError, UsageError
    from ..graph import animation_fault

    value = parsing.parse_setting(text)
    try:
        graph = graph.override(name, value)
        for port, item in graph.animation.items():
            if item is value and (reason := animation_fault(graph, port, item)):
                raise GraphError(reason)
    except GraphError as fault:
        hint = _value_hint(graph, name) if name not in graph.controls else ""
        raise UsageError(f"--set {name}={text}: {str(fault).removeprefix(f'{name}: ')}{hint}") from None
    return graph


def _value_hint(graph: Graph, name: str) -> str:
    """How to write the values of this name that nodes of the graph have, or ""."""
    ports = [f"{id}.{name}" for id, node in graph.nodes.items() if name in getattr(type(node), "values", ())]
    return f"; write {' or '.join(ports[:3])}" if ports else ""


def read_standard_input() -> str:
    """The text of standard input. Raises DocumentError if it is not UTF-8, or larger than a graph file may be."""
    from ..document.limits import MAX_BYTES, size_fault
    from ..errors import DocumentError

    content = sys.stdin.buffer.read(MAX_BYTES + 1) if sys.stdin else b""
    if content and (fault := size_fault(len(content))):
        raise DocumentError("-", "", fault, rule="unreadable-graph")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise DocumentError("-", "", f"the text is not UTF-8 (byte {error.start}); save it as UTF-8") from None


def resolve_inputs(graph: Graph, inputs: Mapping[str, str]) -> dict[str, str]:
    """Files by the name of the input that they fill; a file without a name fills the only input. Raises UsageError."""
    from ..errors import UsageError
    from ..graph import did_you_mean

    files = dict(inputs)
    if file := files.pop("", ""):
        if len(graph.inputs) != 1:
            names = ", ".join(graph.inputs) or "none"
            raise UsageError(f"-i {file}: write -i NAME=FILE; the inputs of this graph are {names}")
        (name,) = graph.inputs
        if name in files:
            raise UsageError(f"-i {name}={file}: '{name}' is given twice")
        files[name] = file
    for name, file in files.items():
        if name not in graph.inputs:
            hint = did_you_mean(name, graph.inputs) or "; it has none"
            raise UsageError(f"-i {name}={file}: the graph has no input '{name}'{hint}")
        if _is_number(file) and not Path(file).exists():
            raise UsageError(f"-i {name}={file}: an input takes a file; set a number with --set NODE.VALUE={file}")
    return files


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def choose_output(graph: Graph, show: str, node: str) -> str:
    """The output that --show or --node names, else the first of the graph. Raises UsageError."""
    from ..errors import UsageError
    from ..graph import did_you_mean

    if node:
        if show:
            raise UsageError("--show and --node: choose one")
        return node
    if not graph.outputs:
        raise UsageError("the graph has no output to show: choose a node with --node")
    if show and show not in graph.outputs:
        raise UsageError(f"--show {show}: there is no output '{show}'{did_you_mean(show, graph.outputs)}")
    return show or next(iter(graph.outputs))


def report_problems(path: Path, graph: Graph) -> None:
    """Print the warnings of a graph. Raises GraphError that names the first error and counts the others."""
    from ..errors import GraphError
    from ..graph import problems

    graph_problems = problems(graph)
    errors = [problem for problem in graph_problems if problem.severity == "error"]
    # A misspelt link leaves an input without a picture. The sentence is about the link, which is the cause.
    errors.sort(key=lambda problem: problem.rule.name in ("unlinked-input", "unfed-output"))
    if errors:
        how = "" if str(path) == "-" else f": halation check {path}"
        for problem in graph_problems:
            if problem.rule.name == "unknown-key":  # a misspelt key is often why something else is missing
                print_note(f"{path}: {problem.sentence}")
        more = f" (and {len(errors) - 1} more{how})" if len(errors) > 1 else ""
        raise GraphError(f"{path}: {errors[0].sentence}{more}")
    for problem in graph_problems:
        print_note(f"{path}: {problem.sentence}")
