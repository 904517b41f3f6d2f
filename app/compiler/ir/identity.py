"""What identifies an operation: every field that can change a pixel, found from the declaration of its class.

A fingerprint that misses a field leaves stale pixels on the screen, so no code lists fields by hand. All fields of an
operation, and of the values in it, count, except:

- `owner` and other fields in `compare_exclude`: operations that differ in them are equal.
- Fields in `identity_exclude`, a class attribute that maps a field to the reason why no pixel depends on it.
- Refs: which pictures an operation reads is said by the places of these pictures in their pass, and by their keys.

`tests/compiler/test_identity.py` changes each field of each operation and expects another key.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from hashlib import blake2b
from inspect import get_annotations
from typing import Any

from msgspec import Struct, structs
from msgspec.msgpack import Encoder

from ...resources.record import Record
from .values import Ref, UniformConstant

_PLAIN = frozenset({str, int, bool, type(None)})
_PLAIN_WORDS = frozenset({"int", "str", "bool", "None", "Size", "Edge", "..."})
_ENCODER = Encoder()
_ADD_ZERO = (0.0).__add__
"""Leaves one zero of two: operations that are equal must have one key, and 0.0 == -0.0."""


def describe(item: object) -> object:
    """Everything about an operation, or a value in one, that can change a pixel: lists and tuples of plain values.

    Values that are equal have one description: 1 and 1.0 as constants, 0.0 and -0.0 anywhere.
    """
    return _DESCRIBERS[type(item)](item)


class _Describers(dict[type[Any], Callable[[Any], object]]):
    """What describes the values of each class, found when first asked for. A look-up costs no call of a function."""

    def __missing__(self, kind: type[Any]) -> Callable[[Any], object]:
        self[kind] = _find_describer(kind)
        return self[kind]


_DESCRIBERS = _Describers()


def _find_describer(kind: type[Any]) -> Callable[[Any], object]:
    if kind is float:
        return _ADD_ZERO
    if kind is tuple:
        return _describe_tuple
    if kind is Ref:
        return lambda _: "ref"
    if kind is UniformConstant:
        return _describe_constant
    if kind not in _PLAIN and issubclass(kind, Struct):
        return _make_describer(kind)
    return (lambda item: item) if kind in _PLAIN else repr


def _describe_tuple(parts: tuple[object, ...]) -> object:
    return [_DESCRIBERS[type(part)](part) for part in parts]


def _make_describer(kind: type[Struct]) -> Callable[[Any], object]:
    """What describes values of a class, each field by its declared type.

    A large graph has thousands of parameters to describe each time it is planned. So all fields are taken at once, and
    only those are looked at that hold floats or other values: text and whole numbers stay as they are. Most floats have
    their default: None says it, and less is to be hashed; where all the last ones have it, they are left out. The types
    are read as they are spelled: to evaluate them takes 5 % of a short render. What is not recognized is described by
    its value, which gives the same.
    """
    class_name, names, identity, spelled = (
        kind.__name__,
        kind.__struct_fields__,
        identity_fields(kind),
        _spell_types(kind),
    )
    defaults = dict(zip(reversed(names), reversed(kind.__struct_defaults__), strict=False))
    excluded = [place for place, name in enumerate(names, 1) if name not in identity]
    floats: list[tuple[int, object]] = []
    float_tuples: list[int] = []
    rest: list[int] = []
    for place, name in enumerate(names, 1):
        words = set(spelled[name].replace("tuple[", "").replace("]", "").split(", "))
        if spelled[name] == "float":
            floats.append((place, defaults.get(name)))
        elif name in identity and not words <= _PLAIN_WORDS:
            (float_tuples if spelled[name] == "tuple[float, ...]" else rest).append(place)
    last = len(names)
    while last and spelled[names[last - 1]] == "float" and names[last - 1] in defaults.keys() & set(identity):
        last -= 1
    last_defaults = tuple(defaults[name] for name in names[last:])
    first_floats = [(place, default) for place, default in floats if place <= last]

    def describe_fields(item: Struct) -> object:
        fields = structs.astuple(item)
        usual = fields[last:] == last_defaults
        parts: list[Any] = [class_name, *(fields[:last] if usual else fields)]
        for place in excluded:
            parts[place] = None
        for place, default in first_floats if usual else floats:
            number = parts[place]
            parts[place] = None if number == default else number + 0.0
        for place in float_tuples:
            parts[place] = _describe_floats(parts[place])
        for place in rest:
            value = parts[place]
            parts[place] = _DESCRIBERS[type(value)](value)
        return parts

    return describe_fields


def _describe_constant(constant: UniformConstant) -> object:
    return _describe_floats(constant.value) if isinstance(constant.value, tuple) else float(constant.value)


def _describe_floats(numbers: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(map(_ADD_ZERO, numbers))


def _spell_types(kind: type[Any]) -> dict[str, str]:
    """The types of the fields of a class, as the code spells them."""
    spelled: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        spelled |= {name: str(getattr(hint, "__name__", hint)) for name, hint in get_annotations(base).items()}
    return spelled


@cache
def identity_fields(kind: type[Struct]) -> tuple[str, ...]:
    """The fields of a class that can change a pixel."""
    excluded: Mapping[str, str] = getattr(kind, "identity_exclude", {})
    uncompared = kind.compare_exclude if issubclass(kind, Record) else frozenset[str]()
    return tuple(name for name in kind.__struct_fields__ if name not in excluded and name not in uncompared)


def hash_description(description: object) -> str:
    """A hash of what `describe` returns, alone or in lists. MessagePack writes it ten times as fast as `repr`."""
    try:
        content = _ENCODER.encode(description)
    except (OverflowError, UnicodeEncodeError):  # a whole number of 65 bits, or a file name that is not UTF-8
        content = repr(description).encode()
    return _hash(content)


def hash_parts(*parts: object) -> str:
    """A hash of the texts of some values."""
    return _hash("\0".join(str(part) for part in parts).encode())


def _hash(content: bytes) -> str:
    return blake2b(content, digest_size=16).hexdigest()
