"""Values that are what some of their fields say, whatever is in the others."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from operator import attrgetter
from typing import Any, ClassVar

from msgspec import Struct


class Record(Struct, frozen=True, eq=False):
    """A frozen value. Fields that are named in `compare_exclude` take no part in comparisons."""

    compare_exclude: ClassVar[frozenset[str]] = frozenset()

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        fields_of = _make_field_reader(type(self))
        return fields_of(self) == fields_of(other)

    def __hash__(self) -> int:
        return hash(_make_field_reader(type(self))(self))


@cache
def _make_field_reader(kind: type[Record]) -> Callable[[Any], object]:
    """What takes from a record all that it is."""
    return attrgetter(*(name for name in kind.__struct_fields__ if name not in kind.compare_exclude))
