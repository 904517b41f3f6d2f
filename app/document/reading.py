"""From the text of a document to a Graph.

1. `syntax.parse` makes a tree of JSON. It refuses keys that are given twice, and sizes and depths beyond `limits`.
2. `migrations` bring the whole tree from its format number to the present one. So all that follows knows one format.
3. `_BodyReader` reads one body, that is the graph of a file or of a group inside it. Each section is converted to a
   record (`records`), which checks types and names the JSON path of a fault; the records become nodes, ends and links.
   Values of a node are brought from the version of the node in the file to the present one by the node's own `upgrade`.
4. A group in a file of its own is read by the same `_DocumentLoader`, once for each file. A group that holds itself is
   a fault.

Reading is strict about what it knows: a wrong type is a fault. It keeps what it does not know, because a newer version
of Halation, or a plug-in that is not installed, may have written it: an unknown key goes into `Graph.extra` under the
path of its object, a node of an unknown type becomes `Unknown` with all its keys, and a node whose code is broken does
too, with the reason. `writing` puts all of them back where they were. What is well-formed but makes no sense, such as
a link to a missing node, is no fault of reading: `graph.problems` finds it, so a user can open the graph and repair it.
"""

from __future__ import annotations

import builtins
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast, get_args

import msgspec
from halation.nodes import ColorSettings, Node, Plain, Value, catalogue
from msgspec import Struct, field

from ..custom_nodes import Code, CodeFault, Language, node_type
from ..errors import DocumentError, GraphError
from ..graph import Animation, Control, Graph, Group, Input, Item, Output, Port, Settings, Unknown, signature
from ..graph.animation import adapt_animation
from ..graph.expressions import Expression
from ..graph.graph import find_setting
from ..graph.length_units import make_node
from ..graph.model import MAX_GROUP_DEPTH
from ..graph.named_items import split_unknown
from ..graph.names import find_name_fault, name_fault
from ..resources.sandbox import Sandbox
from . import limits, records
from .animation import read_animation
from .code import CodeTally, read_code_file
from .disk import read_text, resolve_file, suggest_group_file
from .migrations import MIGRATIONS, Migration, migrate, newest
from .records import convert, read_type, unknown_keys
from .syntax import member, parse, word
from .tally import PartTally
from .values import DAMAGED, convert_value, read_units, upgrade_values

Types = Mapping[str, type[Node]]
Migrations = Mapping[int, Migration]
Extra = dict[str, Mapping[str, Any]]

_LANGUAGES = frozenset(get_args(Language))


def load(
    path: str | Path, catalogue: Types | None = None, migrations: Migrations = MIGRATIONS, *, sandbox: Sandbox
) -> Graph:
    """The graph in a file, with the groups that it names. Raises DocumentError."""
    return _DocumentLoader(_default_types(catalogue), migrations, sandbox).load_file(Path(path), sandbox)[0]


def loads(
    text: str,
    file: str = "",
    folder: str = "",
    catalogue: Types | None = None,
    migrations: Migrations = MIGRATIONS,
    *,
    sandbox: Sandbox | None,
) -> Graph:
    """The graph in `text`. `file` is its name in messages, `folder` is where relative paths start.

    With None as `sandbox` no other file is read: groups and code in files of their own are nodes of unknown types.
    """
    return _DocumentLoader(_default_types(catalogue), migrations, sandbox).load_text(text, file, folder, ())[0]


def _default_types(types: Types | None) -> Types:
    return catalogue() if types is None else types


