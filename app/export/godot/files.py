"""Exports a graph as a folder that draws it over what a camera of Godot sees."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import MappingProxyType

import msgspec

from ...document.about import find_about
from ..engine_text import write_name
from ..folder import write_package
from ..game import assemble_for_game, choose_used_roles
from ..order import ExportOrder, ExportReport
from ..package import Package
from ..shipped_files import read_shipped_text
from .script import write_script
from .shaders import write_shader, write_takers

READERS: Mapping[str, str] = MappingProxyType(
    {"halation_effect.gd": "godot_effect.gd", "halation_numbers.gd": "godot_numbers.gd"}
)
"""Files of the folder that are the same for all graphs, and the assets that they are copies of."""


def export_godot(order: ExportOrder) -> ExportReport:
    """Write the folder. Raises GraphError, OutputError."""
    package = assemble_for_game(order, "an effect of Godot", "is the light of Godot")
    return write_package(order, package, _list_texts(order, package), READERS)


def _list_texts(order: ExportOrder, package: Package) -> dict[str, str]:
    document = package.document
    programs = [write_shader(fragment) for fragment, _ in package.programs]
    roles = choose_used_roles(order.graph, document)
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
