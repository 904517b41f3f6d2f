"""Named items as a value: lights, shapes or strokes by name, each with typed fields.

A value of this type is an `ItemSet`: an immutable mapping from a name to a `NamedItem`, which has a kind and the fields
that differ from the defaults of that kind. `ItemKind` declares a kind and its fields, `Items` the kinds that a value
can hold. So each field of each item has a path of its own, `node.value.item.field`, which links, keys, expressions and
`--set` use as they use `node.value`, and files have a key for it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any

from msgspec import Struct

Scalar = float | int | bool | str | tuple[float, ...]
"""The types of a field: JSON scalars and flat lists of numbers."""

_DIGITS = re.compile(r"([0-9]+)")


class NamedItem(Struct, frozen=True, dict=True):
    """An item without its name: its kind, and its fields that differ from the defaults of the kind, sorted by name."""

    kind: str
    settings: tuple[tuple[str, Scalar], ...] = ()

    @staticmethod
    def of(kind: str, fields: Mapping[str, Scalar]) -> NamedItem:
        """The item of a kind with these fields."""
        return NamedItem(kind, tuple(sorted(fields.items())))

    @cached_property
    def fields(self) -> Mapping[str, Scalar]:
        """The fields that are set, by name."""
        return MappingProxyType(dict(self.settings))

    def with_field(self, name: str, setting: Scalar | None) -> NamedItem:
        """The item with one field set; None removes it, so that it has its default."""
        fields = {key: part for key, part in self.settings if key != name}
        return NamedItem.of(self.kind, fields if setting is None else {**fields, name: setting})

    def __reduce__(self) -> tuple[Any, ...]:
        return NamedItem, (self.kind, self.settings)


class ItemSet(Mapping[str, NamedItem]):
    """Items by name, in natural order: `lamp_2` comes before `lamp_10`. It never changes: edits return a new one."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[str, NamedItem] = MappingProxyType({})) -> None:
        self._items = {name: items[name] for name in sorted(items, key=natural_order)}

    def __getitem__(self, name: str) -> NamedItem:
        return self._items[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        return hash(tuple(self._items.items()))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ItemSet) and self._items == other._items

    def __repr__(self) -> str:
        return f"ItemSet({self._items!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return ItemSet, (self._items,)

    def replace(self, items: Mapping[str, NamedItem]) -> ItemSet:
        """The items with others in place of some of these names, in the same order."""
        replaced = ItemSet()
        replaced._items = {**self._items, **items}
        return replaced

    def with_item(self, name: str, item: NamedItem) -> ItemSet:
        """The items with one more, or another one of this name."""
        return ItemSet({**self._items, name: item})

    def without_item(self, name: str) -> ItemSet:
        """The items without one."""
        return ItemSet({key: item for key, item in self._items.items() if key != name})


def natural_order(name: str) -> tuple[tuple[tuple[bool, int, str], ...], str]:
    """What names are sorted by, so that numbers in them count as numbers."""
    parts = (part for part in _DIGITS.split(name) if part)
    words = ((False, int(part), "") if part[0] in "0123456789" else (True, 0, part) for part in parts)
    return tuple(words), name
