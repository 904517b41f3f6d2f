"""Writes what a fit has found as one HTML page that needs no other file: pictures, errors and values."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from importlib import resources
from pathlib import Path

import numpy as np

from ..color.display import NO_VIEW
from ..media.comparison.contact_sheet import make_sheet
from ..media.comparison.metrics import Array, amplify_difference
from ..media.pictures.stored import StoredPart, encode_for_viewing, encode_png
from ..resources.atomic_write import write_text_atomically
from ..resources.sandbox import Sandbox
from ..version import VERSION
from .results import FitResult

_CELL = 480
"""Pixels across of a picture of the strip, as in sweeps."""


def write_fit_report(result: FitResult, title: str, path: Path, sandbox: Sandbox) -> None:
    """Write the page, whole or not at all. Raises OutputError."""
    write_text_atomically(path, make_fit_page(result, title), sandbox=sandbox)


def make_fit_page(result: FitResult, title: str) -> str:
    """The page as text."""
    rows = (
        f"<tr{'' if item.is_determined else ' class=weak'}><td>{escape(item.name)}</td><td>{item.before:.5g}</td>"
        f"<td>{item.after:.5g}</td><td>{item.low:.5g} to {item.high:.5g}</td><td>{item.curvature:.3g}"
        f"{'' if item.is_determined else ', weak'}</td></tr>"
        for item in result.values
    )
    strip = encode_for_viewing(StoredPart(make_strip(result), ("R", "G", "B"), is_encoded=False), NO_VIEW)
    filled = {
        "GENERATOR": f"Halation {VERSION}",
        "TITLE": escape(title),
        "ABOUT": escape(f"{describe_errors(result)}; {result.renders} renders in {result.seconds:.1f} s"),
        "STRIP": f"data:image/png;base64,{b64encode(encode_png(strip)).decode()}",
        "ROWS": "\n".join(rows),
    }
    text = resources.files(__package__ or "").joinpath("report.html").read_text("utf-8")
    for name, part in filled.items():
        text = text.replace(f"/*{name}*/", part)
    return text


def make_strip(result: FitResult) -> Array:
    """The pictures before, wanted and after beside each other, and what is left of the difference: light [h, w, 3]."""
    pictures = {"before": result.before, "reference": result.reference, "after": result.after}
    if result.delta_e:
        pictures["difference that is left, 4 x"] = amplify_difference(result.after, result.reference, 4.0)
    shown = {name: np.clip(light, 0.0, 1.0).astype(np.float32) for name, light in pictures.items()}
    return make_sheet(shown, len(shown), _CELL)


def describe_errors(result: FitResult) -> str:
    """The difference from the reference before and after the search, in words."""
    if result.delta_e:
        before, after = result.delta_e
        return f"mean color difference {before:.2f} -> {after:.2f} (CIEDE2000; 1 can just be seen)"
    before, after = result.errors
    return f"difference of looks {before:.2f} -> {after:.2f}"
