"""Builds the scene of a graph; unchanged parts come from caches."""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import lru_cache
from textwrap import wrap
from typing import Any

from halation.nodes import Node
from msgspec import Struct, field
from msgspec.structs import replace

from ...authoring.edits.element_id import ElementId
from ...authoring.edits.elements import entry, list_decor
from ...authoring.edits.routes import routes
from ...graph import INPUTS, OUTPUTS, Graph, Group, Item, Port
from ...language.translation import language
from .geometry import Point
from .layout import NodeFacts, NodeLayout, make_end_layout, make_node_layout
from .link_index import LinkIndex, Wire
from .scene import DOT, CanvasScene, ElementBox, route_link

_LETTER = 6.6, 17.0
"""The width of a letter and the height of a line in comments."""

SceneOptions = tuple[Collection[ElementId], str, frozenset[str]]
"""Display options: elements with a thumbnail, the element that is expanded for now, all expanded elements."""

FRAME_SIZE, COMMENT_SIZE = (320.0, 200.0), (200.0, 64.0)


class SceneBuilder(Struct):
    """Builds scenes; caches the layouts of unchanged nodes. `expanded` are nodes that show all their values."""

    expanded: set[str] = field(default_factory=set[str])
    _layouts: dict[str, tuple[Item, NodeFacts, NodeLayout]] = field(
        default_factory=dict[str, tuple[Item, NodeFacts, NodeLayout]]
    )
    _language: str = field(default_factory=language)
    """The language in which the layouts were measured."""
    _links: object = None
    _linked_sockets: tuple[dict[str, set[str]], dict[str, set[str]]] = field(default_factory=lambda: ({}, {}))
    _faults: dict[tuple[Port, Port], tuple[Any, str]] = field(default_factory=dict[tuple[Port, Port], tuple[Any, str]])
    _last: tuple[Graph, SceneOptions, dict[ElementId, ElementBox], LinkIndex] | None = None

    def build(
        self,
        graph: Graph,
        position: Callable[[ElementId], Point],
        top: Collection[ElementId],
        pictures: Collection[ElementId] = frozenset(),
        open: str = "",
    ) -> CanvasScene:
        """The scene of a graph.

        `top` are drawn last, in order; `pictures` are the elements with one; `open` shows all its values for now.
        """
        if self._language != language():
            self._layouts.clear()
            self._language, self._last = language(), None
        options = pictures, open, frozenset(self.expanded)
        boxes, net = self._update(graph, options) or self._rebuild(graph, position, *options[:2])
        self._last = graph, options, boxes, net
        raised = [key for key in top if key in boxes and boxes[key].sort != "frame"]
        if raised:
            boxes = {key: box for key, box in boxes.items() if key not in raised} | {key: boxes[key] for key in raised}
        return CanvasScene(boxes, net)

    def _update(self, graph: Graph, options: SceneOptions) -> tuple[dict[ElementId, ElementBox], LinkIndex] | None:
        """The last boxes and links, with new boxes of changed nodes; None where more differs than values, pictures."""
        if self._last is None or self._last[1][1:] != options[1:]:
            return None
        last, (last_pictures, *_), boxes, net = self._last
        pictures, open, _ = options
        swapped = {*pictures} ^ {*last_pictures}
        parts = ("ui", "links", "inputs", "outputs", "muted")
        if any(getattr(graph, part) is not getattr(last, part) for part in parts) or [*graph.nodes] != [*last.nodes]:
            return None
        fresh: dict[ElementId, ElementBox] = {}
        for id, item in graph.nodes.items():
            if item is not last.nodes[id] or id in swapped:
                box = boxes[node := ElementId(id)]
                layout = self._find_layout(
                    graph, id, item, box.layout is not None and box.layout.collapsed, pictures, open
                )
                if box.layout is None or (layout.ins, layout.outs) != (box.layout.ins, box.layout.outs):
                    return None
                if _find_interface(graph, Port(id, "")) != _find_interface(last, Port(id, "")):
                    return None
                fresh[node] = replace(box, h=layout.height, layout=layout)
        if swapped:  # a picture lies below the pin of an end: links stay where they are
            for key, layout in self._make_ends(graph, pictures):
                if key in swapped:
                    fresh[key] = replace(boxes[key], h=layout.height, layout=layout)
        return ({**boxes, **fresh} if fresh else boxes), net

    def _rebuild(
        self, graph: Graph, position: Callable[[ElementId], Point], pictures: Collection[ElementId], open: str
    ) -> tuple[dict[ElementId, ElementBox], LinkIndex]:
        if graph.links is not self._links:
            self._links, self._linked_sockets = graph.links, _find_linked_sockets(graph)
            self._faults = {ends: fault for ends, fault in self._faults.items() if graph.links.get(ends[1]) == ends[0]}
            self._layouts = {id: layout for id, layout in self._layouts.items() if id in graph.nodes}
        boxes = {box.key: box for box in self._make_frames(graph, position)}
        for comment, facts in list_decor(graph, "comment").items():
            box = _make_sized_box(graph, comment, "comment", COMMENT_SIZE, position)
            boxes[comment] = replace(box, h=measure_comment(str(facts.get("text", "")), box.w))
        for key, layout in self._make_ends(graph, pictures):
            boxes[key] = ElementBox(key, "end", *position(key), layout.width, layout.height, layout)
        for node, item in zip(map(ElementId, graph.nodes), graph.nodes.values(), strict=True):
            is_collapsed = entry(graph, node).get("collapsed") is True
            layout = self._find_layout(graph, node, item, is_collapsed, pictures, open)
            boxes[node] = ElementBox(node, "node", *position(node), layout.width, layout.height, layout)
        for dot in list_decor(graph, "dot"):
            x, y = position(dot)
            boxes[dot] = ElementBox(dot, "dot", x - DOT, y - DOT, DOT * 2, DOT * 2)
        return boxes, LinkIndex(tuple(self._make_wires(graph, boxes)))

    def _make_frames(self, graph: Graph, position: Callable[[ElementId], Point]) -> list[ElementBox]:
        frames = [_make_sized_box(graph, id, "frame", FRAME_SIZE, position) for id in list_decor(graph, "frame")]
        return sorted(frames, key=lambda box: (-box.w * box.h, box.key))

    def _make_ends(self, graph: Graph, pictures: Collection[ElementId]):
        for name, end in graph.inputs.items():
            key = ElementId.of("input", name)
            yield key, _make_end(key, end.socket(name), key in pictures, end.doc)
        for name, end in graph.outputs.items():
            key = ElementId.of("output", name)
            yield key, _make_end(key, end.socket(name), False, "")

    def _find_layout(
        self, graph: Graph, id: str, item: Item, collapsed: bool, pictures: Collection[ElementId], open: str
    ) -> NodeLayout:
        ins, outs = self._linked_sockets
        facts = NodeFacts(
            frozenset(ins.get(id, ())),
            frozenset(outs.get(id, ())),
            _find_field_outputs(graph, id, item),
            collapsed,
            id in self.expanded or id == open,
            id in pictures,
        )
        cached = self._layouts.get(id)
        if cached and cached[0] is item and cached[1] == facts:
            return cached[2]
        layout = make_node_layout(id, item, graph, facts)
        self._layouts[id] = item, facts, layout
        return layout

    def _make_wires(self, graph: Graph, boxes: dict[ElementId, ElementBox]):
        dots_by_target = routes(graph)
        for target, source in graph.links.items():
            start, end = ElementId.of_port(source), ElementId.of_port(target)
            if start not in boxes or end not in boxes:
                continue
            dots = (ElementId.of("dot", dot) for dot in dots_by_target.get(str(target), ()))
            stops = (start, *(dot for dot in dots if dot in boxes), end)
            layout = boxes[start].layout
            pin = layout.outs.get(source.socket) if layout else None
            yield Wire(
                target,
                source,
                stops,
                pin.kind if pin else None,
                tuple(route_link(boxes, source, target, stops)),
                self._find_fault(graph, source, target),
                start in graph.muted or end in graph.muted,
            )

    def _find_fault(self, graph: Graph, source: Port, target: Port) -> str:
        types = _find_interface(graph, source), _find_interface(graph, target)
        cached = self._faults.get((source, target))
        if cached and cached[0] == types:
            return cached[1]
        fault = graph.link_fault(source, target) or ""
        self._faults[source, target] = types, fault
        return fault


