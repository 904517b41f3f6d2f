"""Exports a graph as an effect of ReShade, with the pictures that it reads beside it."""

from __future__ import annotations

import re

import msgspec

from ...color.management import get_color_manager
from ...errors import GraphError
from ...graph import color_settings
from ...resources.atomic_write import write_bytes_atomically, write_text_atomically
from ..game import USUAL_SIZE, bind_blank, refuse_layers
from ..order import ExportOrder, ExportReport
from ..package import assemble_package
from .effect import write_effect


def export_effect(order: ExportOrder) -> ExportReport:
    """Write the files. Raises GraphError, OutputError, and UsageError where the translator is missing."""
    output = order.output
    assert output is not None
    if not get_color_manager(color_settings(order.graph), order.sandbox).is_plain:
        raise GraphError(
            "its working space is not linear Rec.709, which an effect of ReShade makes of the sRGB picture"
        )
    refuse_layers(order.graph, order.target, "an effect of ReShade")
    stem = re.sub(r"[^A-Za-z0-9_-]+", "_", output.stem)
    size = order.size or USUAL_SIZE
    order = msgspec.structs.replace(order, size=size, inputs={**order.inputs, **bind_blank(order.graph, size)})
    effect = write_effect(assemble_package(order), order, stem)
    for name, content in effect.files.items():
        write_bytes_atomically(output.with_name(name), content, sandbox=order.sandbox)
    write_text_atomically(output, effect.text, sandbox=order.sandbox)
    files = (str(output), *(str(output.with_name(name)) for name in effect.files))
    figures: dict[str, float | str] = {"passes": effect.passes, "files": len(files)}
    return ExportReport(files, effect.notes, figures)
