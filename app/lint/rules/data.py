"""Data layers that are linked to nodes for color."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from halation.nodes import Kind, Trait

from ...graph import INPUTS, Graph, Port, Problem
from ...graph.rules import Rule
from ..sheet import Check, GraphFacts, layer_read

DATA_AS_COLOR = Rule(
    "data-as-color",
    "warning",
    "A data layer (depth, normals, motion, ids) is linked to a node for color or light: the result has no meaning.",
    "Link the picture. To look at data, read it as a Field or Vector, and use levels or gradient_map.",
)

_DATA = (
    r"(?i)(.*[._ ])?(z|z?_?depth|position|p|normals?|n|vector|velocity|motion_?vectors?|motion|uvs?|st"
    r"|(object|material)_?(id|index)|index(ob|ma)|crypto.*)(\.[a-z]+)?"
)
"""Names of layers that are never color, such as `Depth`, `ViewLayer.Normal` and `CryptoObject00`. Compiled when first
used: few graphs read layers."""


def find(sheet: GraphFacts) -> Iterator[Problem]:
    """Nodes that need color, but are linked to a data layer."""
    for id, item in sheet.list_having(Trait.NEEDS_COLOR):
        if (source := sheet.first(id)) and (layer := _data(sheet, source)):
            name = next(iter(item.inputs))
            sentence = f"'{id}' works on color, but '{source}' is data ({layer}): link a picture to '{id}.{name}'"
            yield Problem(id, name, sentence, DATA_AS_COLOR, f"links.{id}.{name}")


def _data(sheet: GraphFacts, source: Port) -> str:
    """The data layer at a port; "" if it may be color."""
    if source.node == INPUTS:
        end = sheet.graph.inputs[source.socket]
        layer = end.layer if end.layer or end.kind is Kind.IMAGE else source.socket
    else:
        layer = layer_read(sheet.graph.nodes[source.node], source.socket)
    return layer if layer and is_data_layer(layer) else ""


def is_data_layer(name: str) -> bool:
    """True for the name of a layer that is never color."""
    return re.fullmatch(_DATA, name) is not None


def find_data_bindings(graph: Graph, files: Mapping[str, str]) -> Iterator[str]:
    """Sentences about data layers that are bound, as `FILE:LAYER`, to inputs that feed nodes for color."""
    from ...media.layers import split_layer  # it loads libraries for pictures, which rules do not need

    for name, file in files.items():
        layer = split_layer(file)[1]
        if not layer or not is_data_layer(layer) or graph.inputs[name].kind is not Kind.IMAGE:
            continue
        for target, source in graph.links.items():
            item = graph.nodes.get(target.node)
            if source == Port(INPUTS, name) and Trait.NEEDS_COLOR in getattr(type(item), "traits", ()):
                yield f"-i {name}={file}: '{target.node}' works on color, but the layer {layer} is data"


CHECKS = (Check(DATA_AS_COLOR, find),)
