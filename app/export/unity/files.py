"""Exports a graph as a folder that draws it over what a camera of Unity sees."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import MappingProxyType

from ...document.about import find_about
from ...errors import GraphError, describe_owner
from ..folder import write_package
from ..game import assemble_for_game, choose_used_roles, list_plans
from ..order import ExportOrder, ExportReport
from ..package import Package
from ..shipped_files import read_shipped_text
from ..slang.hlsl import write_hlsl
from .data import find_lengths, write_data
from .script import write_class_name, write_feature
from .shaders import ShaderPass, write_program, write_shader

SCRIPTS: Mapping[str, str] = MappingProxyType(
    {
        f"{name}.cs": f"unity_{name.removeprefix('Look').lower()}.cs"
        for name in ("LookData", "LookFeature", "LookNumbers", "LookPass", "LookTextures")
    }
)
"""Scripts that are the same for all graphs but for their namespace, and the assets that they are copies of."""


def export_unity(order: ExportOrder) -> ExportReport:
    """Write the folder. Raises GraphError, OutputError, and UsageError where the translator is missing."""
    package = assemble_for_game(order, "an effect of Unity", "is the light of Unity")
    name = write_class_name(order.name)
    texts = _list_texts(order, package, name)
    return write_package(order, package, texts, pixels=f"Resources/{name}/pixels/{{}}.bytes")


def _list_texts(order: ExportOrder, package: Package, name: str) -> dict[str, str]:
    document = package.document
    passes = _translate(package)
    head = read_shipped_text("unity_head.txt").rstrip()
    plan = document["plans"][-1][0]
    width, height = plan["surfaces"][plan["output"]]["size"]
    about = find_about(order.graph).doc or order.name.replace("_", " ").capitalize() + "."
    data = write_data(document, passes, choose_used_roles(order.graph, document))
    readme = read_shipped_text("unity_readme.md")
    marks = {"HEAD": head, "NAMESPACE": f"Halation.{name}"}
    texts = {
        "README.md": readme.replace("/*FEATURE*/", f"{name}Feature").replace("/*SIZE*/", f"{width}x{height}"),
        f"{name}Feature.cs": write_feature(document, name, name, about, package.notes, head),
        f"Resources/{name}/Passes.json": json.dumps(data, separators=(",", ":")) + "\n",
        f"Resources/{name}/Look.shader": write_shader(name, list(passes.values()), head),
    }
    for script, asset in SCRIPTS.items():
        text = read_shipped_text(asset)
        for mark, value in marks.items():
            text = text.replace(f"/*{mark}*/", value)
        texts[script] = text
    return texts


def _translate(package: Package) -> dict[int, ShaderPass]:
    """The pass of each program that is drawn, by its number. Raises GraphError."""
    records = {record["program"]: record for plan in list_plans(package.document) for record in plan["passes"]}
    lengths = find_lengths(package.document)
    passes: dict[int, ShaderPass] = {}
    for number, record in sorted(records.items()):
        owner = record["nodes"][-1] if record["nodes"] else ""
        try:
            passes[number] = write_program(write_hlsl(package.programs[number][0]), lengths[number])
        except ValueError as error:
            raise GraphError(f"{describe_owner(owner)} cannot be written for Unity: {error}", node=owner) from None
    return passes
