"""Pictures and links that leave nodes without the light or the surfaces that they work with."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePath

from halation.nodes import Kind, Trait

from ...custom_nodes import CustomNode
from ...graph import INPUTS, Group, Port, Problem, signature
from ...graph.rules import Rule
from ..sheet import Check, GraphFacts, find_layered_path, has_trait

DISPLAY_LIGHT = Rule(
    "display-light",
    "warning",
    "A node that calculates with scene light gets a picture after a tone map: its brightness is not "
    "linear, and bright lights are clipped.",
    "Put the node before the tone map.",
)
CLIPPED_LIGHT = Rule(
    "clipped-light",
    "warning",
    "A node that makes lights glow or spread gets an 8-bit file, in which nothing is brighter than white.",
    "Read an EXR of the same picture, or allow it if there is none.",
)
NO_SURFACE = Rule(
    "no-surface",
    "warning",
    "A node that works on surfaces has no link that says where they are, so that its picture stays black.",
    "Link layers of a render to it: depth, normals or positions.",
)

_SURFACES = ("depth", "normal", "position", "ids")
"""Inputs that say where surfaces are."""
_BYTES = frozenset({".bmp", ".gif", ".jpeg", ".jpg", ".tga", ".webp"})
"""Endings of files that always hold 8 bits; PNG and TIFF may hold more."""


def find_display_light(sheet: GraphFacts) -> Iterator[Problem]:
    """Nodes for scene light after a tone map. The first one of each chain is reported."""
    if not any(_list_display_outputs(sheet, id) for id in sheet.graph.nodes):
        return
    maker: dict[Port, str] = {}
    for id in sheet.graph.order():
        item = sheet.works(id)
        if item is None or isinstance(item, CustomNode):
            continue
        pictures = [source for source in _list_image_sources(sheet, id) if source]
        makers = {maker[source] for source in pictures if source in maker}
        if has_trait(item, Trait.NEEDS_SCENE_LIGHT) and pictures and pictures[0] in maker:
            name, by = next(iter(item.inputs)), maker[pictures[0]]
            sentence = f"'{id}' works with light, but '{by}' has made its picture ready for the display: put it before"
            yield Problem(id, name, f"{sentence} '{by}'", DISPLAY_LIGHT, f"links.{id}.{name}")
        for name in _list_display_outputs(sheet, id):
            maker[Port(id, name)] = id
        keeps = not isinstance(item, Group) and not has_trait(item, Trait.NEEDS_SCENE_LIGHT, Trait.CHANGES_ENCODING)
        if keeps and makers and all(source in maker for source in pictures):
            outputs = signature(item).outputs
            maker |= {Port(id, name): min(makers) for name, output in outputs.items() if output.kind is Kind.IMAGE}


def find_clipped_light(sheet: GraphFacts) -> Iterator[Problem]:
    """Nodes that need light above white, directly after a file that cannot hold any."""
    for id, item in sheet.list_having(Trait.NEEDS_HIGHLIGHTS):
        if source := sheet.first(id):
            file = _find_file(sheet, source)
            if PurePath(file).suffix.lower() in _BYTES:
                sentence = f"'{id}' needs light brighter than white, and '{file}' cannot hold any: read an EXR"
                name = next(iter(item.inputs))
                yield Problem(id, name, sentence, CLIPPED_LIGHT, f"links.{id}.{name}")


def find_missing_surfaces(sheet: GraphFacts) -> Iterator[Problem]:
    """Nodes that work on surfaces, and are linked to none."""
    for id, item in sheet.list_having(Trait.NEEDS_SURFACES):
        names = [name for name in _SURFACES if name in item.inputs]
        if not any(sheet.source(Port(id, name)) for name in names):
            wanted = f"{', '.join(names[:-1])} or {names[-1]}"
            sentence = f"'{id}' finds no surface: link {wanted} of a render to it"
            yield Problem(id, names[0], sentence, NO_SURFACE, f"links.{id}.{names[0]}")


def _list_image_sources(sheet: GraphFacts, id: str) -> list[Port | None]:
    """The sources of the image inputs of a node."""
    inputs = signature(sheet.graph.nodes[id]).inputs
    return [sheet.source(Port(id, name)) for name, socket in inputs.items() if socket.kind is Kind.IMAGE]


def _list_display_outputs(sheet: GraphFacts, id: str) -> list[str]:
    """The outputs of a node that are display colors."""
    item = sheet.graph.nodes[id]
    if isinstance(item, Group):
        return [name for name, output in item.graph.outputs.items() if output.view == "none"]
    return [next(iter(item.outputs))] if has_trait(item, Trait.MAKES_DISPLAY_LIGHT) else []


def _find_file(sheet: GraphFacts, source: Port) -> str:
    """The file that a port reads, or ""."""
    if source.node == INPUTS:
        return sheet.graph.inputs[source.socket].file
    item = sheet.graph.nodes[source.node]
    path = find_layered_path(item)
    return getattr(item, path.name) if path else ""


CHECKS = (
    Check(DISPLAY_LIGHT, find_display_light),
    Check(CLIPPED_LIGHT, find_clipped_light),
    Check(NO_SURFACE, find_missing_surfaces),
)
