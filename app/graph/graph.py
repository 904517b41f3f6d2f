"""The graph: an immutable value. Each edit returns a new graph, or raises GraphError if it is invalid."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from types import MappingProxyType
from typing import Any, Self

from halation.nodes import Node, Plain, Pointwise, Socket, Value
from msgspec import structs

from ..errors import GraphError
from .animation import Animation, adapt_animation, animation_type_fault, move_animation
from .conversion import conversion
from .ends import EndEdits
from .followed_types import find_field_outputs, find_type_fault
from .length_units import choose_length_unit, resolve_unit
from .method_arguments import check_method_arguments
from .model import Control, Input, Output, Port, Settings, Signature, Unknown, class_signature, freeze
from .named_items import expand_path, explain_missing_field, find_field, group_settings, join_settings, split_path
from .names import INPUTS, OUTPUTS, check_name, did_you_mean, fresh_name, make_printable, pick
from .notes import keep_linked_routes, move_keys, move_layout, rename_key, without, without_route
from .relink import keep_animation, keep_controls, move_links, relink
from .spline_points import KeyedPoints, explain_missing_point, find_point
from .values import coerce, value_fault
from .walk import Wired, describe_loop, find_route


@dataclass(frozen=True)
class Group:
    """A node whose body is another graph.

    `path` is the file of the body, relative to the file of the graph; empty for a body in the same file.
    `values` holds the settings of the body's controls by name.
    """

    graph: Graph
    path: str = ""
    values: Mapping[str, Plain] = field(default_factory=dict[str, Plain])

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", MappingProxyType(dict(self.values)))

    def body(self) -> Graph:
        """The body with the group's values set where its controls point."""
        controls = self.graph.controls
        return self.graph.put_all(
            {controls[name].target: self.values[name] for name in self.values if name in controls}
        )

    def with_values(self, **values: Plain) -> Group:
        """The group with other settings of some controls."""
        return dataclasses.replace(self, values={**self.values, **values})

    @cached_property
    def signature(self) -> Signature:
        """The inputs, outputs and controls of the body."""
        inputs = {name: end.socket(name) for name, end in self.graph.inputs.items()}
        outputs = {name: end.socket(name) for name, end in self.graph.outputs.items()}
        values = {name: value for name in self.graph.controls if (value := control_value(self.graph, name))}
        return Signature(inputs, outputs, values)


Item = Node | Group | Unknown


