"""The compiler: a graph in, a plan out. Pure: no OpenGL, no files.

Each stage is a folder, and a function of what the stage before made: `lowering` turns nodes into operations (`ir`),
`fusion` groups operations into passes, `codegen` writes a GLSL program for each pass, `scheduling` finds formats, keys
and textures, and `tiling` plans a part of a picture, or one that does not fit. The start of each folder says how it
works, and why so. `planner` runs the stages and remembers what holds for the next plan.

What is asked of the compiler is a `Request`, and a `Target` says what the device can do. The result is a `Plan`: frozen
data, of which the renderer needs nothing else. `isf` writes a graph as one shader of another format instead.
"""

from __future__ import annotations

from .areas import Region, scale_size
from .codegen.forms import LOCAL_SIZE
from .explain import explain, plan_as_json, write_dot
from .ir import MAX_WEIGHTS, Memory, Ref, StoredResult
from .lengths import ResolvedLength, resolve_lengths
from .library import Library, load_library
from .lowering.references import find_named_files
from .lowering.upstream import UpstreamHashes
from .plan import FIRST_TABLE, HostTask, Pass, Plan, Shader, Surface, Upload
from .planner import Planner, compile_graph, examine, graph_library
from .request import Request
from .target import NULL, Form, Precision, Target
from .tiling.tiles import TileStage, Tiling
from .tiling.tiling import plan_tile

__all__ = [
    "FIRST_TABLE",
    "LOCAL_SIZE",
    "MAX_WEIGHTS",
    "NULL",
    "Form",
    "HostTask",
    "Library",
    "Memory",
    "Pass",
    "Plan",
    "Planner",
    "Precision",
    "Ref",
    "Region",
    "Request",
    "ResolvedLength",
    "Shader",
    "StoredResult",
    "Surface",
    "Target",
    "TileStage",
    "Tiling",
    "Upload",
    "UpstreamHashes",
    "compile_graph",
    "examine",
    "explain",
    "find_named_files",
    "graph_library",
    "load_library",
    "plan_as_json",
    "plan_tile",
    "resolve_lengths",
    "scale_size",
    "write_dot",
]
