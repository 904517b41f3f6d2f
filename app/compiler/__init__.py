"""Graph in, plan out. Pure: no OpenGL, no files.

Stages, each a function of what the one before made: `expand` flattens groups, `lower` turns nodes into operations,
`fuse` groups operations into passes, `merge` makes one of passes that read the same, `emit` writes a GLSL program per
pass, `schedule` finds formats, keys and slots.
"""

from __future__ import annotations

from ..glsl import parse
from .areas import Region
from .bodies import MAX_WEIGHTS
from .explain import as_json, dot, explain
from .ir import Held, Memory, Picture, Read, Ref
from .library import Library, installed
from .named import named_files
from .outside import Frame, Outside, Probed
from .plan import FIRST_TABLE, Pass, Plan, Shader, Surface, Upload
from .planner import Planner, compile_graph, examine, graph_library
from .raster import ATTRIBUTES, Mesh
from .recolor import ColorProgram, Table
from .request import Request
from .target import NULL, Form, Precision, Target
from .tiles import Stage, Tiling
from .tiling import tile_plan
from .upstream import Upstream
from .working import Working, library_for

__all__ = [
    "ATTRIBUTES", "FIRST_TABLE", "MAX_WEIGHTS", "NULL", "ColorProgram", "Form", "Frame", "Held", "Library", "Memory",
    "Mesh", "Outside", "Pass", "Picture", "Plan", "Planner", "Precision", "Probed", "Read", "Ref", "Region", "Request",
    "Shader", "Stage", "Surface", "Table", "Target", "Tiling", "Upload", "Upstream", "Working", "as_json",
    "compile_graph", "dot", "examine", "explain", "graph_library", "installed", "library_for", "named_files", "parse",
    "tile_plan",
]
