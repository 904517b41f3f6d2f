"""The objects of a document: the fields that each may have, and sentences about wrong ones."""

import re
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Annotated, Any, TypeVar

import msgspec
from halation.nodes import MAX_REFERENCE_HEIGHT, Kind, Missing

from ..errors import DocumentError
from ..graph import Extrapolation, Interpolation
from ..resources.picture import MAX_OVERSCAN
from ..resources.typed_data import convert_data
from .syntax import member

Count = Annotated[int, msgspec.Meta(ge=1)]
Section = dict[str, Any]

RecordType = type[msgspec.Struct]
R = TypeVar("R", bound=msgspec.Struct)

_WORDS = {
    "str": "a string",
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "object": "an object",
    "array": "a list",
    "null": "null",
}


class FormatRecord(msgspec.Struct):
    """The head of every document, whatever its format."""

    halation: Count


class GraphRecord(msgspec.Struct):
    """A document, or the graph of an inline group."""

    halation: Any = None
    settings: Section = {}
    inputs: Section = {}
    outputs: Section = {}
    controls: Section = {}
    nodes: Section = {}
    links: Section = {}
    animation: Section = {}
    ui: Section = {}


class ColorRecord(msgspec.Struct):
    """The section `color` of `settings`."""

    config: str = ""
    working: str = ""


class SettingsRecord(msgspec.Struct):
    """The section `settings`."""

    size: tuple[Count, Count] | None = None
    frames: tuple[int, int] | None = None
    rate: Annotated[float, msgspec.Meta(gt=0)] = 24.0
    preroll: Annotated[int, msgspec.Meta(ge=0)] | None = None
    reference_height: Annotated[int, msgspec.Meta(ge=1, le=MAX_REFERENCE_HEIGHT)] | None = None
    overscan: Annotated[float, msgspec.Meta(ge=0, le=MAX_OVERSCAN)] = 0.0
    color: Section = {}
    allow: dict[str, str] = {}


class InputRecord(msgspec.Struct):
    """An entry of `inputs`."""

    type: str = "Image"
    file: str = ""
    layer: str = ""
    missing: Missing = "error"
    color_space: str = ""
    default: float | tuple[float, ...] | None = None
    doc: str = ""


class OutputRecord(msgspec.Struct):
    """An entry of `outputs`."""

    type: str = "Image"
    layer: str = ""
    view: str = ""
    overscan: bool = False


class ControlRecord(msgspec.Struct):
    """An entry of `controls`."""

    target: str
    label: str = ""
    doc: str = ""


class AnimationRecord(msgspec.Struct):
    """An entry of `animation`."""

    keys: list[Any] | None = None
    outside: Extrapolation = "hold"
    expression: str | None = None


class KeyRecord(msgspec.Struct):
    """One of the keys of a value."""

    frame: float
    value: Any
    interpolation: Interpolation = "smooth"
    left: tuple[float, ...] = ()
    right: tuple[float, ...] = ()


class TypeRecord(msgspec.Struct):
    """The fields of every node."""

    type: str
    muted: bool = False


class NodeRecord(TypeRecord):
    """A node of a known type."""

    version: Count = 1
    package: str = ""
    values: Section = {}
    units: dict[str, str] = {}


class CodeRecord(TypeRecord):
    """A node whose code is in `code`, line by line, or in a file."""

    code: list[str] | None = None
    file: str | None = None
    values: Section = {}
    units: dict[str, str] = {}


class GroupRecord(TypeRecord):
    """A node of type `group`."""

    graph: Section | None = None
    path: str | None = None
    values: Section = {}


def convert(raw: Any, kind: type[R], file: str, path: str) -> R:
    """`raw` as a record. Raises DocumentError with the JSON path."""
    try:
        return convert_data(raw, kind)
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at `$")
        fault = re.sub("`([^`]*)`", lambda match: _plain(match[1]), message[:1].lower() + message[1:])
        raise DocumentError(file, (path + where.rstrip("`")).removeprefix("."), fault) from None


def unknown_keys(raw: Mapping[str, Any], kind: RecordType) -> dict[str, Any]:
    """The entries of `raw` besides the fields of a record."""
    fields = _list_fields(kind)
    return {} if raw.keys() <= fields else {key: part for key, part in raw.items() if key not in fields}


@cache
def _list_fields(kind: RecordType) -> frozenset[str]:
    return frozenset(kind.__struct_fields__)


def type_name(kind: Kind, width: int) -> str:
    """The name of a type in a file: `Image`, `Vector` (of three) or `Vector2`."""
    return f"{kind}{width}" if kind is Kind.VECTOR and width != 3 else str(kind)


@cache
def type_names() -> Mapping[str, tuple[Kind, int]]:
    """Kind and channels by every type name of files."""
    kinds_by_name = {type_name(kind, width): (kind, width) for kind in Kind for width in (2, 3, 4)}
    return MappingProxyType({**kinds_by_name, "Vector3": (Kind.VECTOR, 3)})


def read_type(name: str, file: str, path: str) -> tuple[Kind, int]:
    """Kind and channels of a type name."""
    kinds_by_name = type_names()
    if name not in kinds_by_name:
        raise DocumentError(
            file, member(path, "type"), f"'{name}' is no type: write {', '.join(sorted(kinds_by_name))}"
        )
    return kinds_by_name[name]


def _plain(words: str) -> str:
    parts = words.split(" | ")
    return " or ".join(_WORDS[part] for part in parts) if all(part in _WORDS for part in parts) else f"'{words}'"
