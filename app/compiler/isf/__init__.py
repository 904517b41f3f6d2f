"""Writes a graph as one shader in the Interactive Shader Format (ISF), for programs that play such shaders.

A shader of this format is GLSL with a head of JSON, which declares inputs, passes and the sizes of their buffers. The
compiler already turns a graph into operations and joins them into passes, so the export starts from its program:

1. `export` lowers the graph and fuses the operations, as for a render. It stops with a list of reasons where an
   operation does what the format cannot: it draws a mesh, reads a file or remembers earlier frames.
2. `model` finds out which numbers of the program the controls, the frame and the size of the picture decide.
3. `passes` writes each pass as a function, with the same code generation as a render. Pictures are read by functions
   (`read_NAME`), and what a render sets as a uniform is set at the start of the function.
4. `writing` joins the functions, chooses the buffers, and writes `main`, which calls the function of `PASSINDEX`.

**Why controls are measured, not followed.** A value of a node reaches the program through Python: the node converts
units, computes weights or chooses passes. Such code cannot be written as GLSL. So the graph is lowered again with
other values, and the programs are compared (`affine`). A *knob* is one number that the user may change: a component of
a control, the frame, the width or the height. If a knob changes only constants, and these follow a straight line, then
each constant is written as a formula of the knobs: a sum of the knobs, and of products of two knobs, times a factor.
The formula is checked at points that were not used to find it. If a knob changes more than that, such as the number of
passes, it is *held*: the shader keeps the value that the graph has, and a note tells the user.

Sizes of buffers are found in the same way, as `floor((width + a) / b)`: this is what proxies and pyramids need.

No node has to know about this export, and a new node needs no code here. In return the export lowers the graph a few
times for each knob: 0.2 s of processor time for the largest preset.
"""

from __future__ import annotations

from .export import IsfExport, export_isf

__all__ = ["IsfExport", "export_isf"]
