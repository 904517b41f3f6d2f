"""Metals of a render that a new node lights again: Cycles writes black as their diffuse color."""

from __future__ import annotations

from halation.nodes import Node

from ...graph import Graph, Port, signature
from ...render_layers.naming import RenderProgram, Role
from ..edits import elements, layout, room, wiring
from ..edits.appending import estimate_sizes
from ..edits.element_id import ElementId
from ..edits.elements import Sizes
from ..state.open_document import OpenDocument
from .absent_layers import analyze_file

_MATERIAL = "material_from_colors"


def connect_metals(document: OpenDocument, graph: Graph, id: str, sizes: Sizes | None = None) -> Graph:
    """A graph where node `id`, which lights the albedo of a render, takes the color and metalness of its surfaces.

    A node `material_from_colors` finds both between the render and the light, with a node that reads the glossy color,
    which has no other use. Where the graph has one for that render, it is linked. Nothing changes where the node has no
    such sockets, or the file no such layer.
    """
    albedo, material = Port(id, "albedo"), Port(id, "material")
    source = graph.links.get(albedo)
    free = {"albedo", "material"} <= signature(graph.nodes[id]).unfolded_inputs.keys() and material not in graph.links
    if (
        source is None
        or not free
        or source.socket != "albedo"
        or not {_MATERIAL, "read_image"} <= document.types.keys()
    ):
        return graph
    found = next(
        (end.node for end, start in graph.links.items() if start == source and _finds_metals(graph, end)), None
    )
    if found is not None:
        return graph.connect(Port(found, "albedo"), albedo).connect(Port(found, "material"), material)
    reader = _make_reader(document, graph, source.node)
    return graph if reader is None else _insert(document, graph, source, id, reader, sizes)


def _finds_metals(graph: Graph, port: Port) -> bool:
    item = graph.nodes.get(port.node)
    return isinstance(item, Node) and item.id == _MATERIAL and port.socket == "diffuse_color"


def _make_reader(document: OpenDocument, graph: Graph, render: str) -> Node | None:
    """A node that reads the glossy color of the file of a render, if Blender wrote one.

    Glossy colors of others are multiplied with how much the surface reflects toward the eye.
    """
    file = analyze_file(document, graph.nodes.get(render))
    if file is None or file.analysis.maker.renderer is not RenderProgram.BLENDER:
        return None
    layer = file.analysis.find_layer(Role.SPECULAR_COLOR)
    if layer is None:
        return None
    return document.types["read_image"]().with_values(path=file.path, layer=layer.name)


def _insert(document: OpenDocument, graph: Graph, source: Port, light: str, reader: Node, sizes: Sizes | None) -> Graph:
    """A graph where the material and its reader stand before a light, which gives way to the right."""
    target, finder = Port(light, "albedo"), graph.fresh_id(_MATERIAL)
    graph = graph.add(finder, document.types[_MATERIAL]())
    places = layout.positions(graph, estimate_sizes(graph, sizes))
    graph = elements.with_places(graph, {ElementId(finder): places[ElementId(light)]})
    graph = wiring.insert_node(graph, finder, target).connect(Port(finder, "material"), Port(light, "material"))
    graph = room.make_space(graph, (ElementId(finder),), target, estimate_sizes(graph, sizes))
    glossy = graph.fresh_id("glossy_color")
    graph = graph.add(glossy, reader).connect(Port(glossy, "out"), Port(finder, "glossy_color"))
    measured = estimate_sizes(graph, sizes)
    places = layout.positions(graph, measured)
    render, key = ElementId(source.node), ElementId(glossy)
    places.pop(key)
    spot = places[render][0], places[render][1] + measured[render][1]
    return elements.with_places(graph, {key: layout.find_free_place(graph, key, spot, places, measured)})
