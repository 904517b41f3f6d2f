"""Exports a graph as an effect of ReShade, with the pictures that it reads beside it."""

from __future__ import annotations

import re

from ...resources.atomic_write import write_bytes_atomically, write_text_atomically
from ..game import assemble_for_game
from ..order import ExportOrder, ExportReport
from .effect import write_effect


def export_effect(order: ExportOrder) -> ExportReport:
    """Write the files. Raises GraphError, OutputError, and UsageError where the translator is missing."""
    output = order.output
    assert output is not None
    stem = re.sub(r"[^A-Za-z0-9_-]+", "_", output.stem)
    package = assemble_for_game(order, "an effect of ReShade", "an effect of ReShade makes of the sRGB picture")
    effect = write_effect(package, order, stem)
    for name, content in effect.files.items():
        write_bytes_atomically(output.with_name(name), content, sandbox=order.sandbox)
    write_text_atomically(output, effect.text, sandbox=order.sandbox)
    files = (str(output), *(str(output.with_name(name)) for name in effect.files))
    figures: dict[str, float | str] = {"passes": effect.passes, "files": len(files)}
    return ExportReport(files, effect.notes, figures)
