"""Graph in, plan out. Pure: no OpenGL, no files.

Stages, each a function of what the one before made: `expand` flattens groups, `lower` turns nodes into operations,
`fuse` groups operations into passes, `emit` writes a GLSL program per pass, `schedule` finds formats, keys and slots.
"""

from __future__ import annotations

from ..glsl import parse
from ..graph import Graph, color_settings
from .bodies import MAX_WEIGHTS
from .expand import written_texts
from .explain import as_json, dot, explain
from .fuse import fuse
from .ir import Memory, Picture
from .library import Library, installed
from .lower import lower
from .named import named_files
from .outside import Frame, Outside, Probed
from .plan import FIRST_TABLE, Pass, Plan, Shader, Surface, Upload
from .raster import ATTRIBUTES, Mesh
from .recolor import ColorProgram, Table
from .request import Request
from .schedule import check_limits, schedule
from .target import NULL, Form, Precision, Target
from .upstream import Upstream
from .working import Working, library_for

__all__ = [
    "ATTRIBUTES", "FIRST_TABLE", "MAX_WEIGHTS", "NULL", "ColorProgram", "Form", "Frame", "Library", "Memory", "Mesh",
    "Outside", "Pass", "Picture", "Plan", "Precision", "Probed", "Request", "Shader", "Surface", "Table", "Target",
    "Upload", "Upstream", "Working", "as_json", "compile_graph", "dot", "examine", "explain", "installed",
    "library_for", "named_files", "parse",
]


def compile_graph(
    graph: Graph, request: Request, outside: Outside, *, target: Target = NULL, precision: Precision | None = None,
    library: Library | None = None, fusion: bool = True,
) -> Plan:
    """Compile what `request` wants of `graph` for `target`.

    Raises GraphError for a graph that cannot be rendered, InputError (from `outside`) for a file that cannot
    be read, DeviceError for one that is too large, ShaderError for a node and its GLSL that do not agree.
    """
    library = graph_library(graph, outside, library)
    program = lower(graph, request, library, outside)
    passes = fuse(program, target, enabled=fusion)
    return schedule(program, passes, library, target, precision or target.precision)


def examine(graph: Graph, request: Request, outside: Outside, target: Target = NULL) -> None:
    """Raise what `compile_graph` would raise, in half of the time: no program is written."""
    program = lower(graph, request, graph_library(graph, outside), outside)
    check_limits(program, fuse(program, target), target)


def graph_library(graph: Graph, outside: Outside, library: Library | None = None) -> Library:
    """The shaders that a graph can use: the installed ones for its working space, and its own."""
    working = outside.working(color_settings(graph)) if graph.settings.color.working else None
    return library_for(library or installed(), working).including(written_texts(graph))
