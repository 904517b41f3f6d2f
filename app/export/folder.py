"""Exports a graph as a folder: programs in four versions of GLSL, `passes.json`, pictures, and a reader."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from ..errors import OutputError
from ..resources.atomic_write import write_bytes_atomically, write_text_atomically
from ..resources.sandbox import Sandbox
from .order import ExportOrder, ExportReport
from .package import Package, assemble_package
from .package.dialects import COVERING_VERTEX, DIALECTS
from .shipped_files import read_shipped_text

READERS: Mapping[str, str] = MappingProxyType(
    {
        "read_package.py": "read_package.py.txt",
        "package_values.py": "package_values.py.txt",
        "read_package.js": "read_package.js",
        "README.md": "package_readme.md",
    }
)
"""Files of the folder that are the same for all graphs, and the assets that they are copies of."""


def export_folder(order: ExportOrder) -> ExportReport:
    """Write the folder. Raises GraphError, OutputError."""
    package = assemble_package(order)
    return write_package(order, package, list_texts(package), READERS)


def list_texts(package: Package) -> dict[str, str]:
    """The texts of the folder by their names in it, but for the readers."""
    texts: dict[str, str] = {"passes.json": json.dumps(package.document, separators=(",", ":")) + "\n"}
    for dialect, write in DIALECTS.items():
        texts[f"{dialect}/cover.vert"] = write(COVERING_VERTEX)
        for number, (fragment, vertex) in enumerate(package.programs):
            texts[f"{dialect}/{number}.frag"] = write(fragment)
            if vertex:
                texts[f"{dialect}/{number}.vert"] = write(vertex)
    return texts


def write_package(
    order: ExportOrder,
    package: Package,
    texts: Mapping[str, str],
    readers: Mapping[str, str] = MappingProxyType({}),
    pixels: str = "pixels/{}.bin",
) -> ExportReport:
    """Write texts by their names in the folder, pixels, and the assets that readers are. Raises OutputError.

    `pixels` is the name of a file of pixels, with braces for its number.
    """
    assert order.output is not None
    folder = order.output
    _make_folder(folder, order.sandbox)
    for name, text in {**texts, **{name: read_shipped_text(asset) for name, asset in readers.items()}}.items():
        write_text_atomically(_make_room(folder, name, order.sandbox), text, sandbox=order.sandbox)
    for number, blob in enumerate(package.blobs):
        write_bytes_atomically(_make_room(folder, pixels.format(number), order.sandbox), blob, sandbox=order.sandbox)
    passes = [len(plan["passes"]) for variants in package.document["plans"] for plan in variants]
    figures: dict[str, float | str] = {
        "programs": len(package.programs),
        "passes": max(passes),
        "variants": len(passes),
        "controls": len(package.document["controls"]),
    }
    return ExportReport((str(folder),), package.notes, figures)


def _make_room(folder: Path, name: str, sandbox: Sandbox) -> Path:
    """The path of a file in a folder, all folders of which are there."""
    for parent in reversed(Path(name).parents[:-1]):
        _make_folder(folder / parent, sandbox)
    return folder / name


def _make_folder(folder: Path, sandbox: Sandbox) -> None:
    if reason := sandbox.find_write_fault(folder):
        raise OutputError(f"{folder}: {reason}")
    try:
        folder.mkdir(parents=False, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: the folder cannot be made: {error.strerror}") from None
