"""Graph in, plan out. Pure: no OpenGL, no files.

Stages are folders, each a function of what the one before made: `lowering` turns nodes into operations, `fusion` groups
operations into passes, `shading` writes a GLSL program for a pass, `scheduling` finds formats, keys and slots, `parts`
plans for a part of a picture, or by tiles. `planner` runs them and remembers what holds for the next plan.
"""

from __future__ import annotations

from .areas import Region, scaled
from .explain import as_json, dot, explain
from .ir import MAX_WEIGHTS, Memory, Ref, StoredResult
from .library import Library, installed
from .lowering.named import named_files
from .lowering.upstream import Upstream
from .plan import FIRST_TABLE, Pass, Plan, Shader, Surface, Upload
from .planner import Planner, compile_graph, examine, graph_library
from .request import Request
from .target import NULL, Form, Precision, Target
from .tiling.tiles import Stage, Tiling
from .tiling.tiling import tile_plan
from .working import library_for

__all__ = [
    "FIRST_TABLE",
    "MAX_WEIGHTS",
    "NULL",
    "Form",
    "Library",
    "Memory",
    "Pass",
    "Plan",
    "Planner",
    "Precision",
    "Ref",
    "Region",
    "Request",
    "Shader",
    "Stage",
    "StoredResult",
    "Surface",
    "Target",
    "Tiling",
    "Upload",
    "Upstream",
    "as_json",
    "compile_graph",
    "dot",
    "examine",
    "explain",
    "graph_library",
    "installed",
    "library_for",
    "named_files",
    "scaled",
    "tile_plan",
]
