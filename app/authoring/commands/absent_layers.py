"""Outputs of nodes that read a render, for which its file has no layer: a link from one of them would be an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from halation.nodes import Node

from ...errors import HalationError
from ...graph import Port
from ...render_layers.analysis import analyze_render
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


def _list_absent(document: OpenDocument, id: str) -> Iterator[Port]:
    item = document.graph.nodes.get(id)
    if not isinstance(item, Node):
        return
    values = item.values.values()
    path = next((str(item.setting(value.name)) for value in values if value.holds == "render"), "")
    if not path:
        return
    by_output = {value.name.removesuffix(_LAYER): value for value in values if value.role and value.type == "text"}
    chosen = {Role(value.role): str(item.setting(value.name)) for value in by_output.values()}
    file = representative_file(Path(document.root.folder, path), sandbox=document.sandbox)
    try:
        named = {role: layer for role, layer in chosen.items() if layer}
        analysis = analyze_render(str(file), named=named, sandbox=document.sandbox)
    except HalationError:
        return
    for output, value in by_output.items():
        if output in item.outputs and analysis.find_layer(Role(value.role)) is None:
            yield Port(id, output)
