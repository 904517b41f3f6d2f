"""Commands for values of nodes, and for controls: values that the graph shows under names of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from halation.nodes import Plain
from msgspec import structs

from ...errors import GraphError
from ...graph import Control, Port, signature
from ...graph.names import fresh_name
from ...graph.unit_conversion import convert_length_unit
from ...language.translation import translate
from ..edits.elements import clean_text
from ..edits.values import find_control, fit_color, reset_value
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited
from .keys import add_key


class SetValue(EditCommand[None], frozen=True):
    """Set a value, or, where it has keys, a key at the current frame."""

    port: Port
    value: object
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        fitted = fit_color(document.graph, self.port, self.value)
        if keys := add_key(document, self.port, fitted):
            graph = document.graph.animate(self.port, keys)
            return Edited(translate("Key {port}", port=self.port), None, graph, merge=self.merge)
        plain = clean_text(fitted) if isinstance(fitted, str) else fitted
        return Edited(
            translate("Set {port}", port=self.port), None, document.graph.set(self.port, plain), merge=self.merge
        )


class SetValues(EditCommand[None], frozen=True):
    """Set several values as one step."""

    values: Mapping[Port, object]
    label: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        for port, value in self.values.items():
            fitted = fit_color(document.graph, port, value)
            keys = add_key(document, port, fitted)
            graph = graph.animate(port, keys) if keys else graph.set(port, fitted)
        return Edited(self.label, None, graph, merge=self.merge)


class OverrideValues(EditCommand[None], frozen=True):
    """Set values of the whole document by their paths, inside of groups too, as one step."""

    settings: Mapping[str, Plain]
    label: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        root = document.root
        for path, value in self.settings.items():
            root = root.override(path, tuple(value) if isinstance(value, list) else value)
        return Edited(self.label, None, root=root, merge=self.merge)


class ConvertLength(EditCommand[None], frozen=True):
    """Give a length in another unit, so that a picture of a height stays as it is."""

    ports: tuple[Port, ...]
    unit: str
    height: int

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        for port in self.ports:
            graph = convert_length_unit(graph, port, self.unit, self.height)
        return Edited(translate("Set unit to {unit}", unit=self.unit), None, graph)


class ResetValue(EditCommand[None], frozen=True):
    """Set a value back to its default, for all frames."""

    port: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(translate("Reset {port}", port=self.port), None, reset_value(document.graph, self.port))


class ResetNode(EditCommand[None], frozen=True):
    """Set all values of a node back to their defaults."""

    id: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        for name in signature(graph.node(self.id)).values:
            graph = reset_value(graph, Port(self.id, name))
        return Edited(translate("Reset {id}", id=self.id), None, graph)


class ExposeValue(EditCommand[str], frozen=True):
    """Show a value as a control of the graph; gives its name, by default that of the value."""

    port: Port
    name: str = ""

    def apply(self, document: OpenDocument) -> Edited[str]:
        if control := find_control(document.graph, self.port):
            raise GraphError(translate("'{port}' is the control '{control}' already", port=self.port, control=control))
        graph = document.graph
        name = self.name or fresh_name(self.port.socket, {*graph.controls, *graph.inputs})
        values = signature(graph.node(self.port.node)).values
        label = values[self.port.socket].label if self.port.socket in values else ""
        return Edited(
            translate("Expose {port}", port=self.port), name, graph.add_control(name, Control(self.port, label))
        )


class HideControl(EditCommand[None], frozen=True):
    """Remove a control; the value stays as it is."""

    name: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        return Edited(translate("Hide {name}", name=self.name), None, document.graph.remove_control(self.name))


class RenameControl(EditCommand[None], frozen=True):
    """Give a control another name."""

    old: str
    new: str

    def apply(self, document: OpenDocument) -> Edited[None]:
        moves = {Port("controls", self.old): Port("controls", self.new)}
        graph = document.graph.rename_control(self.old, self.new)
        return Edited(translate("Rename {old} to {new}", old=self.old, new=self.new), None, graph, moves=moves)


class DescribeControl(EditCommand[None], frozen=True):
    """Set the label or the tooltip of a control; None leaves it."""

    name: str
    label: str | None = None
    doc: str | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        if self.name not in graph.controls:
            raise GraphError(translate("the graph has no control '{name}'", name=self.name))
        texts = (("label", self.label), ("doc", self.doc))
        new_texts = {key: clean_text(text) for key, text in texts if text is not None}
        changed = structs.replace(graph.controls[self.name], **new_texts)
        graph = replace(graph, controls={**graph.controls, self.name: changed})
        return Edited(translate("Describe {name}", name=self.name), None, graph, merge=self.merge)
