"""The scene: all elements and links with their places, and what is under a point. Canvas units."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import cached_property
from itertools import pairwise
from typing import Literal

from msgspec import Struct, field
from msgspec.structs import replace

from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.edits.link_curves import Curve, make_curve
from ...graph import Port
from .geometry import Point, Rect, contains, find_bounds
from .layout import HEADER, ROW, NodeLayout, Pin
from .link_index import LinkIndex, Wire

DOT = 7.0
"""Radius of a dot."""

FRAME_TITLE = 32.0

Sort = Literal["node", "end", "frame", "comment", "dot"]
Part = Literal["pin", "field", "more", "title", "body", "edge", "link", "empty"]


class ElementBox(Struct, frozen=True):
    """An element: its rectangle, and the layout within for nodes and ends. Dots are boxes around their center."""

    key: ElementId
    sort: Sort
    x: float
    y: float
    w: float
    h: float
    layout: NodeLayout | None = None

    @property
    def rect(self) -> Rect:
        """Left, top, right, bottom."""
        return self.x, self.y, self.x + self.w, self.y + self.h

    def make_port(self, pin: Pin, output: bool) -> Port:
        """The port that a pin stands for."""
        return self.key.port or Port(self.key, pin.name)


class Hit(Struct, frozen=True):
    """What is under a point. `name` is the row of a field, or the edges (of `lrtb`) of a frame or comment."""

    part: Part = "empty"
    key: ElementId = NO_ELEMENT
    port: Port | None = None
    output: bool = False
    name: str = ""


EMPTY = Hit()


class CanvasScene(Struct, frozen=True, dict=True):
    """Elements in the order in which they are drawn, and links."""

    boxes: dict[ElementId, ElementBox]
    links: LinkIndex = field(default_factory=LinkIndex)

    @property
    def wires(self) -> tuple[Wire, ...]:
        """All links."""
        return self.links.wires

    @property
    def by_target(self) -> Mapping[Port, Wire]:
        """Links by target."""
        return self.links.by_target

    @cached_property
    def sizes(self) -> dict[ElementId, tuple[float, float]]:
        """Width and height of every element."""
        return {key: (box.w, box.h) for key, box in self.boxes.items()}

    @cached_property
    def bounds(self) -> Rect | None:
        """The smallest rectangle around all elements, or None if there are none."""
        return find_bounds(box.rect for box in self.boxes.values())

    def find_pins(self) -> dict[tuple[Port, bool], float]:
        """How far below the top of its element each socket is, by port and whether it is an output."""
        return {(port, output): pin.y for output in (False, True) for port, _, pin in self.list_pins(output)}

    def list_boxes(self, rect: Rect) -> list[ElementBox]:
        """The elements that share any point with a rectangle, in the order in which they are drawn."""
        left, top, right, bottom = rect
        return [
            box
            for box in self.boxes.values()
            if box.x <= right and box.y <= bottom and box.x + box.w >= left and box.y + box.h >= top
        ]

    def move(self, keys: Collection[ElementId], dx: float, dy: float) -> CanvasScene:
        """A scene with some elements moved; links follow."""
        if not keys or not (dx or dy):
            return self
        boxes = {
            key: replace(box, x=box.x + dx, y=box.y + dy) if key in keys else box for key, box in self.boxes.items()
        }
        wires = tuple(
            replace(wire, curves=tuple(route_link(boxes, wire.source, wire.target, wire.stops)))
            if any(stop in keys for stop in wire.stops)
            else wire
            for wire in self.wires
        )
        return CanvasScene(boxes, LinkIndex(wires))

    def resize(self, key: ElementId, rect: Rect) -> CanvasScene:
        """A scene with one element resized."""
        left, top, right, bottom = rect
        box = replace(self.boxes[key], x=left, y=top, w=right - left, h=bottom - top)
        return CanvasScene({**self.boxes, key: box}, self.links)

    def find_hit(self, x: float, y: float, reach: float) -> Hit:
        """What is at a point; pins, links and edges may be `reach` away."""
        node_hit = self._find_element_hit(x, y, reach)
        if node_hit is None and (wire := self.links.find_near(x, y, reach)):
            return Hit("link", port=wire.target)
        return node_hit or self._find_frame_hit(x, y, reach) or EMPTY

    def find_node(self, x: float, y: float) -> ElementId:
        """The node, input or output under a point; empty if there is none."""
        for key, box in reversed(self.boxes.items()):
            if box.sort in ("node", "end") and contains(box.rect, x, y):
                return key
        return NO_ELEMENT

    def list_pins(self, output: bool) -> Iterator[tuple[Port, ElementBox, Pin]]:
        """Every pin of one side."""
        for box in self.boxes.values():
            if box.layout:
                for pin in (box.layout.outs if output else box.layout.ins).values():
                    yield box.make_port(pin, output), box, pin

    def _find_element_hit(self, x: float, y: float, reach: float) -> Hit | None:
        for key, box in reversed(self.boxes.items()):
            if box.sort == "frame" or not contains(box.rect, x, y, reach):
                continue
            if box.layout:
                if hit := _find_node_hit(box, box.layout, x, y, reach):
                    return hit
            elif box.sort == "comment":
                if edges := _find_edges(box.rect, x, y, reach * 0.7, "r"):
                    return Hit("edge", key, name=edges)
                if contains(box.rect, x, y):
                    return Hit("body", key)
            elif (x - box.x - box.w / 2) ** 2 + (y - box.y - box.h / 2) ** 2 <= (box.w / 2 + reach * 0.5) ** 2:
                return Hit("body", key)
        return None

    def _find_frame_hit(self, x: float, y: float, reach: float) -> Hit | None:
        for key, box in reversed(self.boxes.items()):
            if box.sort != "frame" or not contains(box.rect, x, y, reach):
                continue
            if edges := _find_edges(box.rect, x, y, reach * 0.7, "lrtb"):
                return Hit("edge", key, name=edges)
            if y <= box.y + FRAME_TITLE:
                return Hit("title", key)
        return None


def find_pin(box: ElementBox, socket: str, output: bool) -> Point:
    """Where a link meets an element."""
    if box.layout is None:
        return box.x + box.w / 2, box.y + box.h / 2
    pin = (box.layout.outs if output else box.layout.ins).get(socket)
    return (box.x + pin.x, box.y + pin.y) if pin else (box.x + (box.w if output else 0.0), box.y + HEADER / 2)


def route_link(
    boxes: Mapping[ElementId, ElementBox], source: Port, target: Port, stops: tuple[ElementId, ...]
) -> Iterator[Curve]:
    """The curves of a link that joins elements."""
    places = [
        find_pin(boxes[stops[0]], source.socket, output=True),
        *(find_pin(boxes[stop], "", output=True) for stop in stops[1:-1]),
        find_pin(boxes[stops[-1]], target.socket, output=False),
    ]
    return (make_curve(*start, *end) for start, end in pairwise(places))


def _find_node_hit(box: ElementBox, layout: NodeLayout, x: float, y: float, reach: float) -> Hit | None:
    local_x, local_y = x - box.x, y - box.y
    for output, pins in ((True, layout.outs), (False, layout.ins)):
        near = min(pins.values(), key=lambda pin: abs(pin.y - local_y), default=None)
        if near and abs(near.x - local_x) <= reach and abs(near.y - local_y) <= min(reach, ROW / 2):
            return Hit("pin", box.key, box.make_port(near, output), output)
    if not (0 <= local_x <= box.w and 0 <= local_y <= box.h):
        return None
    if layout.more and contains(layout.more, local_x, local_y):
        return Hit("more", box.key)
    for row in layout.rows:
        if row.field and row.value and contains(row.field, local_x, local_y):
            return Hit("field", box.key, Port(box.key, row.value.name), name=row.value.name)
    return Hit("title" if local_y <= HEADER else "body", box.key)


def _find_edges(rect: Rect, x: float, y: float, reach: float, allowed: str) -> str:
    gaps = {"l": abs(x - rect[0]), "t": abs(y - rect[1]), "r": abs(x - rect[2]), "b": abs(y - rect[3])}
    return "".join(side for side in "lrtb" if side in allowed and gaps[side] <= reach)
