"""JSON -> Graph. Strict about what it knows, and keeps what it does not know."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast, get_args

from halation.nodes import ColorSettings, Node, Plain, Value, catalogue
from msgspec import Struct, field

from ..custom_nodes import CodeFault, Language, node_type
from ..errors import DocumentError, GraphError
from ..graph import Animation, Control, Graph, Group, Input, Item, Output, Port, Settings, Unknown, signature
from ..graph.animation import adapted
from ..graph.names import did_you_mean, name_fault
from ..graph.values import coerced, expected
from ..resources.sandbox import outside
from . import limits, records
from .animation import read_animation
from .code import read_code
from .disk import read_text
from .migrations import MIGRATIONS, Migration, migrate, newest
from .records import convert, read_type, unknown_keys
from .syntax import member, parse, word

Types = Mapping[str, type[Node]]
Migrations = Mapping[int, Migration]
Extra = dict[str, Mapping[str, Any]]

_DAMAGED = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
"""What a migration raises when the old file is not what it claims to be."""


def load(path: str | Path, catalogue: Types | None = None, migrations: Migrations = MIGRATIONS) -> Graph:
    """The graph in a file, with the groups that it names. Raises DocumentError."""
    return _Loading(_types(catalogue), migrations).file(Path(path))[0]


def loads(
    text: str,
    file: str = "",
    folder: str = "",
    catalogue: Types | None = None,
    migrations: Migrations = MIGRATIONS,
    *,
    follow: bool = True,
) -> Graph:
    """The graph in `text`. `file` is its name in messages, `folder` is where relative paths start.

    Without `follow` no other file is read: groups and code in files of their own are nodes of unknown types.
    """
    return _Loading(_types(catalogue), migrations, follow).text(text, file, folder, ())[0]


def _types(given: Types | None) -> Types:
    return catalogue() if given is None else given


class _Loading(Struct):
    """One call of `load`: every group file is read once, however often it is named."""

    types: Types
    migrations: Migrations
    follow: bool = True
    done: dict[Path, tuple[Graph, int]] = field(default_factory=dict[Path, tuple[Graph, int]])

    def file(self, path: Path, outer: tuple[Path, ...] = ()) -> tuple[Graph, int]:
        """The graph in a file, and how many nodes it has when all groups are expanded."""
        real = _real(path) or path
        if real not in self.done:
            self.done[real] = self.text(read_text(path), str(path), str(path.parent), (*outer, real))
        return self.done[real]

    def text(self, text: str, file: str, folder: str, outer: tuple[Path, ...]) -> tuple[Graph, int]:
        """The graph in a text, and how many nodes it has when all groups are expanded."""
        raw = parse(text, file)
        if "halation" not in raw:
            raise DocumentError(file, "", 'this is no graph: the key "halation", its format number, is missing')
        format = convert(raw, records.FormatRecord, file, "").halation
        now = newest(self.migrations)
        if format > now:
            raise DocumentError(file, "halation", _newer(f"format {format}", now), rule="newer-version")
        try:
            raw = migrate(raw, format, self.migrations)
        except _DAMAGED:
            fault = f"the file is damaged: it says format {format}, but cannot be brought to format {now}"
            raise DocumentError(file, "halation", fault) from None
        return _Body(self, file, folder, outer).graph(raw, "", len(outer))


class _Body(Struct):
    """One file: what its paths and messages start from. `outer` are the files that led here, itself included."""

    loading: _Loading
    file: str
    folder: str
    outer: tuple[Path, ...]
    extra: Extra = field(default_factory=Extra)

    def graph(self, raw: dict[str, Any], at: str, depth: int) -> tuple[Graph, int]:
        """The graph at JSON path `at`, and its number of nodes."""
        reader = _Body(self.loading, self.file, self.folder, self.outer)
        record = convert(raw, records.GraphRecord, self.file, at)
        reader.keep("", raw, records.GraphRecord)
        settings = convert(record.settings, records.SettingsRecord, self.file, member(at, "settings"))
        reader.keep("settings", record.settings, records.SettingsRecord)
        color = convert(settings.color, records.ColorRecord, self.file, member(at, "settings.color"))
        reader.keep("settings.color", settings.color, records.ColorRecord)
        nodes, muted, count = dict[str, Item](), set[str](), 0
        for id, node in record.nodes.items():
            where = reader.named(at, "nodes", id, "node")
            common = convert(node, records.TypeRecord, self.file, where)
            nodes[id], number = reader.item(id, node, common.type, where, depth)
            count += number
            if count > limits.MAX_NODES:
                raise DocumentError(self.file, where, f"with all groups there are more than {limits.MAX_NODES} nodes")
            if common.muted:
                muted.add(id)
        graph = Graph(
            nodes=nodes,
            links=reader.links(record.links, at),
            inputs={name: reader.input(name, end, at) for name, end in record.inputs.items()},
            outputs={name: reader.output(name, end, at) for name, end in record.outputs.items()},
            controls={name: reader.control(name, item, at) for name, item in record.controls.items()},
            animation=reader.animation(record.animation, nodes, at),
            settings=Settings(
                settings.size,
                settings.frames,
                settings.rate,
                settings.preroll,
                ColorSettings(color.config, color.working),
                settings.allow,
            ),
            muted=frozenset(muted),
            ui=record.ui,
            extra=reader.extra,
            folder=self.folder,
        )
        return graph, count

    def keep(self, path: str, raw: Mapping[str, Any], kind: records.RecordType) -> None:
        """Note the keys of the object at `path` (inside this graph) that mean nothing."""
        if keys := unknown_keys(raw, kind):
            self.extra[path] = keys

    def named(self, at: str, section: str, name: str, what: str) -> str:
        """The JSON path of an entry; its name is checked."""
        if fault := name_fault(name, what):
            raise DocumentError(self.file, member(at, section), fault)
        return member(member(at, section), name)

    def port(self, text: Any, path: str) -> Port:
        """The port that a link or control at `path` names."""
        if not isinstance(text, str):
            raise DocumentError(self.file, path, f"expected a string, got {word(text)}")
        try:
            return Port.parse(text)
        except GraphError as error:
            raise DocumentError(self.file, path, str(error)) from None

    def links(self, raw: Mapping[str, Any], at: str) -> dict[Port, Port]:
        """The section `links`, target to source."""
        where = member(at, "links")
        return {
            self.port(target, member(where, target)): self.port(source, member(where, target))
            for target, source in raw.items()
        }

    def input(self, name: str, raw: Any, at: str) -> Input:
        """An entry of `inputs`."""
        where = self.named(at, "inputs", name, "input")
        found = convert(raw, records.InputRecord, self.file, where)
        self.keep(f"inputs.{name}", raw, records.InputRecord)
        kind, width = read_type(found.type, self.file, where)
        return Input(kind, width, found.file, found.layer, found.default, found.doc, found.missing, found.color_space)

    def output(self, name: str, raw: Any, at: str) -> Output:
        """An entry of `outputs`."""
        where = self.named(at, "outputs", name, "output")
        found = convert(raw, records.OutputRecord, self.file, where)
        self.keep(f"outputs.{name}", raw, records.OutputRecord)
        return Output(*read_type(found.type, self.file, where), found.layer, found.view)

    def control(self, name: str, raw: Any, at: str) -> Control:
        """An entry of `controls`."""
        where = self.named(at, "controls", name, "control")
        found = convert(raw, records.ControlRecord, self.file, where)
        self.keep(f"controls.{name}", raw, records.ControlRecord)
        return Control(self.port(found.target, member(where, "target")), found.label, found.doc)

    def animation(self, raw: Mapping[str, Any], nodes: Mapping[str, Item], at: str) -> dict[Port, Animation]:
        """The section `animation`, by target."""
        found: dict[Port, Animation] = {}
        for target, item in raw.items():
            where = member(member(at, "animation"), target)
            port, animation = self.port(target, where), read_animation(item, self.file, where)
            value = signature(nodes[port.node]).values.get(port.socket) if port.node in nodes else None
            found[port] = adapted(value, animation) if value else animation
            self.keep(f"animation.{target}", item, records.AnimationRecord)
        return found

    def item(self, id: str, raw: dict[str, Any], type: str, at: str, depth: int) -> tuple[Item, int]:
        """A node, and how many it stands for."""
        if type == "group" and (self.loading.follow or not raw.get("path")):
            return self.group(id, raw, at, depth)
        if type in get_args(Language) and (self.loading.follow or not raw.get("file")):
            return self.written(id, raw, cast("Language", type), at), 1
        if type not in self.loading.types:
            return Unknown(type, unknown_keys(raw, records.TypeRecord)), 1
        self.keep(f"nodes.{id}", raw, records.NodeRecord)
        return self.node(id, self.loading.types[type], convert(raw, records.NodeRecord, self.file, at), at), 1

    def node(self, id: str, kind: type[Node], record: records.NodeRecord, at: str) -> Node:
        """A node of a known type, its values brought up to its present version."""
        if record.version > kind.version:
            fault = _newer(f"version {record.version} of '{kind.id}'", kind.version)
            raise DocumentError(self.file, member(at, "version"), fault, rule="newer-version")
        values = dict(record.values)
        try:
            for version in range(record.version, kind.version):
                values = dict(kind.upgrade(version, values))
        except _DAMAGED:
            fault = f"these are no values of version {record.version} of '{kind.id}'"
            raise DocumentError(self.file, member(at, "values"), fault) from None
        if record.package and (record.version == kind.version or not kind.package):
            self.keep_package(id, record.package, kind)
        return kind(**self.values(f"nodes.{id}", values, kind.values, at))

    def keep_package(self, id: str, package: str, kind: type[Node]) -> None:
        """Note which plug-in a file asks for: it stays as it is until a newer version of the node type is saved."""
        if package != kind.package:
            self.extra[f"nodes.{id}"] = {**self.extra.get(f"nodes.{id}", {}), "package": package}

    def written(self, id: str, raw: dict[str, Any], language: Language, at: str) -> Item:
        """A node made of code. One whose code says no node is kept as it is, with the reason."""
        record = convert(raw, records.CodeRecord, self.file, at)
        if (record.code is None) == (not record.file):
            fault = f'a node of type "{language}" needs either "code", its lines, or "file", the name of a file'
            raise DocumentError(self.file, at, fault)
        try:
            kind = node_type(read_code(language, record.code, record.file or "", self.folder))
        except CodeFault as fault:
            said = f"{record.file or 'its code'}, {fault}" if fault.line else str(fault)
            return Unknown(language, unknown_keys(raw, records.TypeRecord), said)
        self.keep(f"nodes.{id}", raw, records.CodeRecord)
        return kind(**self.values(f"nodes.{id}", record.values, kind.values, at))

    def values(self, path: str, raw: dict[str, Any], known: Mapping[str, Value], at: str) -> dict[str, Plain]:
        """The values that are `known`, by type; ranges and choices are for `problems`. The others are kept aside."""
        found: dict[str, Plain] = {}
        for name, given in raw.items():
            if name in known:
                plain = coerced(known[name], given)
                if plain is None:
                    fault = f"expected {expected(known[name])}, got {word(given)}"
                    raise DocumentError(self.file, member(member(at, "values"), name), fault)
                found[name] = plain
        if others := {name: given for name, given in raw.items() if name not in known}:
            self.extra[f"{path}.values"] = others
        return found

    def group(self, id: str, raw: dict[str, Any], at: str, depth: int) -> tuple[Group, int]:
        """A group, and how many nodes it stands for."""
        record = convert(raw, records.GroupRecord, self.file, at)
        self.keep(f"nodes.{id}", raw, records.GroupRecord)
        if depth > limits.MAX_GROUPS:
            raise DocumentError(self.file, at, f"groups nest deeper than {limits.MAX_GROUPS}; flatten some of them")
        if (record.graph is None) == (not record.path):
            raise DocumentError(self.file, at, 'a group needs either "graph", its body, or "path", the file of one')
        if record.path:
            graph, count = self.group_file(record.path, member(at, "path"))
        else:
            graph, count = self.graph(record.graph or {}, member(at, "graph"), depth + 1)
        values = self.values(f"nodes.{id}", record.values, signature(Group(graph)).values, at)
        return Group(graph, record.path or "", values), count + 1

    def group_file(self, path: str, at: str) -> tuple[Graph, int]:
        """The graph in a group's file."""
        inner = Path(self.folder, path)
        if said := outside(inner):
            raise DocumentError(self.file, at, f"the group file '{inner}' {said}")
        real = _real(inner)
        if real is None:
            near = did_you_mean(inner.name, _graphs_in(inner.parent))
            fault = f"the group file '{inner}' does not exist{near}"
            raise DocumentError(self.file, at, fault, rule="missing-group")
        if real in self.outer:
            loop = " -> ".join(one.name for one in (*self.outer[self.outer.index(real) :], real))
            raise DocumentError(self.file, at, f"a group cannot hold itself: {loop}")
        return self.loading.file(inner, self.outer)


def _real(path: Path) -> Path | None:
    """The file with links followed, or None if there is none."""
    try:
        real = path.resolve()
        return real if real.is_file() else None
    except (OSError, ValueError, RuntimeError):
        return None


def _newer(what: str, known: int) -> str:
    return f"{what} is newer than {known}, the newest known here: update Halation"


def _graphs_in(folder: Path) -> tuple[str, ...]:
    try:
        return tuple(path.name for path in folder.glob("*.json"))
    except (OSError, ValueError):
        return ()
