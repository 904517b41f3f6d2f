"""`halation edit`: the desktop editor."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import typer

from ..resources.sandbox import Sandbox, read_process_sandbox
from . import parsing
from .options import Inputs, locate_graph, resolve_inputs

_Lesson = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help="Begin a lesson of the course: its name, or next for the first one that is not finished; list prints all.",
    ),
]


def edit(
    graph: Annotated[
        Path | None,
        typer.Argument(
            parser=locate_graph,
            metavar="[GRAPH]",
            help="A graph file (JSON), the name of a preset, or a picture, which a new graph reads; without one the "
            "start screen opens.",
        ),
    ] = None,
    inputs: Inputs = None,
    lesson: _Lesson = "",
    show_errors: Annotated[
        bool, typer.Option("--show-errors", hidden=True, help="Show an error in a window: a menu has no terminal.")
    ] = False,
) -> int:
    """Open the editor."""
    from ..errors import HalationError

    try:
        if lesson == "list":
            return _print_lessons()
        return _open_editor(graph, inputs, lesson)
    except HalationError as fault:
        if show_errors:
            from ..desktop import show_error

            show_error(str(fault))
        raise


def _open_editor(graph: Path | None, inputs: list[str] | None, lesson: str) -> int:
    from ..errors import UsageError

    if lesson and graph is not None:
        raise UsageError("--lesson brings a graph of its own: leave out the other one")
    if graph is None and inputs:
        raise UsageError("-i needs a graph: name the graph file too")
    sandbox = read_process_sandbox()
    bindings: dict[str, str] = {}
    if graph is not None and graph.suffix.lower() != ".json" and _is_picture(graph):
        if inputs:
            raise UsageError(f"{graph}: -i is for the inputs of a graph, and this is a picture: leave -i out")
        _check_is_there(graph, sandbox)
    elif graph is not None and inputs:
        from .. import document

        bindings = resolve_inputs(document.load(graph, sandbox=sandbox), parsing.parse_inputs(inputs))
    from ..editor import edit as open_editor

    try:
        open_editor(graph, bindings, sandbox, _find_lesson(lesson) if lesson else "")
    except ImportError as fault:
        raise name_missing_library(fault) from fault
    return 0


def name_missing_library(fault: ImportError) -> Exception:
    """What to tell of an import that failed: which library of the system is missing; else the fault itself."""
    from ..errors import DeviceError

    match = re.match(r"(lib[\w+-]+\.so[.\d]*): cannot open shared object file", str(fault))
    if not match:
        return fault
    return DeviceError(
        f"no window can be opened: the system has no {match[1]}: install the libraries of X11 and OpenGL "
        "(Debian and Ubuntu: libx11-6 libgl1 libegl1; Fedora: libX11 libglvnd-glx libglvnd-egl)"
    )


def _find_lesson(name: str) -> str:
    """The id of a lesson; for `next` that of the first one that is not finished. Raises UsageError."""
    from ..authoring.preferences import PreferenceStore
    from ..editor.tutorials.course import COURSE
    from ..errors import UsageError
    from ..graph import did_you_mean

    ids = [lesson.id for lesson in COURSE]
    if name == "next":
        finished = PreferenceStore().current.lessons
        return next((id for id in ids if id not in finished), ids[0])
    if name not in ids:
        raise UsageError(f"--lesson {name}: there is no such lesson{did_you_mean(name, ids)}")
    return name


def _print_lessons() -> int:
    from ..authoring.preferences import PreferenceStore
    from ..editor.tutorials.course import COURSE

    finished = PreferenceStore().current.lessons
    for number, lesson in enumerate(COURSE, 1):
        mark = "done" if lesson.id in finished else ""
        print(f"{number:>2}  {lesson.id:<19} {mark:<5} {lesson.doc}")
    return 0


def _is_picture(path: Path) -> bool:
    from ..media.pictures.file_endings import is_picture

    return is_picture(path)


def _check_is_there(path: Path, sandbox: Sandbox) -> None:
    """Raise InputError if there is no such picture, before a window opens."""
    from ..resources.input_files import check_file
    from ..watch.sequence_files import representative_file

    check_file(representative_file(path, sandbox=sandbox), sandbox)
