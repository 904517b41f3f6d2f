"""The layout of a node: rows, pins and fields, in canvas units from its top left corner."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath
from typing import Literal

from halation.nodes import ItemSet, Kind, Node, Plain, Socket, Value
from msgspec import Struct, field

from ...authoring.edits.coding import LANGUAGES
from ...authoring.edits.element_id import ElementId
from ...custom_nodes import CustomNode
from ...errors import GraphError
from ...graph import Graph, Group, Item, Port, Signature, Unknown, signature
from ..fields.item_facts import describe_count
from ..fields.numbers import bar, format_number, unit_suffix
from ..shared.declared_words import name_choice, name_type, name_value, summarize_type
from ..shared.entries import spell_out
from .geometry import Rect

WIDTH, END_WIDTH = 184.0, 152.0
HEADER, ROW, PAD = 32.0, 24.0, 8.0
FIELD_PAD, FIELD_HEIGHT = 8.0, 20.0
MORE = 16.0
PICTURE = 96.0
"""The height of the thumbnail of a node."""

FIELDS = 4
"""The number of values that a node shows until the user expands it."""

MOST_PARTS = 3
"""Numbers of a vector that fit on a node."""

MAIN = ("intensity", "amount", "strength", "exposure", "density")
"""What nodes call the value that says how strong their effect is."""

NodeSort = Literal["node", "group", "unknown", "input", "output"]


class Pin(Struct, frozen=True):
    """An end of a link on an element. `value` pins drive a value; `optional` ones work without a link."""

    name: str
    kind: Kind | None
    x: float
    y: float
    optional: bool = False
    value: bool = False


class FieldText(Struct, frozen=True):
    """A number or word in a field; `part` is the filled part of the field."""

    text: str
    part: tuple[float, float] | None = None


class NodeRow(Struct, frozen=True):
    """One line of a node: an input at the left, an output at the right, or a value that can be set."""

    y: float
    left: Pin | None = None
    right: Pin | None = None
    value: Value | None = None
    label: str = ""
    plain: Plain | None = None
    linked: bool = False
    hint: str = ""
    """The default of an input without a link."""
    texts: tuple[FieldText, ...] = ()
    """The texts of the field: one for each number of a vector, else one."""

    @property
    def field(self) -> Rect | None:
        """The rectangle of the field, or None where a link drives the value."""
        if self.value is None or self.linked:
            return None
        top = self.y + (ROW - FIELD_HEIGHT) / 2
        return FIELD_PAD, top, WIDTH - FIELD_PAD, top + FIELD_HEIGHT


class NodeLayout(Struct, frozen=True):
    """One element as it is drawn. `hidden` counts values that are not shown; `open` is True if none would be."""

    sort: NodeSort
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
    """The place of the thumbnail: below all else, so that nothing moves when the first one appears."""
    foot: float = 0.0
    """The top of the strip that expands the node."""
    hidden: int = 0
    open: bool = False
    collapsed: bool = False
    linked: frozenset[str] = frozenset()
    """The inputs and values that links drive."""

    @property
    def more(self) -> Rect | None:
        """The strip that expands or collapses the list of values."""
        if self.collapsed or not (self.hidden or self.open):
            return None
        return 0.0, self.foot, self.width, self.foot + MORE


def find_value_kind(value: Value) -> Kind | None:
    """The kind of a link that drives a value; None if no link can."""
    if not value.wireable:
        return None
    return {"color": Kind.COLOR, "vector": Kind.VECTOR}.get(value.type, Kind.NUMBER)


def make_end_layout(end: ElementId, socket: Socket, picture: bool, doc: str = "") -> NodeLayout:
    """An input or output of the graph: a slim box with one pin."""
    name, is_input = end.name, end.kind == "input"
    pin = Pin(name, socket.kind, END_WIDTH if is_input else 0.0, HEADER / 2, socket.optional)
    height = HEADER + (PICTURE * END_WIDTH / WIDTH + PAD if picture else 0.0)
    return NodeLayout(
        "input" if is_input else "output",
        END_WIDTH,
        height,
        name,
        category="input" if is_input else "output",
        doc=doc,
        ins={} if is_input else {name: pin},
        outs={name: pin} if is_input else {},
        picture=(PAD / 2, HEADER, END_WIDTH - PAD / 2, height - PAD / 2) if picture else None,
    )


class NodeFacts(Struct, frozen=True):
    """What the layout of a node depends on besides the node: its links, and display options."""

    linked_ins: frozenset[str] = frozenset()
    linked_outs: frozenset[str] = frozenset()
    field_outs: frozenset[str] = frozenset()
    """Outputs that are Fields because they follow an input that a Field is linked to."""
    collapsed: bool = False
    expanded: bool = False
    picture: bool = False


def make_node_layout(id: str, item: Item, graph: Graph, facts: NodeFacts) -> NodeLayout:
    """The layout of a node of a graph."""
    node_signature = signature(item)
    sort: NodeSort = "group" if isinstance(item, Group) else "unknown" if isinstance(item, Unknown) else "node"
    heading = _describe_item(id, item, sort)
    input_pins, output_pins = _list_pins(node_signature, facts)
    if facts.collapsed:
        ins = _spread_pins([*input_pins, *_list_linked_values(node_signature, facts)])
        outs = _spread_pins(output_pins)
        return NodeLayout(sort, WIDTH, HEADER, *heading, ins=ins, outs=outs, collapsed=True)

    folded_pins = [pin for pin in input_pins if _is_folded(pin, node_signature)]
    row_pins = [pin for pin in input_pins if pin not in folded_pins]
    rows = _make_socket_rows(row_pins, output_pins, node_signature, facts)
    y = HEADER + PAD / 2 + ROW * len(rows)
    values = _make_value_rows(id, item, graph, facts, node_signature.values)
    visible_rows = values if facts.expanded else _choose_rows(values)
    for row in visible_rows:
        rows.append(_move_row(row, y))
        y += ROW
    hidden = len(values) - len(visible_rows)
    is_open = facts.expanded and len(_choose_rows(values)) < len(values)
    foot, picture = y, None
    y += MORE if hidden or is_open else PAD / 2 if facts.picture else PAD
    if facts.picture:
        picture = PAD / 2, y, WIDTH - PAD / 2, y + PICTURE
        y += PICTURE + PAD / 2
    return NodeLayout(
        sort,
        WIDTH,
        y,
        *heading,
        tuple(rows),
        {row.left.name: row.left for row in rows if row.left} | _place_in_header(folded_pins),
        {row.right.name: row.right for row in rows if row.right},
        picture,
        foot,
        hidden,
        is_open,
        linked=facts.linked_ins,
    )


def _describe_item(id: str, item: Item, sort: NodeSort) -> tuple[str, str, str, str]:
    """The id, subtitle, category and doc of a node; no subtitle where it only repeats the id."""
    subtitle = find_subtitle(item)
    category = item.category if isinstance(item, Node) else "code" if subtitle in LANGUAGES.values() else sort
    doc = summarize_type(type(item)) if isinstance(item, Node) else ""
    if spell_out(subtitle).lower() == spell_out(id).lower():
        subtitle = LANGUAGES[item.id] if isinstance(item, CustomNode) else ""
    return id, subtitle, category, doc


def find_subtitle(item: Item) -> str:
    """The subtitle of a node: the title of its type, or the name of its language."""
    if isinstance(item, Unknown):
        return LANGUAGES.get(item.type, item.type)
    return name_type(item.title) if isinstance(item, Node) else ""


def _list_pins(node_signature: Signature, facts: NodeFacts) -> tuple[list[Pin], list[Pin]]:
    """The pins of inputs and of outputs; links to sockets that no longer exist have pins without a kind."""
    inputs, outputs = node_signature.inputs, node_signature.outputs
    lost_inputs = sorted(facts.linked_ins - {*inputs, *node_signature.values})
    lost_outputs = sorted(facts.linked_outs - {*outputs})
    return (
        [
            *(Pin(name, socket.kind, 0.0, 0.0, socket.optional) for name, socket in inputs.items()),
            *(Pin(name, None, 0.0, 0.0) for name in lost_inputs),
        ],
        [
            *(
                Pin(name, Kind.FIELD if name in facts.field_outs else socket.kind, WIDTH, 0.0)
                for name, socket in outputs.items()
            ),
            *(Pin(name, None, WIDTH, 0.0) for name in lost_outputs),
        ],
    )


def _is_folded(pin: Pin, node_signature: Signature) -> bool:
    socket = node_signature.inputs.get(pin.name)
    return socket is not None and socket.folded


def _place_in_header(pins: list[Pin]) -> dict[str, Pin]:
    """The pin of the mask beside the title, so that it takes no row."""
    return {pin.name: Pin(pin.name, pin.kind, 0.0, HEADER / 2, True) for pin in pins}


def _make_socket_rows(
    inputs: list[Pin], outputs: list[Pin], node_signature: Signature, facts: NodeFacts
) -> list[NodeRow]:
    """The rows below the header: an input at the left of each and an output at its right."""
    rows: list[NodeRow] = []
    for index in range(max(len(inputs), len(outputs))):
        y = HEADER + PAD / 2 + ROW * index
        start = _move_pin(inputs[index], y) if index < len(inputs) else None
        end = _move_pin(outputs[index], y) if index < len(outputs) else None
        linked = start is not None and start.name in facts.linked_ins
        hint = "" if start is None or end or linked else _describe_default(node_signature.inputs.get(start.name))
        rows.append(NodeRow(y, start, end, hint=hint, linked=linked))
    return rows


def _move_row(row: NodeRow, y: float) -> NodeRow:
    pin = row.left and _move_pin(row.left, y)
    return NodeRow(y, pin, None, row.value, row.label, row.plain, row.linked, texts=row.texts)


def _make_value_rows(id: str, item: Item, graph: Graph, facts: NodeFacts, values: Mapping[str, Value]) -> list[NodeRow]:
    rows: list[NodeRow] = []
    for name, value in values.items():
        plain = item.setting(name) if isinstance(item, Node) else graph.value(Port(id, name))
        value = item.declaration(name) if value.listed_in and isinstance(item, Node) else value
        if value.folded and plain == value.default and name not in facts.linked_ins:
            continue
        kind = find_value_kind(value) if name in facts.linked_ins or _is_wireable(graph, Port(id, name)) else None
        pin = Pin(name, kind, 0.0, 0.0, True, True) if kind else None
        linked, label = name in facts.linked_ins, name_value(value.label or name)
        rows.append(NodeRow(0.0, pin, None, value, label, plain, linked, texts=_make_field_texts(value, plain)))
    return rows


def _choose_rows(rows: list[NodeRow]) -> list[NodeRow]:
    """The values of a node that is not expanded: linked values, and the first few others that can be set on the node.

    The value that says how strong the effect is always is among them: it is what is changed most.
    """
    fields = [
        row
        for row in rows
        if not row.linked
        and row.value
        and can_set_on_node(row.value)
        and not (row.value.role and row.plain == row.value.default)
    ]
    if len(fields) == FIELDS + 1 and len(rows) == len(fields):
        return rows
    main = [row for row in fields if row.value and row.value.name in MAIN][:1]
    others = [row for row in fields if row not in main]
    chosen = {id(row) for row in (*main, *others[: FIELDS - len(main)])}
    return [row for row in rows if row.linked or id(row) in chosen]


def can_set_on_node(value: Value) -> bool:
    """False for values that only the inspector can edit."""
    return value.type not in ("matrix", "curve", "ramp", "spline", "stroke", "point") and (
        value.type != "vector" or value.length <= MOST_PARTS
    )


def _is_wireable(graph: Graph, port: Port) -> bool:
    try:
        return graph.target(port) is not None
    except GraphError:
        return False


def _move_pin(pin: Pin, y: float) -> Pin:
    return Pin(pin.name, pin.kind, pin.x, y + ROW / 2, pin.optional, pin.value)


def _list_linked_values(node_signature: Signature, facts: NodeFacts) -> list[Pin]:
    """Pins for the values that links drive: a collapsed node has no rows where these links could end."""
    return [
        Pin(name, find_value_kind(value), 0.0, 0.0, True, True)
        for name, value in node_signature.values.items()
        if name in facts.linked_ins
    ]


def _spread_pins(pins: list[Pin]) -> dict[str, Pin]:
    """Pins spread along the side of a collapsed node."""
    step = HEADER / (len(pins) + 1)
    return {
        pin.name: Pin(pin.name, pin.kind, pin.x, step * (at + 1), pin.optional, pin.value)
        for at, pin in enumerate(pins)
    }


def _make_field_texts(value: Value, plain: Plain) -> tuple[FieldText, ...]:
    if value.type == "path":
        return (FieldText(PurePath(str(plain)).name),)
    if value.type == "choice":
        return (FieldText(spell_out(name_choice(str(plain)))),)
    if value.type == "text":
        return (FieldText(spell_out(str(plain))),)
    if value.items and isinstance(plain, ItemSet):
        return (FieldText(describe_count(plain, value.items.noun)),)
    if value.type in ("vector", "matrix") and isinstance(plain, tuple):
        return tuple(FieldText(format_number(part, value), bar(part, value)) for part in plain)
    if value.type in ("float", "int") and isinstance(plain, int | float):
        suffix = unit_suffix(value.unit)
        return (
            FieldText(
                f"{format_number(plain, value)} {suffix}" if suffix else format_number(plain, value), bar(plain, value)
            ),
        )
    return (FieldText(""),)


def _describe_default(socket: Socket | None) -> str:
    """The default of an input as text."""
    if socket is None or socket.default is None:
        return ""
    default = socket.default
    return f"{default:g}" if isinstance(default, int | float) else ", ".join(f"{part:g}" for part in default)
