"""Commands for named items, such as lights: add, duplicate, remove, rename, exchange. Fields are set like values."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import NamedItem
from msgspec import field

from ...errors import GraphError
from ...graph import Port
from ...graph.scalars import coerce_scalar
from ...language.translation import translate
from ..edits.elements import clean_text
from ..edits.named_items import (
    copy_animation,
    drop_item,
    exchange_items,
    find_item,
    find_items,
    fresh_item_name,
    insert_item,
    rename_item,
)
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class AddItem(EditCommand[str], frozen=True):
    """Add a named item of a kind to a value; gives its name, by default the kind and a number."""

    port: Port
    kind: str
    fields: Mapping[str, object] = field(default_factory=dict[str, object])
    name: str = ""
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[str]:
        declared, items = find_items(document.graph, self.port)
        if self.kind not in declared.by_name:
            raise GraphError(
                translate(
                    "'{kind}' is no kind of {noun}: it takes {kinds}",
                    kind=self.kind,
                    noun=declared.noun,
                    kinds=", ".join(declared.by_name),
                )
            )
        name = clean_text(self.name) or fresh_item_name(self.kind, items)
        graph = insert_item(document.graph, self.port, name, NamedItem(self.kind))
        graph = graph.put_all(
            {
                Port(self.port.node, f"{self.port.socket}.{name}.{part}"): plain
                for part, declaration in declared.by_name[self.kind].fields.items()
                if part in self.fields and (plain := coerce_scalar(declaration, self.fields[part])) is not None
            }
        )
        return Edited(translate("Add {noun} {name}", noun=declared.noun, name=name), name, graph, merge=self.merge)


class DuplicateItem(EditCommand[str], frozen=True):
    """Add a copy of a named item, with its keys; gives its name."""

    port: Port
    name: str

    def apply(self, document: OpenDocument) -> Edited[str]:
        declared, items = find_items(document.graph, self.port)
        copied, copy = find_item(document.graph, self.port, self.name), fresh_item_name(self.name, items)
        graph = insert_item(document.graph, self.port, copy, copied)
        graph = copy_animation(graph, self.port, self.name, copy)
        return Edited(translate("Duplicate {noun} {name}", noun=declared.noun, name=self.name), copy, graph)


class RemoveItem(EditCommand[None], frozen=True):
    """Remove a named item, its keys and the controls of its fields."""

    port: Port
    name: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        declared, _ = find_items(document.graph, self.port)
        graph = drop_item(document.graph, self.port, self.name)
        return Edited(translate("Remove {noun} {name}", noun=declared.noun, name=self.name), None, graph)


class RenameItem(EditCommand[None], frozen=True):
    """Give a named item another name; keys, expressions and controls follow."""

    port: Port
    old: str
    new: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = rename_item(document.graph, self.port, self.old, clean_text(self.new).strip())
        return Edited(translate("Rename {old} to {new}", old=self.old, new=self.new), None, graph)


class ExchangeItems(EditCommand[None], frozen=True):
    """Give two named items each other's name, and so each other's place in the order; keys and controls follow."""

    port: Port
    first: str
    second: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = exchange_items(document.graph, self.port, self.first, self.second)
        return Edited(translate("Exchange {first} and {second}", first=self.first, second=self.second), None, graph)
