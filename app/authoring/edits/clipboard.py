"""Parts of a graph as text, and text as part of a graph."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path

from ...document import dumps, loads
from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Port, Settings
from ...graph.names import fresh_name
from ...graph.notes import keys_of_nodes
from ...language.translation import translate
from ...resources.sandbox import Sandbox
from . import timing
from .element_id import ElementId
from .elements import Place, Places, entry, list_elements, with_entries, with_places
from .layout import positions, shift_off
from .merging import merge_part, rename_dots
from .paths import rebase_paths
from .routes import routes, with_routes
from .wiring import Types

_FROM = "from"
"""The key of the folder in which relative paths of the text start."""


def cut_part(graph: Graph, chosen: Collection[ElementId]) -> Graph:
    """A graph of the chosen elements: with the links that lead to them, even from what was not chosen."""
    elements = [key for key in list_elements(graph) if key in chosen]
    links = {end: start for end, start in graph.links.items() if ElementId.of_port(end) in chosen}
    inner = [end for end, start in links.items() if ElementId.of_port(start) in chosen]
    passed = {end: dots for end in inner if (dots := routes(graph).get(str(end)))}
    dots = {ElementId.of("dot", dot) for route in passed.values() for dot in route}
    spots = positions(graph)
    copied_graph = Graph(
        nodes={id: item for id, item in graph.nodes.items() if id in chosen},
        links=links,
        inputs={name: end for name, end in graph.inputs.items() if ElementId.of("input", name) in chosen},
        outputs={name: end for name, end in graph.outputs.items() if ElementId.of("output", name) in chosen},
        muted=graph.muted.intersection(chosen),
        animation=timing.animation_of(graph, chosen),
        settings=Settings(reference_height=graph.settings.reference_height),
        folder=graph.folder,
        extra=keys_of_nodes(graph.extra, chosen),
    )
    laid = [key for key in elements if key.kind != "dot"] + sorted(dots)
    copied_graph = with_entries(copied_graph, {key: entry(graph, key) for key in laid})
    return with_routes(with_places(copied_graph, {key: spots[key] for key in laid}), passed)


def copy_elements(graph: Graph, chosen: Collection[ElementId]) -> str:
    """The chosen elements as text: a graph file, which says in `from` where its relative paths start.

    Raises GraphError if no element is chosen.
    """
    if not chosen:
        raise GraphError(translate("nothing is selected: select what to copy"))
    copied_graph = cut_part(graph, chosen)
    folder = str(Path(graph.folder).absolute())
    return dumps(replace(copied_graph, extra={**copied_graph.extra, "": {_FROM: folder}}))


def read_part(text: str, folder: str, types: Types, sandbox: Sandbox) -> Graph:
    """The graph in a text, with paths that start in `folder`. Raises GraphError for a text without any."""
    if not text.lstrip().startswith("{"):
        raise GraphError(translate("there are no nodes to paste: copy some first"))
    try:
        stated_folder = json.loads(text).get(_FROM)
    except (ValueError, RecursionError):
        stated_folder = None
    graph = loads(
        text, "clipboard", stated_folder if isinstance(stated_folder, str) else folder, types, sandbox=sandbox
    )
    return rebase_paths(replace(graph, extra={path: facts for path, facts in graph.extra.items() if path}), folder)


def paste_part(
    graph: Graph,
    part: Graph,
    places: Places,
    at: Place | None = None,
    keep_links: bool = False,
    offset: Place = (0.0, 0.0),
) -> tuple[Graph, tuple[ElementId, ...]]:
    """A graph with the nodes, ends and decor of `part` added, and their ids.

    An input of `part` is the one of that name and type if there is one and a node reads it; an output takes the place
    of a loose one. With `keep_links`, links from what is not in `part` stay where that exists. Raises GraphError.
    """
    ends = _name_ends(graph, part)
    existing = set(list_elements(graph))
    combined = merge_part(_add_ends(graph, part, ends), part, {})
    names = {**combined.names, **ends}
    put = {key: name for key, name in names.items() if name not in existing}
    if not put:
        raise GraphError(translate("there is nothing to paste: copy nodes, frames or comments first"))
    spots = _place_part({key: spot for key, spot in positions(part).items() if key in put}, places, at, offset)
    after = with_places(combined.graph, {put[key]: spot for key, spot in spots.items()})
    folded = [name for key, name in put.items() if key.port and entry(part, key).get("collapsed") is True]
    after = with_entries(after, {name: {"collapsed": True} for name in folded})
    passed = routes(part)
    for target, source in sorted(part.links.items()):
        inside = ElementId.of_port(source) in names
        if (target.node in part.nodes and source.node in part.nodes) or not (inside or keep_links):
            continue
        end, start = _rename_port(target, names), _rename_port(source, names) if inside else source
        if after.link_fault(start, end) is None and end not in after.links:
            after = with_routes(after.connect(start, end), {end: rename_dots(combined, passed.get(str(target), ()))})
    return after, tuple(put.values())


def _name_ends(graph: Graph, part: Graph) -> dict[ElementId, ElementId]:
    """The names of the ends of `part` in the graph: those of equal ends, else free names."""
    read = {source for target, source in part.links.items() if ElementId.of_port(target) != ElementId.of_port(source)}
    end_names: dict[ElementId, ElementId] = {}
    for name, end in part.inputs.items():
        own = graph.inputs.get(name)
        serves = own is not None and (own.kind, own.width) == (end.kind, end.width) and Port(INPUTS, name) in read
        new_name = name if serves else fresh_name(name, graph.inputs)
        end_names[ElementId.of("input", name)] = ElementId.of("input", new_name)
    for name, end in part.outputs.items():
        own = graph.outputs.get(name)
        port = Port(OUTPUTS, name)
        serves = own is not None and (own.kind, own.width) == (end.kind, end.width)
        serves = serves and port in part.links and port not in graph.links
        new_name = name if serves else fresh_name(name, graph.outputs)
        end_names[ElementId.of("output", name)] = ElementId.of("output", new_name)
    return end_names


def _add_ends(graph: Graph, part: Graph, ends: Mapping[ElementId, ElementId]) -> Graph:
    inputs, outputs = dict(graph.inputs), dict(graph.outputs)
    for old_id, new_id in ends.items():
        old, new = old_id.port, new_id.port
        if old and new and old.node == INPUTS:
            inputs.setdefault(new.socket, part.inputs[old.socket])
        elif old and new:
            outputs.setdefault(new.socket, part.outputs[old.socket])
    return replace(graph, inputs=inputs, outputs=outputs)


def _place_part(spots: Places, places: Places, at: Place | None, offset: Place) -> dict[ElementId, Place]:
    """Places of what is pasted: the upper left corner at `at`, else moved by `offset`, and nothing exactly covered."""
    x, y = min((x for x, _ in spots.values()), default=0.0), min((y for _, y in spots.values()), default=0.0)
    dx, dy = (at[0] - x, at[1] - y) if at else offset
    return shift_off({key: (x + dx, y + dy) for key, (x, y) in spots.items()}, places.values())


def _rename_port(port: Port, names: Mapping[ElementId, ElementId]) -> Port:
    name = names[ElementId.of_port(port)]
    return name.port or Port(name, port.socket)
