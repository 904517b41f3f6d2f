"""Exports a graph as a folder that draws it over what a camera of Godot sees."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from types import MappingProxyType

import msgspec
import numpy as np

from ...color.management import get_color_manager
from ...document.about import find_about
from ...errors import GraphError, describe_owner
from ...graph import color_settings
from ..engine_text import write_name
from ..folder import write_package
from ..game import USUAL_SIZE, bind_blank, choose_roles, refuse_layers
from ..order import ExportOrder, ExportReport
from ..package import Package, assemble_package
from ..package.curves import Record
from ..shipped_files import read_shipped_text
from .script import write_script
from .shaders import write_shader, write_takers

READERS: Mapping[str, str] = MappingProxyType(
    {"halation_effect.gd": "godot_effect.gd", "halation_numbers.gd": "godot_numbers.gd"}
)
"""Files of the folder that are the same for all graphs, and the assets that they are copies of."""


def export_godot(order: ExportOrder) -> ExportReport:
    """Write the folder. Raises GraphError, OutputError."""
    if not get_color_manager(color_settings(order.graph), order.sandbox).is_plain:
        raise GraphError("its working space is not linear Rec.709, which is the light of Godot")
    refuse_layers(order.graph, order.target, "an effect of Godot")
    size = order.size or USUAL_SIZE
    inputs = {**order.inputs, **bind_blank(order.graph, size)}
    package = _widen_tables(assemble_package(msgspec.structs.replace(order, size=size, inputs=inputs)))
    _refuse_meshes(package.document)
    return write_package(order, package, _list_texts(order, package), READERS)


def _list_texts(order: ExportOrder, package: Package) -> dict[str, str]:
    document = package.document
    programs = [write_shader(fragment) for fragment, _ in package.programs]
    surfaces = (surface for plan in _list_plans(document) for surface in plan["surfaces"])
    roles = choose_roles(order.graph, document["sources"], {each["source"] for each in surfaces if "source" in each})
    facts = {
        **document,
        "roles": {str(number): role for number, role in roles.items()},
        "interfaces": [msgspec.to_builtins(interface) for _, interface in programs],
    }
    script = f"{write_name(order.name, 'halation')}.gd"
    plan = document["plans"][-1][0]
    width, height = plan["surfaces"][plan["output"]]["size"]
    about = find_about(order.graph).doc or order.name.replace("_", " ").capitalize() + "."
    texts = {
        "passes.json": json.dumps(facts, separators=(",", ":")) + "\n",
        "README.md": read_shipped_text("godot_readme.md")
        .replace("/*SCRIPT*/", script)
        .replace("/*SIZE*/", f"{width}x{height}"),
        script: write_script(document, about, package.notes),
    }
    texts |= {f"shaders/{number}.glsl": text for number, (text, _) in enumerate(programs)}
    return texts | {f"shaders/{name}.glsl": text for name, text in write_takers().items()}


def _list_plans(document: Record) -> Iterator[Record]:
    return (plan for variants in document["plans"] for plan in variants)


def _refuse_meshes(document: Record) -> None:
    for plan in _list_plans(document):
        for record in plan["passes"]:
            if "mesh" in record:
                owner = record["nodes"][-1] if record["nodes"] else ""
                raise GraphError(
                    f"{describe_owner(owner)} draws meshes, and an effect of Godot draws over pictures alone: render "
                    "it to a file first",
                    node=owner,
                )


def _widen_tables(package: Package) -> Package:
    """The package with four channels in tables of three: no device has textures of three floats."""
    tables = [
        table for plan in _list_plans(package.document) for each in plan["passes"] for table in each.get("tables", ())
    ]
    blobs = list(package.blobs)
    for table in {id(table): table for table in tables}.values():
        if table["shape"][-1] == 3:
            values = np.frombuffer(package.blobs[table["blob"]], np.float32).reshape(-1, 3)
            blobs[table["blob"]] = np.pad(values, ((0, 0), (0, 1))).tobytes()
            table["shape"][-1] = 4
    return msgspec.structs.replace(package, blobs=tuple(blobs))
