"""A graph as passes that other programs run: programs, pictures, and the numbers of every uniform.

A plan of the compiler holds all that a renderer does for one frame. A package holds the plans of *all* settings of the
controls, because the compiler is not there when it runs. Nothing here knows what a node does. The graph is planned
again and again with other values of its controls, and the plans are compared:

- `compiler.knobs` are the numbers that a user may change: components of controls, and the frame.
- `planning` plans the graph at points; `sampling` takes plans apart, and chooses more points where a number bends.
- A control that changes only numbers gives each uniform a curve: a polygon through the samples (`curves`). Where two
  knobs change one number, their curves are added or multiplied, whichever predicts other points.
- A control that changes passes, such as the size of a blur, gives *variants*: spans of the knob with passes of their
  own (`variants`).
- At a special value a node may do nothing, such as a gain of 1. Then a sample beside it stands for it, because the
  passes that are there anyway do nothing at that value either.
- What a node remembers of the frame before makes a second plan, for all frames after the first one.
- `assembly` puts all together; `parts` writes once what plans have in common.

`dialects` writes the programs in other versions of GLSL.
"""

from __future__ import annotations

from .assembly import Package, assemble_package

__all__ = ["Package", "assemble_package"]