class _DocumentLoader(Struct):
    """One call of `load`. Each file of a group is read once, even if several nodes name it."""

    types: Types
    migrations: Migrations
    sandbox: Sandbox | None
    """Where files of groups and of code may lie; None where none is read."""
    loaded: dict[Path, tuple[Graph, int]] = field(default_factory=dict[Path, tuple[Graph, int]])
    shared: dict[bytes, tuple[Item, bool]] = field(default_factory=dict[bytes, tuple[Item, bool]])
    """Nodes that were read, and whether they are muted, by their text."""
    code: CodeTally = field(default_factory=CodeTally)
    parts: PartTally = field(default_factory=PartTally)
    expressions: dict[str, Expression] = field(default_factory=dict[str, Expression])  # each text is parsed once
    kinds: dict[str, type[Node] | None] = field(default_factory=dict[str, "type[Node] | None"])
    """Node types by name, as `find_kind` has looked them up; None for unknown names."""

    def find_kind(self, type: str) -> builtins.type[Node] | None:
        """The node type of a name in the catalogue, which is asked once for each name; None if there is none."""
        if type not in self.kinds:
            self.kinds[type] = self.types.get(type)
        return self.kinds[type]

    def is_known(self, type: str) -> bool:
        """False for the type of a node that is kept as it is."""
        return type == "group" or type in _LANGUAGES or self.find_kind(type) is not None

    def load_file(self, path: Path, sandbox: Sandbox, outer: tuple[Path, ...] = ()) -> tuple[Graph, int]:
        """The graph in a file, and how many nodes it has when all groups are expanded."""
        real = resolve_file(path) or path
        if real not in self.loaded:
            self.loaded[real] = self.load_text(
                read_text(path, sandbox=sandbox), str(path), str(path.parent), (*outer, real)
            )
        return self.loaded[real]

    def load_text(self, text: str, file: str, folder: str, outer: tuple[Path, ...]) -> tuple[Graph, int]:
        """The graph in a text, and how many nodes it has when all groups are expanded."""
        raw = parse(text, file)
        if "halation" not in raw:
            raise DocumentError(file, "", 'this is no graph: the key "halation", its format number, is missing')
        format = convert(raw, records.FormatRecord, file, "").halation
        newest_format = newest(self.migrations)
        if format > newest_format:
            raise DocumentError(file, "halation", _newer(f"format {format}", newest_format), rule="newer-version")
        try:
            raw = migrate(raw, format, self.migrations)
        except DAMAGED:
            fault = f"the file is damaged: it says format {format}, but cannot be brought to format {newest_format}"
            raise DocumentError(file, "halation", fault) from None
        return _BodyReader(self, file, folder, outer).read_graph(raw, "", len(outer))