@check_method_arguments
@dataclass(frozen=True)
class Graph(Wired[Item], EndEdits, KeyedPoints):
    """Nodes by id, links by *target*: an input has at most one source. `animation` holds values that change over time.

    `ui` is the layout: nodes, ends, routes and viewers by name. `extra` keeps unknown keys of the file, by the JSON
    path of the object that holds them. `folder` is where relative paths start; it is not saved.
    """

    nodes: Mapping[str, Item] = field(default_factory=dict[str, Item])
    links: Mapping[Port, Port] = field(default_factory=dict[Port, Port])
    inputs: Mapping[str, Input] = field(default_factory=dict[str, Input])
    outputs: Mapping[str, Output] = field(default_factory=dict[str, Output])
    controls: Mapping[str, Control] = field(default_factory=dict[str, Control])
    animation: Mapping[Port, Animation] = field(default_factory=dict[Port, Animation])
    settings: Settings = field(default_factory=Settings)
    muted: frozenset[str] = frozenset()
    ui: Mapping[str, Any] = field(default_factory=dict[str, Any])
    extra: Mapping[str, Mapping[str, Any]] = field(default_factory=dict[str, Mapping[str, Any]])
    folder: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        for name in ("nodes", "links", "inputs", "outputs", "controls", "animation", "ui", "extra"):
            if not isinstance(part := getattr(self, name), MappingProxyType):
                frozen = freeze(part) if name in ("ui", "extra") else MappingProxyType(dict(part))
                object.__setattr__(self, name, frozen)
        object.__setattr__(self, "muted", frozenset(self.muted))

    def node(self, id: str) -> Item:
        """The node of an id. Raises GraphError with a suggestion."""
        if id not in self.nodes:
            raise GraphError(_explain_missing_node(id, self.nodes))
        return self.nodes[id]

    def source(self, port: Port) -> Socket | None:
        """The output at `port`, in the type that it follows; None for a node of unknown type. Raises GraphError."""
        return self.field_outputs.get(port) or self.find_declared_source(port)

    @cached_property
    def named_values(self) -> dict[str, tuple[Port, int | None]]:
        """What names in expressions mean, as far as was asked: see `find_named_value`, which fills it."""
        return {}

    @cached_property
    def field_outputs(self) -> Mapping[Port, Socket]:
        """The outputs that are Fields because they follow an input that a Field is linked to."""
        return find_field_outputs(self)

    def find_declared_source(self, port: Port) -> Socket | None:
        """The output at `port` as its node declares it; None for a node of unknown type. Raises GraphError."""
        if port.node == INPUTS:
            return pick(self.inputs, port.socket, "the graph has no input").socket(port.socket)
        interface = signature(self.node(port.node))
        return None if interface.anything else pick(interface.outputs, port.socket, f"node '{port.node}' has no output")

    def target(self, port: Port) -> Socket | Value | None:
        """The input or value at `port`; None for a node of unknown type. Raises GraphError."""
        if port.node == OUTPUTS:
            return pick(self.outputs, port.socket, "the graph has no output").socket(port.socket)
        item = self.node(port.node)
        interface = signature(item)
        if interface.anything or port.socket in interface.inputs:
            return interface.inputs.get(port.socket)
        declared = interface.values if port.socket in interface.values else {**interface.inputs, **interface.values}
        value = find_setting(item, port.socket) or pick(declared, port.socket, f"node '{port.node}' has no input")
        if "." in port.socket or not _is_pointwise(item, port.socket):
            raise GraphError(f"'{port}' can only be set: only values of pointwise nodes can be wired")
        return value

    def link_fault(self, source: Port, target: Port) -> str | None:
        """Why a link from `source` to `target` is invalid, or None. Loops are not checked."""
        if source.node not in self.nodes and source.node != INPUTS:
            return _explain_missing_node(source.node, self.nodes)
        try:
            start, end = self.find_declared_source(source), self.target(target)
        except GraphError as error:
            return str(error)
        return start and end and find_type_fault(self, source, start, end, lambda: self.field_outputs)

    def bypass(self, id: str, target: Socket | Value | None) -> Port | None:
        """The port that can feed `target` in place of node `id`: the source of its first linked input that fits."""
        interface = signature(self.node(id))
        ports = self.links_into.get(id, ()) if interface.anything else [Port(id, name) for name in interface.inputs]
        for source in (self.links[port] for port in ports if port in self.links):
            try:
                start = self.source(source)
            except GraphError:
                continue
            if source.node != id and (target is None or start is None or conversion(start, target) is None):
                return source
        return None

    def fresh_id(self, stem: str) -> str:
        """A free node id: `stem`, or `stem2`, `stem3`, ..."""
        return fresh_name(stem, {*self.nodes, INPUTS, OUTPUTS})

    def add(self, id: str, item: Item) -> Self:
        """A graph with one more node."""
        check_name(id, "node", self.nodes)
        return self._with(nodes={**self.nodes, id: item})

    def remove(self, id: str, heal: bool = True) -> Self:
        """A graph without a node, its links and controls; with `heal`, a source of it that fits feeds its targets."""
        self.node(id)
        links = {target: source for target, source in self.links.items() if id not in (target.node, source.node)}
        for target, source in self.links.items() if heal else ():
            if source.node == id != target.node and (instead := self._find_replacement_source(id, target)):
                links[target] = instead
        controls = {name: control for name, control in self.controls.items() if control.target.node != id}
        return self._with(
            nodes=without(self.nodes, id),
            links=links,
            controls=controls,
            muted=self.muted - {id},
            animation=move_animation(self.animation, id),
            ui=move_layout(self.ui, id),
            extra=move_keys(self.extra, f"nodes.{id}"),
        )

    def rename(self, old: str, new: str) -> Self:
        """A graph where a node has another id; links, controls and layout follow."""
        self.node(old)
        if old == new:
            return self
        check_name(new, "node", self.nodes)
        ports = {*self.links, *self.links.values(), *(control.target for control in self.controls.values())}
        moves = {port: Port(new, port.socket) for port in ports if port.node == old}
        controls = {name: item.with_target(moves.get(item.target, item.target)) for name, item in self.controls.items()}
        return self._with(
            nodes=rename_key(self.nodes, old, new),
            links=move_links(self.links, moves),
            controls=controls,
            muted={new if id == old else id for id in self.muted},
            animation=move_animation(self.animation, old, new),
            ui=move_layout(self.ui, old, new),
            extra=move_keys(self.extra, f"nodes.{old}", f"nodes.{new}"),
        )

    def replace(self, id: str, item: Item) -> Self:
        """A graph where another node replaces node `id`.

        A link stays on the socket of its name, else moves to the first free one that fits. What fits none is removed.
        """
        before, interface = self.node(id), signature(item)
        after = self._with(nodes={**self.nodes, id: item})
        links = relink(
            self.links, id, signature(before), interface, lambda start, end: not after.link_fault(start, end)
        )
        find = partial(find_setting, item)
        controls = keep_controls(self.controls, id, interface, find)
        extra = self.extra if type(before) is type(item) else move_keys(self.extra, f"nodes.{id}")
        animation = keep_animation(self.animation, id, interface, find)
        return after._with(links=links, controls=controls, animation=animation, extra=extra)

    def mute(self, id: str, on: bool = True) -> Self:
        """A graph where a node is muted, so that it passes its first input through; or, with `on` False, is not."""
        self.node(id)
        return self._with(muted=self.muted | {id} if on else self.muted - {id})

    def connect(self, source: Port, target: Port) -> Self:
        """A graph with a link from `source` to `target`, which replaces an earlier link to `target`."""
        if fault := self.link_fault(source, target):
            raise GraphError(f"'{source}' cannot feed '{target}': {fault}")
        if loop := find_route(target.node, source.node, self.fed):
            raise GraphError(f"'{source}' cannot feed '{target}': {describe_loop((*loop, target.node))}")
        ui = self.ui if self.links.get(target) == source else without_route(self.ui, str(target))
        return self._with(links={**self.links, target: source}, ui=ui)

    def disconnect(self, target: Port) -> Self:
        """A graph without the link to `target`."""
        if target not in self.links:
            raise GraphError(f"nothing is linked to '{target}'")
        return self._with(links=without(self.links, target))

    def value(self, port: Port) -> Plain:
        """The setting of a value of a node, or of a control of a group."""
        return self.declaration(port).default

    def declaration(self, port: Port) -> Value:
        """The value at `port` in the unit of its number, with the setting as default. Raises GraphError."""
        item = self.node(port.node)
        return resolve_unit(_find_value(item, port.socket, port.node), item, self.settings)

    def set(self, port: Port, value: object) -> Self:
        """A graph where a value of a node, or a control of a group, is set or animated; type and range are checked."""
        return self.animate(port, value) if isinstance(value, Animation) else self.put(port, self.fit(port, value))

    def fit(self, port: Port, value: object) -> Plain:
        """Convert a setting to the type of a value. Raises GraphError if the value cannot be set to it."""
        plain = coerce(declaration := self.declaration(port), value)
        if (fault := value_fault(declaration, value)) or plain is None:
            raise GraphError(f"{port}: {fault}")
        return plain

    def put(self, port: Port, plain: Plain) -> Self:
        """`set` without checks; a port that does not exist changes nothing."""
        return self.put_all({port: plain})

    def put_all(self, plains: Mapping[Port, Plain]) -> Self:
        """`put` of many values at once."""
        changed: dict[str, dict[str, Plain]] = {}
        for (id, name), settings in group_settings((port.node, port.socket, plains[port]) for port in plains).items():
            item = self.nodes.get(id)
            if item and name in (item.graph.controls if isinstance(item, Group) else getattr(item, "values", ())):
                changed.setdefault(id, {})[name] = join_settings(settings, partial(_find_value, item, name, id))
        nodes = {
            id: item.with_values(**changed[id]) for id in changed if not isinstance(item := self.nodes[id], Unknown)
        }
        still = {port: item for port, item in self.animation.items() if not port.is_held(plains)}
        return self._with(nodes={**self.nodes, **nodes}, animation=still) if changed else self

    def animate(self, port: Port, animation: Animation | None) -> Self:
        """A graph where a value is animated; with None it is not, and has its setting again."""
        if animation is None:
            return self._with(animation=without(self.animation, port))
        if fault := animation_type_fault(port, value := self.declaration(port), animation):
            raise GraphError(fault)
        return self._with(animation={**self.animation, port: adapt_animation(value, animation)})

    def set_control(self, name: str, value: object) -> Self:
        """A graph where the value that a control points at is set."""
        return self.set(pick(self.controls, name, "the graph has no control").target, value)

    def override(self, path: str, value: object) -> Self:
        """A graph where what `path` names is set: `glow` (a control), `a.sigma` or `a.sigma.unit`, `group.a.sigma`.

        A field of a named item is `relight.lights.lamp_3.intensity` or, without the value, `relight.lamp_3.intensity`.
        """
        head, dot, rest = path.partition(".")
        if not dot:
            return self.set_control(path, value)
        if head in self.controls and head not in self.nodes:
            target = self.controls[head].target
            return self.set(Port(target.node, f"{target.socket}.{rest}"), value)
        item, (inner, deeper, _) = self.node(head), rest.partition(".")
        if isinstance(item, Node) and deeper and rest == f"{inner}.unit":
            item = choose_length_unit(Port(head, inner), item, str(value), self.settings)
            return self._with(nodes={**self.nodes, head: item})
        if isinstance(item, Group) and deeper and (inner in item.graph.nodes or inner not in item.graph.controls):
            return self._with(nodes={**self.nodes, head: Group(item.body().override(rest, value), item.path)})
        return self.set(Port(head, expand_socket(item, rest)), value)

    def add_control(self, name: str, control: Control) -> Self:
        """A graph with one more control."""
        check_name(name, "control", self.controls)
        self.declaration(control.target)
        return self._with(controls={**self.controls, name: control})

    def rename_control(self, old: str, new: str) -> Self:
        """A graph where a control has another name; expressions follow."""
        after = self._move_end("controls", old, new)
        return after if old in self.nodes else after._with(animation=move_animation(self.animation, old, new))

    def _with(self, **changes: Any) -> Self:
        if "links" in changes and "routes" in self.ui:
            ends = {str(target) for target in changes["links"]}
            changes["ui"] = keep_linked_routes(changes.get("ui", self.ui), ends)
        return dataclasses.replace(self, **changes)

    def _find_replacement_source(self, id: str, target: Port) -> Port | None:
        try:
            source = self.bypass(id, self.target(target))
        except GraphError:
            return None
        return source if source and source.node != target.node else None


