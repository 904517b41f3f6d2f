"""Writes a graph in the formats of other programs, so that a look works where Halation is not installed.

A *kind* is one format (`kinds`): shaders that other programs play, tables of colors, passes of GLSL. A kind is a module
with one function, which takes an `ExportOrder` and writes files. It refuses a graph that its format cannot hold, and
names the node and the reason. `halation export` chooses a kind and prints its report.
"""

from __future__ import annotations

from .kinds import KINDS, ExportKind, choose_kind
from .order import ExportOrder, ExportReport, TableOptions

__all__ = ["KINDS", "ExportKind", "ExportOrder", "ExportReport", "TableOptions", "choose_kind"]
