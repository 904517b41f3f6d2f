"""Exports a graph as one HTML page: the package, its pixels, and a player for WebGL 2. The page loads nothing."""

from __future__ import annotations

import html
import json
import re
import zlib
from base64 import b64encode

from ..compiler.explain import format_bytes
from ..document.about import find_about
from ..resources.atomic_write import write_text_atomically
from .order import ExportOrder, ExportReport
from .package import Package, assemble_package
from .package.curves import Record
from .package.dialects import write_es300
from .package.specialization import specialize_functions
from .shipped_files import read_shipped_text

SCRIPTS = ("read_package.js", "page_reader.js", "page_notes.js", "page.js")
"""The scripts of a page, each of which needs those before it."""

DRAFT_PIXELS = 240 * 135
"""Pixels of the first picture that a page shows of a larger one. SwiftShader, the slowest that draws WebGL 2, takes
0.3 s for a look with ten passes of that size, and 2 to 6 s for 960x540."""

_MODULE_WORDS = re.compile(r"^(export |import .*\n)", re.MULTILINE)
"""What joins modules that are files: a page has one script."""


def export_page(order: ExportOrder) -> ExportReport:
    """Write the page. Raises GraphError, OutputError."""
    assert order.output is not None
    package = assemble_package(order, draft_pixels=DRAFT_PIXELS)
    text = make_page(package, order)
    write_text_atomically(order.output, text, sandbox=order.sandbox)
    document = package.document
    figures: dict[str, float | str] = {
        "controls": len(document["controls"]),
        "passes": max(len(plan["passes"]) for variants in document["plans"] for plan in variants),
        "variants": sum(map(len, document["plans"])),
        "frames": document["frames"][1] - document["frames"][0] + 1,
        "pictures": format_bytes(sum(len(_pack(blob, 4)) for blob in package.blobs)),
        "page": format_bytes(len(text)),
    }
    return ExportReport((str(order.output),), package.notes, figures)


def make_page(package: Package, order: ExportOrder) -> str:
    """The page as text.

    Everything is packed into the page, because browsers let no page that was opened from disk read other files. Base64
    also keeps names and notes of the graph from ending the script.
    """
    document = package.document
    programs = [
        {"fragment": write_es300(specialize_functions(fragment)), "vertex": write_es300(vertex) if vertex else ""}
        for fragment, vertex in package.programs
    ]
    strides = _find_strides(package)
    written = {**document, "slots": [_turn_curves(slot) for slot in document["slots"]]}
    parts = {"document": written, "programs": programs, "notes": list(package.notes)}
    content = json.dumps(parts, separators=(",", ":"))
    packed = {
        "content": b64encode(zlib.compress(content.encode(), 9)).decode(),
        "blobs": [[strides[at], _pack(blob, strides[at])] for at, blob in enumerate(package.blobs)],
    }
    modules = "\n".join(read_shipped_text(name) for name in SCRIPTS)
    filled = {
        "TITLE": html.escape(order.name.replace("_", " ").capitalize()),
        "ABOUT": html.escape(find_about(order.graph).doc),
        "GENERATOR": f"Made by {document['made_by']}",
        "PACKAGE": json.dumps(packed, separators=(",", ":")),
        "SCRIPT": _MODULE_WORDS.sub("", modules),
    }
    # In one pass: a description may hold such marks itself.
    return re.sub(r"/\*([A-Z]+)\*/", lambda mark: filled[mark[1]], read_shipped_text("page.html"))


def _turn_curves(slot: Record) -> Record:
    """A slot whose curves have columns instead of rows, one for each number; one that stays the same is written once.

    Of a table of the outlines of a text that moves in time, most numbers stay the same.
    """
    curves: list[Record] = []
    for curve in slot.get("curves", ()):
        others = {name: part for name, part in curve.items() if name != "values"}
        columns = [column[0] if len(set(column)) == 1 else column for column in zip(*curve["values"], strict=True)]
        curves.append({**others, "columns": columns})
    return {**slot, "curves": curves} if curves else slot


def _find_strides(package: Package) -> list[int]:
    """The bytes of a number in each blob: bytes of equal weight side by side compress better."""
    strides = [4] * len(package.blobs)
    for source in package.document["sources"]:
        strides[source["blob"]] = 2 if source["format"].endswith("16f") else 4
    return strides


def _pack(blob: bytes, stride: int) -> str:
    """Pixels as text: one plane for each byte of a number, compressed."""
    planes = b"".join(blob[at::stride] for at in range(stride))
    return b64encode(zlib.compress(planes, 9)).decode()
