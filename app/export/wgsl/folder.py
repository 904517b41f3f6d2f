"""Exports a graph as a folder: programs in WGSL, `passes.json` with their interfaces, pictures, and a reader."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import msgspec

from ...errors import UsageError
from ...renderer.execution.progress_beacon import ProgressBeacon
from ..folder import write_package
from ..order import ExportOrder, ExportReport
from ..package import Package, assemble_package
from ..package.dialects import COVERING_VERTEX
from .translation import WgslProgram, write_wgsl

READERS: Mapping[str, str] = MappingProxyType(
    {"read_wgsl.py": "read_wgsl.py.txt", "package_values.py": "package_values.py.txt", "README.md": "wgsl_readme.md"}
)
"""Files of the folder that are the same for all graphs, and the assets that they are copies of."""


def export_wgsl(order: ExportOrder) -> ExportReport:
    """Write the folder. Raises GraphError, OutputError, and UsageError where the translator is missing."""
    package = assemble_package(order)
    return write_package(order, package, _list_texts(package), READERS)


def _list_texts(package: Package) -> dict[str, str]:
    texts = {"wgsl/cover.vert.wgsl": _translate(COVERING_VERTEX, "vertex", 0).text}
    interfaces: list[Any] = []
    beacon, nodes = ProgressBeacon(), _find_nodes(package)
    for number, (fragment, vertex) in enumerate(package.programs):
        with beacon.announce(nodes.get(number, ())):  # code of a user may keep the translator busy
            programs = {"fragment": _translate(fragment, "fragment", number)}
            if vertex:
                programs["vertex"] = _translate(vertex, "vertex", number)
        texts |= {f"wgsl/{number}.{stage[:4]}.wgsl": program.text for stage, program in programs.items()}
        interfaces.append({stage: msgspec.to_builtins(program.interface) for stage, program in programs.items()})
    document = {**package.document, "interfaces": interfaces}
    return texts | {"passes.json": json.dumps(document, separators=(",", ":")) + "\n"}


def _find_nodes(package: Package) -> dict[int, tuple[str, ...]]:
    """The nodes whose code is in each program."""
    plans = [plan for variants in package.document["plans"] for plan in variants]
    return {each["program"]: tuple(each["nodes"]) for plan in plans for each in plan["passes"]}


def _translate(text: str, stage: str, number: int) -> WgslProgram:
    try:
        return write_wgsl(text, stage)
    except ValueError as error:
        raise UsageError(f"program {number} of the graph cannot be written in WGSL: {error}") from None
