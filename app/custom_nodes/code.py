"""Code that a user wrote for a node of a graph."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import FrozenInstanceError
from types import MappingProxyType, new_class
from typing import Any, ClassVar, Literal, cast

from halation.nodes import Node, OutputSocket, Plain, Socket, Value
from msgspec import Struct

from ..glsl import GlslText

Language = Literal["glsl", "isf"]
"""GLSL as the house writes it, and the Interactive Shader Format. Both are types of nodes in documents."""


class Code(Struct, frozen=True):
    """`text` stands in the graph, or in a `file` beside it (as the graph spells it).

    `vertex` is the vertex shader that lies beside a file in the Interactive Shader Format, if there is one.
    """

    language: Language
    text: str
    file: str = ""
    vertex: str = ""

    @property
    def name(self) -> str:
        """What messages call it."""
        return self.file or "its code"


class CodeFault(Exception):
    """Code that says no node: why, and in which line; 0 if in none of its lines."""

    def __init__(self, line: int, sentence: str) -> None:
        self.line, self.sentence = line, sentence
        super().__init__(f"line {line}: {sentence}" if line else sentence)


class CustomNode(Node, abstract=True):
    """A node that is made of code of a user: the class `make_class` returns for some code.

    Its settings are in a namespace of their own, not among the attributes, so that a parameter of the code can have any
    name, also that of an attribute of this class. `setting` gives them by name.
    """

    code: ClassVar[Code]
    text: ClassVar[GlslText | None] = None
    """Its functions for the compiler's library, if they go there."""
    _settings: Mapping[str, Plain]

    def __init_subclass__(cls) -> None:
        """Nothing: `make_class` declares sockets and values."""

    def __init__(self, /, **settings: Plain) -> None:
        if unknown := settings.keys() - self.values.keys():
            raise TypeError(f"{self.title} has no value {', '.join(sorted(unknown))}")
        defaults = {name: value.default for name, value in self.values.items()}
        object.__setattr__(self, "_settings", MappingProxyType(defaults | settings))

    @property
    def settings(self) -> Mapping[str, Any]:
        """What all values are set to, by name."""
        return self._settings

    def setting(self, name: str) -> Any:
        """What the value of this name is set to."""
        return self._settings[name]

    def __getattr__(self, name: str) -> Any:
        """A setting, where the class has no attribute of that name."""
        settings = self.__dict__.get("_settings", {})
        if name not in settings:
            raise AttributeError(f"'{type(self).__name__}' object has no attribute '{name}'")
        return settings[name]

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return False
        node = cast("CustomNode", other)
        return self._settings == node._settings and self.length_units == node.length_units

    def __hash__(self) -> int:
        return hash((type(self), tuple(self._settings.items()), self.length_units))

    def __repr__(self) -> str:
        settings = ", ".join(f"{name}={setting!r}" for name, setting in self._settings.items())
        return f"{type(self).__name__}({settings})"


def make_class(
    code: Code,
    name: str,
    base: type[Node],
    sockets: Mapping[str, Socket],
    values: Mapping[str, Value],
    outputs: Mapping[str, OutputSocket],
    order: Iterable[str],
    methods: Mapping[str, Any],
) -> type[CustomNode]:
    """The class of a node with these sockets and values, which has `methods` and the docstring among them."""
    body = {"__module__": __name__, **methods}
    node_class = cast("type[CustomNode]", new_class(name, (CustomNode, base), {}, lambda space: space.update(body)))
    for socket_name, socket in (*sockets.items(), *outputs.items()):
        socket.__set_name__(node_class, socket_name)
    node_class.inputs, node_class.outputs = dict(sockets), dict(outputs)
    node_class.values, node_class.order = dict(values), tuple(order)
    node_class.id, node_class.category, node_class.code = code.language, "code", code
    return node_class


def strip_prefix(message: str) -> str:
    """A driver's message with names as the user wrote them."""
    return re.sub(r"\bw[0-9a-f]{8}x?_(?=\w)", "", message)