def measure_comment(text: str, width: float) -> float:
    """The height of a comment for its text, estimated from the usual width of letters."""
    across = max(int((width - 20.0) / _LETTER[0]), 1)
    lines = sum(max(len(wrap(line, across)), 1) for line in text.split("\n"))
    return max(lines * _LETTER[1] + 16.0, 40.0)


def _find_interface(graph: Graph, port: Port) -> object:
    """The sockets of an element as one object; as long as it stays equal, the same links fit."""
    if port.node == INPUTS:
        return graph.inputs.get(port.socket)
    if port.node == OUTPUTS:
        return graph.outputs.get(port.socket)
    item = graph.nodes.get(port.node)
    if isinstance(item, Group):
        return item.graph.inputs, item.graph.outputs, item.graph.controls
    return (type(item), port in graph.field_outputs) if isinstance(item, Node) else item


def _find_field_outputs(graph: Graph, id: str, item: Item) -> frozenset[str]:
    """The outputs of a node that follow an input that a Field is linked to."""
    names = item.outputs if isinstance(item, Node) else ()
    return frozenset(name for name in names if Port(id, name) in graph.field_outputs)


def _find_linked_sockets(graph: Graph) -> tuple[dict[str, set[str]], dict[str, set[str]]]:
    """The linked inputs and outputs of every node."""
    ins, outs = dict[str, set[str]](), dict[str, set[str]]()
    for target, source in graph.links.items():
        ins.setdefault(target.node, set()).add(target.socket)
        outs.setdefault(source.node, set()).add(source.socket)
    return ins, outs


def _make_sized_box(
    graph: Graph, key: ElementId, sort: Any, size: Point, position: Callable[[ElementId], Point]
) -> ElementBox:
    facts = entry(graph, key)
    w, h = (facts.get(name) for name in ("w", "h"))
    width = float(w) if isinstance(w, int | float) else size[0]
    return ElementBox(key, sort, *position(key), width, float(h) if isinstance(h, int | float) else size[1])


@lru_cache(maxsize=1024)
def _make_end(key: ElementId, socket: Any, picture: bool, doc: str) -> NodeLayout:
    return make_end_layout(key, socket, picture, doc)
