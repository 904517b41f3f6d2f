"""Outputs of nodes that read a render, for which its file has no layer: a link from one of them would be an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from halation.nodes import Node
from msgspec import Struct

from ...errors import HalationError
from ...graph import Item, Port
from ...render_layers.analysis import RenderAnalysis, analyze_render
from ...render_layers.camera import read_header_camera
from ...render_layers.naming import Role
from ...watch.sequence_files import representative_file
from ..state.open_document import OpenDocument

_LAYER = "_layer"
"""The end of the name of a value that chooses the layer of an output."""


def list_absent_outputs(document: OpenDocument, ids: Iterable[str]) -> frozenset[Port]:
    """The outputs of some nodes that their files have no layer for; only headers are read.

    A file that cannot be read has none that are known.
    """
    return frozenset(port for id in ids for port in _list_absent(document, id))


class AnalyzedFile(Struct, frozen=True):
    """What the headers of a render say, the path that names it in a node, and the roles of outputs that are layers."""

    path: str
    analysis: RenderAnalysis
    roles: Mapping[str, str]


def analyze_file(document: OpenDocument, item: Item | None) -> AnalyzedFile | None:
    """The file of a node that reads a render; None for other nodes, and where it cannot be read."""
    if not isinstance(item, Node):
        return None
    values = item.values.values()
    path = next((str(item.setting(value.name)) for value in values if value.holds == "render"), "")
    if not path:
        return None
    by_output = {value.name.removesuffix(_LAYER): value for value in values if value.role and value.type == "text"}
    chosen = {Role(value.role): str(item.setting(value.name)) for value in by_output.values()}
    file = representative_file(Path(document.root.folder, path), sandbox=document.sandbox)
    try:
        named = {role: layer for role, layer in chosen.items() if layer}
        analysis = analyze_render(str(file), named=named, sandbox=document.sandbox)
    except HalationError:
        return None
    return AnalyzedFile(path, analysis, {output: value.role for output, value in by_output.items()})


def _list_absent(document: OpenDocument, id: str) -> Iterator[Port]:
    item = document.graph.nodes.get(id)
    file = analyze_file(document, item)
    if file is None or not isinstance(item, Node):
        return
    for output, role in file.roles.items():
        if output in item.outputs and file.analysis.find_layer(Role(role)) is None:
            yield Port(id, output)
    if "camera" in item.outputs and not _may_tell_camera(file.analysis):
        yield Port(id, "camera")


def _may_tell_camera(analysis: RenderAnalysis) -> bool:
    """Whether a camera could be solved from positions or is in the header."""
    header = analysis.header
    return bool(analysis.find_layer(Role.POSITION) or read_header_camera(header.attributes, header.info.size))
