"""The format as a JSON Schema (draft 2020-12), made of the catalogue and of the records that reading uses.

JSON Schema cannot express some rules, which are left to `halation check`: that links fit, that keys are in order, that
there are no loops.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Mapping
from typing import Any, get_args

import msgspec
from halation.nodes import MAX_POINTS, SPLINE_ROWS, STROKE_ROWS, ItemKind, Items, ItemSet, Node, Value, is_length

from ..custom_nodes import Language
from ..graph import INPUTS, OUTPUTS
from ..graph.named_items import KIND, describe_items
from ..graph.scalars import describe_scalar
from . import records
from .migrations import FORMAT

Schema = dict[str, Any]

DIALECT = "https://json-schema.org/draft/2020-12/schema"

_PORT: Schema = {"type": "string", "pattern": r"^[^.]+\.[^.]+$"}
_VALUE_PATH: Schema = {"type": "string", "pattern": r"^[^.]+\.[^.]+(\.[^.]+\.[^.]+)?(\.\d{1,4})?$"}
_NAME: Schema = {"pattern": "^[^./\\u0000-\\u001f\\u007f]+$"}
_LENGTH_UNIT: Schema = {"type": "string", "pattern": r"^(px|height|px@[1-9]\d{0,4})$"}
_NUMBERS: Schema = {"type": "array", "items": {"type": "number"}}
_SPLINE, _STROKE = (
    {"type": "array", "items": {**_NUMBERS, "minItems": 2, "maxItems": rows.length}, "minItems": 1}
    for rows in (SPLINE_ROWS, STROKE_ROWS)
)

_DOCS = {
    "GraphRecord.halation": "The number of the format.",
    "GraphRecord.settings": "What holds for the graph as a whole.",
    "GraphRecord.inputs": "The inputs of the graph, by name: pictures and numbers.",
    "GraphRecord.outputs": "The outputs of the graph, by name.",
    "GraphRecord.controls": "Values that users of the graph can set, by names of its own.",
    "GraphRecord.nodes": "Nodes by id.",
    "GraphRecord.links": 'Links from target to source: "bloom.image": "inputs.beauty".',
    "GraphRecord.animation": "Values that change over time, by node.value.",
    "GraphRecord.ui": "The layout in the editor. No picture depends on it.",
    "SettingsRecord.size": "Width and height of the canvas in pixels; by default those of the first picture.",
    "SettingsRecord.frames": "The first and the last frame.",
    "SettingsRecord.rate": "Frames per second.",
    "SettingsRecord.preroll": "How many frames before the requested one nodes with a memory start.",
    "SettingsRecord.reference_height": "Numbers of lengths in pixels are pixels of a picture of this height.",
    "SettingsRecord.overscan": "How far beyond their frame pictures are kept, in heights of the frame.",
    "SettingsRecord.color": "How colors are managed.",
    "SettingsRecord.allow": "Warnings of halation check that are intended: a reason for each rule, or rule:node.",
    "InputRecord.type": "The type of the pictures or numbers.",
    "InputRecord.file": "The picture that is read unless another one is bound, relative to this file.",
    "InputRecord.layer": "The layer of the file; empty for its first color layer.",
    "InputRecord.missing": "What a frame shows that has no file.",
    "InputRecord.default": "One number, or one for each channel, where there is no picture.",
    "OutputRecord.layer": "The name of the layer in a file of several; by default that of the output.",
    "OutputRecord.view": "The view that shows it; none for what a tone map made ready for the display.",
    "OutputRecord.overscan": "Whether an EXR file gets the pixels beyond the frame as well.",
    "ControlRecord.target": "The value that it sets, as node.value.",
    "AnimationRecord.keys": "Keys in the order of their frames.",
    "AnimationRecord.outside": "What comes before the first key and after the last.",
    "AnimationRecord.expression": "A formula, such as 0.5 + 0.5 * sin(time).",
    "TypeRecord.muted": "A muted node passes its first input through.",
    "GroupRecord.graph": "The body of the group.",
    "GroupRecord.path": "The file with the body of the group, relative to this one.",
    "CodeRecord.code": "The code, line by line.",
    "CodeRecord.file": "The file with the code, relative to this one.",
    "NodeRecord.version": "The version of the node type that saved the values.",
    "NodeRecord.package": "The plug-in that brings the node type, as pip installs it: acme-glow==1.2.0.",
    "NodeRecord.values": "What differs from the default.",
    "NodeRecord.units": "Units of single lengths: px, height, or px at a height, such as px@1080.",
}


def schema(types: Mapping[str, type[Node]]) -> Schema:
    """The schema of a graph file, for these node types by id."""
    node_schemas = {f"node.{id}": _node(kind) for id, kind in sorted(types.items())}
    languages = sorted(get_args(Language))
    code = _either(_record(records.CodeRecord), code="array", file="name")
    homes = {**{id: f"node.{id}" for id in sorted(types)}, "group": "group", **dict.fromkeys(languages, "code")}
    type_name: Schema = {"description": "What it does.", "anyOf": [{"enum": list(homes)}, {"type": "string"}]}
    return {
        "$schema": DIALECT,
        "title": "Halation graph",
        "description": "A graph of effects. See halation nodes for what each of them does.",
        "allOf": [{"$ref": "#/$defs/graph"}],
        "type": "object",
        "required": ["halation"],
        "properties": {
            "$schema": {"description": "Where text editors find the schema; Halation ignores it."},
            "halation": {"type": "integer", "minimum": 1, "maximum": FORMAT},
        },
        "$defs": {
            "graph": _graph(),
            "node": {
                **_record(records.TypeRecord, type=type_name),
                "allOf": [_case(type, home) for type, home in homes.items()],
            },
            "group": _either(_record(records.GroupRecord, graph=_nullable("graph")), graph="object", path="name"),
            "code": code,
            "animation": _either(
                _record(records.AnimationRecord, keys={"type": ["array", "null"], "items": {"$ref": "#/$defs/key"}}),
                keys="array",
                expression="string",
            ),
            "key": _record(
                records.KeyRecord,
                value={
                    "anyOf": [
                        {"type": ["number", "boolean"]},
                        {**_NUMBERS, "minItems": 1},
                        {"$ref": "#/$defs/spline"},
                    ]
                },
            ),
            "curve": _points(2, range(2, MAX_POINTS + 1)),
            "ramp": _points(5, range(2, MAX_POINTS + 1)),
            "spline": _SPLINE,
            "stroke": _STROKE,
            **node_schemas,
        },
    }


def _graph() -> Schema:
    """A document, or the body of a group."""
    nodes = {**_NAME, "not": {"enum": [INPUTS, OUTPUTS]}}
    type_names = {"enum": sorted(records.type_names()), "default": "Image"}
    color = _record(records.ColorRecord)
    return _record(
        records.GraphRecord,
        halation={},
        settings=_record(records.SettingsRecord, color=color),
        inputs=_entries(_record(records.InputRecord, type=type_names), _NAME),
        outputs=_entries(_record(records.OutputRecord, type=type_names), _NAME),
        controls=_entries(_record(records.ControlRecord, target=_VALUE_PATH), _NAME),
        nodes=_entries({"$ref": "#/$defs/node"}, nodes),
        links=_entries(_PORT, _PORT),
        animation=_entries({"$ref": "#/$defs/animation"}, _VALUE_PATH),
    )


def _record(kind: records.RecordType, **field_schemas: Schema) -> Schema:
    """A record; `field_schemas` are more exact than the types of its fields. Other keys are kept, so they are allowed.

    The fields of every node are defined once.
    """
    _, parts = msgspec.json.schema_components([kind])
    record_schema: Schema = parts[kind.__name__]
    fields: dict[str, Schema] = record_schema["properties"]
    homes = [base for base in kind.__mro__ if issubclass(base, msgspec.Struct)]

    def field(name: str) -> Schema:
        doc = next((description for home in homes if (description := _DOCS.get(f"{home.__name__}.{name}"))), "")
        return {**(field_schemas.get(name) or fields[name]), **({"description": doc} if doc else {})}

    shared = () if kind is records.TypeRecord else records.TypeRecord.__struct_fields__
    own = [name for name in fields if name not in shared or not issubclass(kind, records.TypeRecord)]
    needed = [name for name in record_schema["required"] if name in own]
    return {
        "type": "object",
        "properties": {name: field(name) for name in own},
        **({"required": needed} if needed else {}),
    }


def _node(kind: type[Node]) -> Schema:
    """A node of a type. Values of an older version of the type are not checked."""
    values: Schema = {
        "type": "object",
        "properties": {name: _value(value) for name, value in kind.values.items()},
    }
    version = {"type": "integer", "minimum": 1, "maximum": kind.version, "default": 1}
    lengths = [name for name, value in kind.values.items() if is_length(value)]
    units: Schema = {
        "type": "object",
        "properties": dict.fromkeys(lengths, _LENGTH_UNIT),
        "additionalProperties": False,
    }
    node_schema = _record(
        records.NodeRecord, version=version, units=units, **({"values": values} if kind.version == 1 else {})
    )
    if kind.version > 1:
        present: Schema = {"properties": {"version": {"const": kind.version}}, "required": ["version"]}
        node_schema |= {"if": present, "then": {"properties": {"values": values}}}
    return {"description": inspect.getdoc(kind) or "", **node_schema}


def _value(value: Value) -> Schema:
    """The schema of a value."""
    limits = (("minimum", value.minimum), ("maximum", value.maximum))
    bounds: Schema = {name: limit for name, limit in limits if math.isfinite(limit)}
    number: Schema = {"type": "number", **bounds}
    match value.type:
        case "float":
            type_schema = number
        case "int":
            type_schema = {"type": "integer", **bounds}
        case "bool":
            type_schema: Schema = {"type": "boolean"}
        case "choice":
            type_schema = {"enum": list(value.choices)}
        case "path" | "text":
            type_schema = {"type": "string"}
        case "color" | "vector" | "matrix":
            type_schema = {"type": "array", "items": number, "minItems": value.length, "maxItems": value.length}
        case "point":
            type_schema = {**_NUMBERS, "minItems": 2, "maxItems": SPLINE_ROWS.length}
        case "curve" | "ramp" | "spline" | "stroke":
            type_schema = {"$ref": f"#/$defs/{value.type}"}
        case "items":
            assert value.items is not None
            type_schema = _items(value.items)
    unit = f"Unit: {value.unit}." if value.unit else ""
    doc = " ".join(part for part in (value.doc, unit) if part)
    default = _describe_default(value)
    return {**type_schema, "default": default, **({"description": doc} if doc else {})}


def _describe_default(value: Value) -> Any:
    """The default of a value as a file holds it."""
    if value.items is not None and isinstance(value.default, ItemSet):
        return describe_items(value.items, value.default)
    return describe_scalar(value, value.default)


def _items(items: Items) -> Schema:
    """Named items: each has a kind, which says what fields it has. Kinds and fields of newer versions are kept."""
    kinds = [_item_kind(kind) for kind in items.kinds]
    names = [kind.name for kind in items.kinds]
    kind_schema = {
        "description": f"The kind of {items.noun}.",
        "type": "string",
        "default": names[0],
        "examples": names,
    }
    entry: Schema = {"type": "object", "properties": {KIND: kind_schema}, "allOf": kinds}
    return {**_entries(entry, _NAME), "maxProperties": items.most}


def _item_kind(kind: ItemKind) -> Schema:
    """The fields of a kind of named items, for those that are of it."""
    fields = {name: _value(value) for name, value in kind.fields.items()}
    is_kind: Schema = {"properties": {KIND: {"const": kind.name}}, "required": [KIND]}
    return {"if": is_kind, "then": {"description": kind.doc, "properties": fields}}


def _points(width: int, counts: range) -> Schema:
    """A flat list of so many points of `width` numbers each."""
    return {**_NUMBERS, "anyOf": [{"minItems": width * count, "maxItems": width * count} for count in counts]}


def _entries(entry: Schema, names: Schema) -> Schema:
    """A section: entries by name."""
    return {"type": "object", "propertyNames": names, "additionalProperties": entry}


def _nullable(definition: str) -> Schema:
    return {"anyOf": [{"$ref": f"#/$defs/{definition}"}, {"type": "null"}]}


def _either(record: Schema, **kinds: str) -> Schema:
    """The record with just one of these keys, of these types; an empty name is none."""
    filled = {"name": {"type": "string", "minLength": 1}}
    key_schemas = {name: filled.get(kind, {"type": kind}) for name, kind in kinds.items()}
    return {**record, "oneOf": [{"required": [name], "properties": {name: kind}} for name, kind in key_schemas.items()]}


def _case(type: str, definition: str) -> Schema:
    named: Schema = {"properties": {"type": {"const": type}}, "required": ["type"]}
    return {"if": named, "then": {"$ref": f"#/$defs/{definition}"}}
