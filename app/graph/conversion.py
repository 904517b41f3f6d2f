"""Which links are valid: lossless conversions are implicit, for others an error names the node that converts."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from halation.nodes import Kind, Scalar, Socket, Value, Vector

_VALUE_TAKES: Mapping[str, frozenset[Kind]] = MappingProxyType(
    {
        "float": frozenset({Kind.NUMBER, Kind.FIELD}),
        "int": frozenset({Kind.NUMBER, Kind.FIELD}),
        "bool": frozenset({Kind.NUMBER, Kind.FIELD}),
        "color": frozenset({Kind.COLOR, Kind.IMAGE, Kind.FIELD, Kind.NUMBER}),
        "vector": frozenset({Kind.VECTOR, Kind.FIELD, Kind.NUMBER}),
    }
)


def make_socket(kind: Kind, width: int = 4, default: Scalar | None = None, *, name: str = "", doc: str = "") -> Socket:
    """Make a socket outside of a class body. `width` counts the channels of a Vector."""
    start = float(default) if isinstance(default, int | float) else None if isinstance(default, str) else default
    if kind is Kind.VECTOR:
        socket: Socket = Vector(start, width=width, doc=doc)
    else:
        socket = next(item for item in Socket.__subclasses__() if item.kind is kind)(start, doc=doc)
    socket.__set_name__(Socket, name)
    return socket


def conversion(source: Socket, target: Socket | Value) -> str | None:
    """None if `source` can feed `target` without loss, else the reason and what to do.

    A Number fits everything, a Color or Field an Image, a Field a Vector; widths of Vectors must agree.
    A value (of a pointwise node) takes what its own type can hold.
    """
    if isinstance(target, Value):
        return _into_value(source, target)
    fits = target.kind is source.kind or target.kind in source.kind.facts.fits
    if fits and not _widths_differ(source, target.kind, target.channels):
        return None
    reason = f"{_word(source)} does not fit {_word(target)}"
    if planned := next((kind for kind in (target.kind, source.kind) if kind.is_planned), None):
        return f"{reason}: a {planned.facts.noun} can only be linked to a {planned} input, and nothing else can"
    if target.single:
        single = "a Number" if target.kind is Kind.NUMBER else "a Number or Color"
        return f"{reason}, one value for the whole picture: link {single}, such as 'luminance_statistics' measures"
    return f"{reason}: put {' and '.join(_way_out(source, target))} between them"


def _into_value(source: Socket, target: Value) -> str | None:
    if not target.wireable:
        return f"a {target.type} cannot be wired, only set"
    takes = _VALUE_TAKES[target.type]
    if source.kind in takes and not _widths_differ(source, Kind.VECTOR, target.length):
        return None
    width = str(target.length) if target.type == "vector" else ""
    kinds = sorted(f"{kind}{width if kind is Kind.VECTOR else ''}" for kind in takes)
    return f"{_word(source)} does not fit a {target.type} value, which takes {' or '.join(kinds)}"


def _widths_differ(source: Socket, kind: Kind, channels: int) -> bool:
    return source.kind is Kind.VECTOR and kind is Kind.VECTOR and source.channels != channels


def _word(socket: Socket) -> str:
    word = f"{socket.kind}{socket.channels}" if socket.kind is Kind.VECTOR else str(socket.kind)
    return f"{'an' if word[0] in 'AEIOU' else 'a'} {word}"


def _way_out(source: Socket, target: Socket) -> tuple[str, ...]:
    """The nodes that convert between two kinds of sockets."""
    split = f"'separate{_suffix(source)}'"
    if target.kind is Kind.FIELD:
        return (split,) if source.kind is Kind.VECTOR else (f"'luminance' or {split}",)
    return split, f"'combine{_suffix(target)}'"


def _suffix(socket: Socket) -> str:
    """The end of the names of the nodes that split and join this kind: "" for colors, `_vector`, `_vector2`, ..."""
    if socket.kind is not Kind.VECTOR:
        return ""
    return "_vector" if socket.channels == 3 else f"_vector{socket.channels}"
