"""The intermediate representation: what a graph is lowered to, and what all later stages work on.

A graph becomes a list of operations in static single assignment form: each operation makes one or more pictures, each
picture is made once, and an operation reads pictures by `Ref` (the number of an operation and of its output). There are
only a dozen kinds of operations (`operations`), however many nodes there are: a pointwise function (`Call`), a function
that looks around (`Gather`), a convolution along one axis, a reduction, a program from outside, a drawn mesh, a
program on the processor, and sources, which no pass makes.

Operations are immutable values, compared by their fields. So common subexpressions need no pass of their own: a
`Builder` that is given an equal operation again returns the first one. An operation refers only to operations before
it, so the list is in an order in which it can be run.

What the later stages must know of a kind of operation, the operation says itself (`operation`): which region of its
inputs a region of its output needs (its footprint), what identifies it, whether it may share a pass, what it is called.
So a new kind of operation is a class here, and a writer of its GLSL in `codegen`: no other stage asks for kinds.

Numbers are kept apart from structure. A `UniformConstant` becomes a uniform and never changes the text of a shader, a
`Choice` does. `Op.without_numbers` is the structure alone: while a slider is dragged, the structure stays, and so do
passes, programs and textures (see `scheduling`).

What identifies an operation is derived from its fields (`identity`), because the keys of results are: equal keys mean
equal pixels, and a field that a hash forgets would show stale pixels.
"""

from __future__ import annotations

from .formula_call import FormulaCall
from .opaque_programs import ExternalProgram, HostCall, OpaqueProgram
from .operation import Op, SourceOp
from .operations import (
    BLOCK,
    EDGES,
    MAX_TAPS,
    MAX_WEIGHTS,
    Call,
    ColorCall,
    Convolve,
    FunctionOp,
    Gather,
    HistoryRead,
    Placement,
    Raster,
    Read,
    Reduce,
    StoredResult,
)
from .program import Builder, LoweredProgram
from .values import Accessor, Choice, Memory, Operand, Parameter, PictureShape, PlannedObject, Ref, UniformConstant

__all__ = [
    "BLOCK",
    "EDGES",
    "MAX_TAPS",
    "MAX_WEIGHTS",
    "Accessor",
    "Builder",
    "Call",
    "Choice",
    "ColorCall",
    "Convolve",
    "ExternalProgram",
    "FormulaCall",
    "FunctionOp",
    "Gather",
    "HistoryRead",
    "HostCall",
    "LoweredProgram",
    "Memory",
    "Op",
    "OpaqueProgram",
    "Operand",
    "Parameter",
    "PictureShape",
    "Placement",
    "PlannedObject",
    "Raster",
    "Read",
    "Reduce",
    "Ref",
    "SourceOp",
    "StoredResult",
    "UniformConstant",
]
