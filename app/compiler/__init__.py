"""Graph in, plan out. Pure: no OpenGL, no files.

Stages are folders, each a function of what the one before made: `lowering` turns nodes into operations, `fusion` groups
operations into passes, `shading` writes a GLSL program for a pass, `scheduling` finds formats, keys and slots, `parts`
plans for a part of a picture, or by tiles. `planner` runs them and remembers what holds for the next plan.
"""

from __future__ import annotations

from .areas import Region, scale_size
from .explain import as_json, explain, write_dot
from .ir import MAX_WEIGHTS, Memory, Ref, StoredResult
from .library import Library, installed_library
from .lowering.named import find_named_files
from .lowering.upstream import Upstream
from .plan import FIRST_TABLE, Pass, Plan, Shader, Surface, Upload
from .planner import Planner, compile_graph, examine, graph_library
from .request import Request
from .target import NULL, Form, Precision, Target
from .tiling.tiles import TileStage, Tiling
from .tiling.tiling import plan_tile
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
    "StoredResult",
    "Surface",
    "Target",
    "TileStage",
    "Tiling",
    "Upload",
    "Upstream",
    "as_json",
    "compile_graph",
    "examine",
    "explain",
    "find_named_files",
    "graph_library",
    "installed_library",
    "library_for",
    "plan_tile",
    "scale_size",
    "write_dot",
]
