"""What a node shows and where: its rows, pins and fields, in canvas units from its top left corner."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Literal

from halation.nodes import Kind, Node, Plain, Socket, Value

from ...authoring.edits.coding import LANGUAGES
from ...custom_nodes import CustomNode
from ...errors import GraphError
from ...graph import Graph, Group, Item, Port, Unknown, signature
from ..fields.lights import counted
from ..fields.numbers import SUFFIX, bar, shown
from ..shared.entries import spell_out
from .geometry import Rect

WIDTH, END_WIDTH = 184.0, 152.0
HEADER, ROW, PAD = 32.0, 24.0, 8.0
FIELD_PAD, FIELD_HEIGHT = 8.0, 20.0
MORE = 16.0
PICTURE = 96.0
"""Height of the picture of what a node makes."""

FIELDS = 4
"""Values that a node shows before it is asked for all."""

What = Literal["node", "group", "unknown", "input", "output"]


@dataclass(frozen=True, slots=True)
class Pin:
    """An end of a link on an element. `value` pins drive a value; `optional` ones work without a link."""

    name: str
    kind: Kind | None
    x: float
    y: float
    optional: bool = False
    value: bool = False


@dataclass(frozen=True, slots=True)
class FieldText:
    """A number or word in a field; `part` is what of the field is filled."""

    text: str
    part: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class NodeRow:
    """One line of a node: an input at the left, an output at the right, or a value that can be set."""

    y: float
    left: Pin | None = None
    right: Pin | None = None
    value: Value | None = None
    label: str = ""
    plain: Plain | None = None
    linked: bool = False
    hint: str = ""
    """What an input is without a link."""
    shown: tuple[FieldText, ...] = ()
    """The value as its field shows it: several numbers of a vector, else one."""

    @property
    def field(self) -> Rect | None:
        """Where the value is set, or None where a link drives it."""
        if self.value is None or self.linked:
            return None
        top = self.y + (ROW - FIELD_HEIGHT) / 2
        return FIELD_PAD, top, WIDTH - FIELD_PAD, top + FIELD_HEIGHT


@dataclass(frozen=True, slots=True)
class NodeLayout:
    """One element as it is drawn. `hidden` counts values that are not shown; `open` is True if none would be."""

    what: What
    width: float
    height: float
    title: str
    subtitle: str = ""
    category: str = ""
    doc: str = ""
    rows: tuple[NodeRow, ...] = ()
    ins: Mapping[str, Pin] = field(default_factory=dict[str, Pin])
    outs: Mapping[str, Pin] = field(default_factory=dict[str, Pin])
    picture: Rect | None = None
    """Where the picture is of what the node makes: below all else, so that nothing moves when there is a first one."""
    foot: float = 0.0
    """Where the strip begins that shows all values."""
    hidden: int = 0
    open: bool = False
    collapsed: bool = False

    @property
    def more(self) -> Rect | None:
        """The strip that shows all values, or fewer again."""
        if self.collapsed or not (self.hidden or self.open):
            return None
        return 0.0, self.foot, self.width, self.foot + MORE


def value_kind(value: Value) -> Kind | None:
    """What travels on a link that drives a value; None if none can."""
    if not value.wireable:
        return None
    return {"color": Kind.COLOR, "vector": Kind.VECTOR}.get(value.type, Kind.NUMBER)


def end_layout(key: str, socket: Socket, picture: bool, doc: str = "") -> NodeLayout:
    """An input or output of the graph: a slim box with one pin."""
    side, _, name = key.partition(".")
    is_input = side == "inputs"
    pin = Pin(name, socket.kind, END_WIDTH if is_input else 0.0, HEADER / 2, socket.optional)
    height = HEADER + (PICTURE * END_WIDTH / WIDTH + PAD if picture else 0.0)
    return NodeLayout(
        "input" if is_input else "output",
        END_WIDTH,
        height,
        name,
        category=side[:-1],
        doc=doc,
        ins={} if is_input else {name: pin},
        outs={name: pin} if is_input else {},
        picture=(PAD / 2, HEADER, END_WIDTH - PAD / 2, height - PAD / 2) if picture else None,
    )


@dataclass(frozen=True, slots=True)
class NodeFacts:
    """What the layout of a node depends on besides the node: names of its linked sockets, and how it is shown."""

    linked_ins: frozenset[str] = frozenset()
    linked_outs: frozenset[str] = frozenset()
    collapsed: bool = False
    expanded: bool = False
    picture: bool = False


def node_layout(id: str, item: Item, graph: Graph, facts: NodeFacts) -> NodeLayout:
    """The layout of a node of a graph."""
    face = signature(item)
    what: What = "group" if isinstance(item, Group) else "unknown" if isinstance(item, Unknown) else "node"
    subtitle = subtitle_of(item)
    category = item.category if isinstance(item, Node) else "code" if subtitle in LANGUAGES.values() else what
    doc = (item.__doc__ or "").partition("\n")[0] if isinstance(item, Node) else ""
    if spell_out(subtitle).lower() == spell_out(id).lower():
        subtitle = LANGUAGES[item.id] if isinstance(item, CustomNode) else ""

    inputs = dict(face.inputs)
    left = [Pin(name, one.kind, 0.0, 0.0, one.optional) for name, one in inputs.items()]
    right = [Pin(name, one.kind, WIDTH, 0.0) for name, one in face.outputs.items()]
    left += [Pin(name, None, 0.0, 0.0) for name in sorted(facts.linked_ins - {*face.inputs, *face.values})]
    right += [Pin(name, None, WIDTH, 0.0) for name in sorted(facts.linked_outs - {*face.outputs})]
    if facts.collapsed:
        linked = [
            Pin(name, value_kind(face.values[name]), 0.0, 0.0, True, True)
            for name in face.values
            if name in facts.linked_ins
        ]
        return NodeLayout(
            what,
            WIDTH,
            HEADER,
            id,
            subtitle,
            category,
            doc,
            ins=_spread([*left, *linked]),
            outs=_spread(right),
            collapsed=True,
        )

    y = HEADER + PAD / 2
    rows: list[NodeRow] = []
    for index in range(max(len(left), len(right))):
        start = _at(left[index], y) if index < len(left) else None
        end = _at(right[index], y) if index < len(right) else None
        hint = "" if start is None or end or start.name in facts.linked_ins else _default(inputs.get(start.name))
        rows.append(NodeRow(y, start, end, hint=hint, linked=start is not None and start.name in facts.linked_ins))
        y += ROW
    values = _value_rows(id, item, graph, facts, face.values)
    shown = values if facts.expanded else _first(values)
    for row in shown:
        rows.append(
            NodeRow(
                y, row.left and _at(row.left, y), None, row.value, row.label, row.plain, row.linked, shown=row.shown
            )
        )
        y += ROW
    hidden = len(values) - len(shown)
    is_open = facts.expanded and len(_first(values)) < len(values)
    foot, picture = y, None
    y += MORE if hidden or is_open else PAD / 2 if facts.picture else PAD
    if facts.picture:
        picture = PAD / 2, y, WIDTH - PAD / 2, y + PICTURE
        y += PICTURE + PAD / 2
    return NodeLayout(
        what,
        WIDTH,
        y,
        id,
        subtitle,
        category,
        doc,
        tuple(rows),
        {row.left.name: row.left for row in rows if row.left},
        {row.right.name: row.right for row in rows if row.right},
        picture,
        foot,
        hidden,
        is_open,
    )


def subtitle_of(item: Item) -> str:
    """What stands beside the id of a node: its type, of code what that calls itself."""
    if isinstance(item, Unknown):
        return LANGUAGES.get(item.type, item.type)
    return item.title if isinstance(item, Node) else ""


def _value_rows(id: str, item: Item, graph: Graph, facts: NodeFacts, values: Mapping[str, Value]) -> list[NodeRow]:
    rows: list[NodeRow] = []
    for name, value in values.items():
        kind = value_kind(value) if name in facts.linked_ins or _wireable(graph, Port(id, name)) else None
        pin = Pin(name, kind, 0.0, 0.0, True, True) if kind else None
        plain = getattr(item, name) if isinstance(item, Node) else graph.value(Port(id, name))
        linked, label = name in facts.linked_ins, value.label or spell_out(name)
        rows.append(NodeRow(0.0, pin, None, value, label, plain, linked, shown=_shown(value, plain)))
    return rows


def _first(rows: list[NodeRow]) -> list[NodeRow]:
    """The values worth showing: those that are linked, and the first few others that fit a line and say something."""
    fields = [
        row
        for row in rows
        if not row.linked
        and row.value
        and row.value.type != "matrix"
        and not (row.value.role and row.plain == row.value.default)
    ]
    if len(fields) == FIELDS + 1 and len(rows) == len(fields):
        return rows
    chosen = {id(row) for row in fields[:FIELDS]}
    return [row for row in rows if row.linked or id(row) in chosen]


def _wireable(graph: Graph, port: Port) -> bool:
    try:
        return graph.target(port) is not None
    except GraphError:
        return False


def _at(pin: Pin, y: float) -> Pin:
    return Pin(pin.name, pin.kind, pin.x, y + ROW / 2, pin.optional, pin.value)


def _spread(pins: list[Pin]) -> dict[str, Pin]:
    """Pins along the side of a closed node."""
    step = HEADER / (len(pins) + 1)
    return {
        pin.name: Pin(pin.name, pin.kind, pin.x, step * (at + 1), pin.optional, pin.value)
        for at, pin in enumerate(pins)
    }


def _shown(value: Value, plain: Plain) -> tuple[FieldText, ...]:
    if value.type == "path":
        return (FieldText(PurePath(str(plain)).name),)
    if value.type in ("choice", "text"):
        return (FieldText(spell_out(str(plain))),)
    if value.type == "lights" and isinstance(plain, tuple):
        return (FieldText(counted(plain)),)
    if value.type in ("vector", "matrix") and isinstance(plain, tuple):
        return tuple(FieldText(shown(part, value), bar(part, value)) for part in plain)
    if value.type in ("float", "int") and isinstance(plain, int | float):
        suffix = SUFFIX[value.unit]
        return (FieldText(f"{shown(plain, value)} {suffix}" if suffix else shown(plain, value), bar(plain, value)),)
    return (FieldText(""),)


def _default(socket: Socket | None) -> str:
    """What an input is worth without a link."""
    if socket is None or socket.default is None:
        return ""
    given = socket.default
    return f"{given:g}" if isinstance(given, int | float) else ", ".join(f"{part:g}" for part in given)