def signature(item: Item) -> Signature:
    """The sockets and values of a node. Those of a group are the inputs, outputs and controls of its body."""
    return class_signature(type(item)) if isinstance(item, Node) else item.signature


def _explain_missing_node(id: str, nodes: Mapping[str, Item]) -> str:
    return f"there is no node '{make_printable(id)}'{did_you_mean(id, nodes)}"


def control_value(graph: Graph, name: str) -> Value | None:
    """The value that a control points at, with the name of the control and the setting as default; else None.

    It is never folded: what a group offers is in view, also if it is a value of a mask inside.
    """
    control = graph.controls[name]
    item = graph.nodes.get(control.target.node)
    if item is None or not (value := find_setting(item, control.target.socket)):
        return None
    value = resolve_unit(value, item, graph.settings)
    return structs.replace(value, name=name, label=control.label, doc=control.doc or value.doc, folded=False)


def _find_value(item: Item, name: str, id: str) -> Value:
    """A value, a control of a group, or a field of a named item, with its setting as default. Raises GraphError."""
    if value := find_setting(item, name):
        return value
    if fault := explain_missing_point(name, id, partial(find_setting, item)):
        raise GraphError(fault)
    head, inner, field = split_path(name)
    if inner and (value := find_setting(item, head)) and value.items:
        raise GraphError(explain_missing_field(value, f"{id}.{head}", inner, field))
    if inner and isinstance(item, Node):
        raise GraphError(f"'{id}.{name}' looks inside '{id}', which is not a group: write {id}.value")
    raise GraphError(signature(item).explain_missing_value(id, name))


def find_setting(item: Item, name: str) -> Value | None:
    """What `declaration` gives before units, or None where there is no such value."""
    if isinstance(item, Node) and name in item.values:
        return structs.replace(item.declaration(name), default=item.setting(name))
    if point := find_point(name, partial(find_setting, item)):
        return point
    head, inner, field = split_path(name)
    if inner:
        value = find_setting(item, head)
        return value and find_field(value, inner, field)
    if isinstance(item, Group) and name in item.graph.controls and (value := control_value(item.graph, name)):
        return structs.replace(value, default=item.values.get(name, value.default))
    return None


def expand_socket(item: Item, socket: str) -> str:
    """The socket with the value that holds a named item, where the user left it out."""
    values = (find_setting(item, name) for name, value in signature(item).values.items() if value.items)
    return expand_path(socket, {value.name: value for value in values if value})


def _is_pointwise(item: Item, name: str) -> bool:
    """True if a value of a node, or of a control of a group, belongs to a pointwise node, so that it can be linked."""
    while isinstance(item, Group):
        target = item.graph.controls[name].target
        item, name = item.graph.nodes[target.node], target.socket
    return isinstance(item, Pointwise)
