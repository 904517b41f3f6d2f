"""Exports a graph as one shader in the Interactive Shader Format."""

from __future__ import annotations

from ..compiler.isf import export_isf
from ..errors import GraphError, describe_owner
from ..inputs.lazy_provider import LazyResourceProvider
from ..resources.atomic_write import write_text_atomically
from .order import ExportOrder, ExportReport


def export_shader(order: ExportOrder) -> ExportReport:
    """Write the shader, or return its text. Raises GraphError with the first reason where there can be none."""
    shader = export_isf(order.graph, order.target, LazyResourceProvider(order.sandbox), size=order.size)
    if shader.reasons:
        reasons = [f"{describe_owner(owner) if owner else 'it'} {why}" for owner, why in shader.reasons]
        others = f"; {'; '.join(reasons[1:])}" if len(reasons) > 1 else ""
        raise GraphError(f"it cannot be written as one shader: {reasons[0]}{others}", node=shader.reasons[0][0])
    if order.output is None:
        return ExportReport(notes=shader.notes, text=shader.text)
    write_text_atomically(order.output, shader.text, sandbox=order.sandbox)
    return ExportReport((str(order.output),), shader.notes)