class _BodyReader(Struct):
    """Reads a body. `file` begins messages, and relative paths start at `folder`.

    `outer` are the files around it and its own, `at` is its JSON path, `extra` collects unknown keys.
    """

    loading: _DocumentLoader
    file: str
    folder: str
    outer: tuple[Path, ...]
    at: str = ""
    extra: Extra = field(default_factory=Extra)

    def read_graph(self, raw: dict[str, Any], at: str, depth: int) -> tuple[Graph, int]:
        """The graph at JSON path `at`, and its number of nodes."""
        reader = _BodyReader(self.loading, self.file, self.folder, self.outer, at)
        record = convert(raw, records.GraphRecord, self.file, at)
        reader.keep_unknown("", raw, records.GraphRecord)
        if refusal := self.loading.parts.add(record, self.loading.is_known):
            raise DocumentError(self.file, member(at, refusal[0]), refusal[1])
        settings = convert(record.settings, records.SettingsRecord, self.file, member(at, "settings"))
        reader.keep_unknown("settings", record.settings, records.SettingsRecord)
        color = convert(settings.color, records.ColorRecord, self.file, member(at, "settings.color"))
        reader.keep_unknown("settings.color", settings.color, records.ColorRecord)
        nodes, muted, count, section = dict[str, Item](), set[str](), 0, member(at, "nodes")
        has_odd_names = find_name_fault(record.nodes, "node") is not None
        for id, node in record.nodes.items():
            if has_odd_names:
                reader.entry_path(section, id, "node")
            nodes[id], number, is_muted = reader.read_entry(id, node, section, depth)
            count += number
            if count > limits.MAX_NODES:
                raise DocumentError(self.file, member(section, id), limits.refuse_nodes())
            if is_muted:
                muted.add(id)
        graph = Graph(
            nodes=nodes,
            links=reader.read_links(record.links, at),
            inputs={name: reader.read_input(name, end, at) for name, end in record.inputs.items()},
            outputs={name: reader.read_output(name, end, at) for name, end in record.outputs.items()},
            controls={name: reader.read_control(name, item, at) for name, item in record.controls.items()},
            animation=reader.read_animations(record.animation, nodes, at),
            settings=Settings(
                settings.size,
                settings.frames,
                settings.rate,
                settings.preroll,
                ColorSettings(color.config, color.working),
                settings.allow,
                settings.reference_height,
                settings.overscan,
            ),
            muted=frozenset(muted),
            ui=record.ui,
            extra=reader.extra,
            folder=self.folder,
        )
        return graph, count

    def keep_unknown(self, path: str, raw: Mapping[str, Any], kind: records.RecordType) -> None:
        """Keep the unknown keys of the object at `path` (inside this graph), so that they are saved again."""
        if keys := unknown_keys(raw, kind):
            self.keep(path, keys)

    def keep(self, path: str, keys: dict[str, Any]) -> None:
        """Keep keys of the object at `path`. Raises DocumentError for too many."""
        if fault := self.loading.parts.keep(keys):
            raise DocumentError(self.file, member(self.at, path) if path else self.at, fault)
        self.extra[path] = keys

    def entry_path(self, section: str, name: str, kind: str) -> str:
        """The JSON path of an entry of the section at this path. Raises DocumentError for an invalid name."""
        if fault := name_fault(name, kind):
            raise DocumentError(self.file, section, fault)
        return member(section, name)

    def parse_port(self, text: Any, section: str, key: str) -> Port:
        """The port that a link or control names, which `key` of a section holds or is."""
        if not isinstance(text, str):
            raise DocumentError(self.file, member(section, key), f"expected a string, got {word(text)}")
        try:
            return Port.parse(text)
        except GraphError as error:
            raise DocumentError(self.file, member(section, key), str(error)) from None

    def read_links(self, raw: Mapping[str, Any], at: str) -> dict[Port, Port]:
        """The section `links`, target to source."""
        where = member(at, "links")
        return {
            self.parse_port(target, where, target): self.parse_port(source, where, target)
            for target, source in raw.items()
        }

    def read_input(self, name: str, raw: Any, at: str) -> Input:
        """An entry of `inputs`."""
        where = self.entry_path(member(at, "inputs"), name, "input")
        record = convert(raw, records.InputRecord, self.file, where)
        self.keep_unknown(f"inputs.{name}", raw, records.InputRecord)
        kind, width = read_type(record.type, self.file, where)
        return Input(
            kind, width, record.file, record.layer, record.default, record.doc, record.missing, record.color_space
        )

    def read_output(self, name: str, raw: Any, at: str) -> Output:
        """An entry of `outputs`."""
        where = self.entry_path(member(at, "outputs"), name, "output")
        record = convert(raw, records.OutputRecord, self.file, where)
        self.keep_unknown(f"outputs.{name}", raw, records.OutputRecord)
        return Output(*read_type(record.type, self.file, where), record.layer, record.view, record.overscan)

    def read_control(self, name: str, raw: Any, at: str) -> Control:
        """An entry of `controls`."""
        where = self.entry_path(member(at, "controls"), name, "control")
        record = convert(raw, records.ControlRecord, self.file, where)
        self.keep_unknown(f"controls.{name}", raw, records.ControlRecord)
        return Control(self.parse_port(record.target, where, "target"), record.label, record.doc)

    def read_animations(self, raw: Mapping[str, Any], nodes: Mapping[str, Item], at: str) -> dict[Port, Animation]:
        """The section `animation`, by target."""
        animations, section = dict[Port, Animation](), member(at, "animation")
        for target, item in raw.items():
            port = self.parse_port(target, section, target)
            where = member(section, target)
            value = find_setting(nodes[port.node], port.socket) if port.node in nodes else None
            animation = read_animation(item, self.file, where, value)
            if isinstance(animation, Expression):
                animation = self.loading.expressions.setdefault(animation.text, animation)
            animations[port] = adapt_animation(value, animation) if value else animation
            self.keep_unknown(f"animation.{target}", item, records.AnimationRecord)
        return animations

    def read_entry(self, id: str, raw: Any, section: str, depth: int) -> tuple[Item, int, bool]:
        """A node of a section, how many nodes it has when groups are expanded, and whether it is muted.

        Nodes are immutable, and many are written alike: such nodes are one object, which is read once. A node is not
        shared if something of it is kept in `extra`, or if it may read a file.
        """
        if (node := self.loading.shared.get(text := msgspec.json.encode(raw))) is not None:
            return node[0], 1, node[1]
        at, unknown_count = member(section, id), len(self.extra)
        entry = cast("dict[str, Any]", raw) if isinstance(raw, dict) else {}
        type = entry.get("type")
        if isinstance(type, str) and (kind := self.loading.find_kind(type)):
            record, count = convert(entry, records.NodeRecord, self.file, at), 1
            self.keep_unknown(f"nodes.{id}", entry, records.NodeRecord)
            item: Item = self.read_node(id, kind, record, at)
        else:
            record = convert(raw, records.TypeRecord, self.file, at)
            item, count = self.read_item(id, entry, record.type, at, depth)
        if record.type not in _LANGUAGES and not isinstance(item, Group) and len(self.extra) == unknown_count:
            self.loading.shared[text] = item, record.muted
        return item, count, record.muted

    def read_item(self, id: str, raw: dict[str, Any], type: str, at: str, depth: int) -> tuple[Item, int]:
        """A node of no type of the catalogue, and how many nodes it has when groups are expanded."""
        reads_files = self.loading.sandbox is not None
        if type == "group" and (reads_files or not raw.get("path")):
            return self.read_group(id, raw, at, depth)
        if type in _LANGUAGES and (reads_files or not raw.get("file")):
            return self.read_code_node(id, raw, cast("Language", type), at), 1
        kept = unknown_keys(raw, records.TypeRecord)
        if fault := self.loading.parts.keep(kept, is_node=True):
            raise DocumentError(self.file, at, fault)
        return Unknown(type, kept), 1

    def read_node(self, id: str, kind: type[Node], record: records.NodeRecord, at: str) -> Node:
        """A node of a known type, its values brought up to its present version."""
        if record.version > kind.version:
            fault = _newer(f"version {record.version} of '{kind.id}'", kind.version)
            raise DocumentError(self.file, member(at, "version"), fault, rule="newer-version")
        if (record.values or record.units) and (refusal := self.loading.parts.add_values(kind.values, record)):
            raise DocumentError(self.file, member(at, refusal[0]), refusal[1])
        values = upgrade_values(kind, record, self.file, at)
        if record.package and (record.version == kind.version or not kind.required_package):
            self.keep_package(id, record.package, kind)
        units = read_units(record.units, kind.values, self.file, at)
        return make_node(kind, self.read_values(f"nodes.{id}", values, kind.values, at), units)

    def keep_package(self, id: str, package: str, kind: type[Node]) -> None:
        """Note which plug-in a file asks for: it stays as it is until a newer version of the node type is saved."""
        if package != kind.required_package:
            self.extra[f"nodes.{id}"] = {**self.extra.get(f"nodes.{id}", {}), "package": package}

    def read_code_node(self, id: str, raw: dict[str, Any], language: Language, at: str) -> Item:
        """A node made of the user's code. If the code is invalid, the node is `Unknown` and holds the reason."""
        record = convert(raw, records.CodeRecord, self.file, at)
        if (record.code is None) == (not record.file):
            fault = f'a node of type "{language}" needs either "code", its lines, or "file", the name of a file'
            raise DocumentError(self.file, at, fault)
        try:
            code = self.find_code(record, language)
            if fault := self.loading.code.add(code):
                raise DocumentError(self.file, at, fault)
            kind = node_type(code)
        except CodeFault as fault:
            reason = f"{record.file or 'its code'}, {fault}" if fault.line else str(fault)
            return Unknown(language, unknown_keys(raw, records.TypeRecord), reason)
        self.keep_unknown(f"nodes.{id}", raw, records.CodeRecord)
        units = read_units(record.units, kind.values, self.file, at)
        return make_node(kind, self.read_values(f"nodes.{id}", record.values, kind.values, at), units)

    def find_code(self, record: records.CodeRecord, language: Language) -> Code:
        """The code in a record, or in the file that it names. Raises CodeFault."""
        if record.code is not None:
            return Code(language, "\n".join(record.code))
        assert self.loading.sandbox is not None, "code in files is not read without a sandbox"
        return read_code_file(language, record.file or "", self.folder, self.loading.sandbox)

    def read_values(self, path: str, raw: dict[str, Any], declared: Mapping[str, Value], at: str) -> dict[str, Plain]:
        """The declared values, converted to their types; others are kept. `problems` checks ranges and choices."""
        values: dict[str, Plain] = {}
        for name, setting in raw.items():
            if name in declared:
                if declared[name].items and isinstance(setting, dict):
                    objects = cast("dict[str, Any]", setting)
                    setting = self.keep_unknown_fields(f"{path}.values.{name}", declared[name], objects)
                values[name] = convert_value(declared[name], setting, self.file, at)
        if len(values) < len(raw):
            self.keep(f"{path}.values", {name: setting for name, setting in raw.items() if name not in declared})
        return values

    def keep_unknown_fields(self, path: str, value: Value, objects: dict[str, Any]) -> dict[str, Any]:
        """Named items without the kinds and fields that this version does not know, which are saved again."""
        assert value.items is not None
        known, unknown = split_unknown(value.items, objects)
        for place, keys in unknown.items():
            self.keep(".".join((path, *place)), keys)
        return known

    def read_group(self, id: str, raw: dict[str, Any], at: str, depth: int) -> tuple[Group, int]:
        """A group, and how many nodes it has when groups are expanded."""
        record = convert(raw, records.GroupRecord, self.file, at)
        self.keep_unknown(f"nodes.{id}", raw, records.GroupRecord)
        if depth > MAX_GROUP_DEPTH:
            raise DocumentError(self.file, at, f"groups nest deeper than {MAX_GROUP_DEPTH}; flatten some of them")
        if (record.graph is None) == (not record.path):
            raise DocumentError(self.file, at, 'a group needs either "graph", its body, or "path", the file of one')
        if record.path:
            graph, count = self.read_group_file(record.path, member(at, "path"))
        else:
            graph, count = self.read_graph(record.graph or {}, member(at, "graph"), depth + 1)
        values = self.read_values(f"nodes.{id}", record.values, signature(Group(graph)).values, at)
        return Group(graph, record.path or "", values), count + limits.GROUP_COST

    def read_group_file(self, path: str, at: str) -> tuple[Graph, int]:
        """The graph in a group's file."""
        inner, sandbox = Path(self.folder, path), self.loading.sandbox
        assert sandbox is not None, "groups in files are not read without a sandbox"
        if reason := sandbox.find_read_fault(inner):
            raise DocumentError(self.file, at, f"the group file '{inner}' {reason}")
        real = resolve_file(inner)
        if real is None:
            fault = f"the group file '{inner}' does not exist{suggest_group_file(inner, path)}"
            raise DocumentError(self.file, at, fault, rule="missing-group")
        if real in self.outer:
            loop = " -> ".join(file.name for file in (*self.outer[self.outer.index(real) :], real))
            raise DocumentError(self.file, at, f"a group cannot hold itself: {loop}")
        return self.loading.load_file(inner, sandbox, self.outer)


def _newer(subject: str, newest_known: int) -> str:
    return f"{subject} is newer than {newest_known}, the newest known here: update Halation"
