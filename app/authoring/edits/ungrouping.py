"""Replaces a group by its content."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Port
from ...graph.names import fresh_name
from ...graph.notes import move_keys
from ...language.translation import translate
from . import timing
from .element_id import ElementId
from .elements import Place, list_elements, with_sections, without_entries
from .folding import find_group
from .grouping import group_corner
from .layout import positions
from .merging import MergedPart, merge_part, rename_dots
from .paths import rebase_paths
from .ports import read_port
from .routes import routes, tidy_routes


def ungroup(graph: Graph, id: str) -> tuple[Graph, tuple[ElementId, ...]]:
    """A graph where the content of a group stands in its place, and the elements of that content.

    The picture stays the same: an input of the group that nothing feeds, but that has a file or default of its own,
    becomes an input of the graph. Raises GraphError for a muted group, which shows something else than its content.
    """
    item = find_group(graph, id)
    if id in graph.muted:
        raise GraphError(
            translate("group '{id}' is muted, so its content is not what it shows: unmute it first", id=id)
        )
    body = rebase_paths(item.body(), graph.folder)
    outer = _remove_group(graph, id)
    merged_part = merge_part(outer, body, _content_places(graph, id, body))
    opened_group = _OpenedGroup(graph, id, body, merged_part)
    links, hoisted = opened_group.links()
    after = replace(
        merged_part.graph,
        inputs={**graph.inputs, **{opened_group.hoisted[name]: body.inputs[name] for name in hoisted}},
        links={**links, **merged_part.graph.links},
        controls=opened_group.controls(),
        animation=timing.join_animation(
            graph, body, id, {name: merged_part.names[ElementId(name)].name for name in body.nodes}
        ),
    )
    after = opened_group.with_layout(after)
    elements = set(list_elements(after))
    return tidy_routes(after), tuple(element for element in merged_part.names.values() if element in elements)


class _OpenedGroup:
    """A group `id` of `graph` whose `body` was merged into it."""

    def __init__(self, graph: Graph, id: str, body: Graph, merged_part: MergedPart) -> None:
        self.graph, self.id, self.body, self.merged_part = graph, id, body, merged_part
        input_names, self.hoisted = set(graph.inputs), dict[str, str]()
        for name in body.inputs:
            self.hoisted[name] = fresh_name(name, input_names)
            input_names.add(self.hoisted[name])

    def links(self) -> tuple[dict[Port, Port], set[str]]:
        """Links across the border of the group, joined, and inputs of it that the graph needs now."""
        links: dict[Port, Port | None] = {}
        for target, source in self.body.links.items():
            if source.node == INPUTS and (end := self.merged_part.port(target)):
                links[end] = self._source(source)
        for target, source in self.graph.links.items():
            if target.node == self.id:
                if (end := self._control(target.socket)) and end not in self.merged_part.graph.links:
                    links.setdefault(end, None if source.node == self.id else source)
            elif source.node == self.id:
                links[target] = self._source(self.body.links.get(Port(OUTPUTS, source.socket)))
        known_links = {end: start for end, start in links.items() if start is not None}
        outside = {Port(INPUTS, fresh): name for name, fresh in self.hoisted.items()}
        return known_links, {outside[start] for start in known_links.values() if start in outside}

    def controls(self) -> dict[str, object]:
        """The controls of the graph, which now set the values that controls of the group set."""
        controls = {}
        for name, item in self.graph.controls.items():
            target = self._control(item.target.socket) if item.target.node == self.id else item.target
            if target is not None:
                controls[name] = item.with_target(target)
        return controls

    def with_layout(self, after: Graph) -> Graph:
        """`after` with routes joined, and viewers on what the group showed."""
        outer, inner, passed = routes(self.graph), routes(self.body), routes(after)
        for target, source in self.body.links.items():
            if source.node == INPUTS and (end := self.merged_part.port(target)):
                dots = outer.get(str(Port(self.id, source.socket)), ())
                passed[str(end)] = (*dots, *rename_dots(self.merged_part, inner.get(str(target), ())))
        for target, source in self.graph.links.items():
            if source.node == self.id != target.node:
                dots = rename_dots(self.merged_part, inner.get(str(Port(OUTPUTS, source.socket)), ()))
                passed[str(target)] = (*dots, *outer.get(str(target), ()))
        ends = {str(end) for end in after.links}
        passed = {target: dots for target, dots in passed.items() if dots and target in ends}
        return with_sections(after, {"routes": passed, "viewers": self._viewers()})

    def _viewers(self) -> dict[str, object]:
        section, viewers = self.graph.ui.get("viewers"), dict[str, object]()
        for number, text in section.items() if isinstance(section, Mapping) else ():
            viewed = read_port(text)
            if viewed is None or viewed.node != self.id:
                viewers[number] = text
            elif port := self._source(self.body.links.get(Port(OUTPUTS, viewed.socket))):
                viewers[number] = str(port)
        return viewers

    def _source(self, port: Port | None) -> Port | None:
        """The source outside of the group that a source inside stands for; None if there is none."""
        if port is None or port.node != INPUTS:
            return port and self.merged_part.port(port)
        outside = self.graph.links.get(Port(self.id, port.socket))
        if outside is not None:
            return outside if outside.node != self.id else None
        own = self.body.inputs.get(port.socket)
        return Port(INPUTS, self.hoisted[port.socket]) if own and (own.file or own.default is not None) else None

    def _control(self, name: str) -> Port | None:
        """The value that a control of the group sets, seen from the graph."""
        is_control = name in self.body.controls and name not in self.body.inputs
        return self.merged_part.port(self.body.controls[name].target) if is_control else None


def _remove_group(graph: Graph, id: str) -> Graph:
    """The graph without a group, and without the links to it."""
    return replace(
        without_entries(graph, [ElementId(id)]),
        nodes={name: item for name, item in graph.nodes.items() if name != id},
        links={end: start for end, start in graph.links.items() if id not in (end.node, start.node)},
        extra=move_keys(graph.extra, f"nodes.{id}"),
    )


def _content_places(graph: Graph, id: str, body: Graph) -> dict[ElementId, Place]:
    """Where the content goes: around the place of the group, as it lay inside."""
    spots = positions(body)
    inner = group_corner(body, list(body.nodes), spots)
    here = positions(graph)[ElementId(id)]
    return {key: (round(x - inner[0] + here[0], 2), round(y - inner[1] + here[1], 2)) for key, (x, y) in spots.items()}
