"""docs/api.md, written from the docstrings of the public names."""

from __future__ import annotations

import inspect
import json
import textwrap
from collections.abc import Callable, Iterator
from enum import Enum
from types import UnionType
from typing import Any, Literal, get_args, get_origin

import halation as hal
from halation import errors
from halation.graph import Control, Expression, Group, Input, Key, Keys, Output, Port, Settings

PARTS = (Port, Input, Output, Control, Settings, Group, Keys, Key, Expression)
"""What methods of Graph take, beside nodes."""

INTRODUCTION = """\
# Python

Generated from the docstrings by `./dev renew`. What is promised to stay is in [compatibility.md](compatibility.md).
"""
TYPES = """\
## Types in signatures

- `Binding` is what an input of a graph is bound to: a path (`"shot.exr"`, `"shot.exr:Depth"`, `"shot.####.exr"`), a
  numpy array [height, width] or [height, width, channels], a number, or a tuple of numbers for a color or a camera.
- `Precision` is `"half"` or `"float"`: 16 or 32 bits per channel.
- `Item` is what stands in a graph under an id: a node, a `Group`, or `Unknown` for a type that is not installed.
- `Plain` is a value as JSON knows it: a number, a truth value, a text or a tuple of numbers.
- `Animation` is `Keys` or an `Expression`.
"""
GRAPH = """\
A node is an instance of its class, and its values are the arguments of the class:
`halation.nodes.catalogue()["exposure"](stops=1.0)`, or `from halation.nodes.color.exposure import Exposure`.
[nodes.md](nodes.md) lists all. These classes are in `halation.graph`:
"""


def write_reference() -> str:
    """The whole page: functions, errors, the graph and what it is made of."""
    functions = [name for name in hal.__all__ if inspect.isfunction(getattr(hal, name))]
    blocks = [INTRODUCTION.rstrip(), describe(hal), "## Functions"]
    for name in functions:
        blocks += describe_callable(f"hal.{name}", getattr(hal, name))
    blocks += [TYPES.rstrip(), "## Errors", *describe_errors(), *describe_callable("hal.Graph", hal.Graph)]
    for name, method in public_methods(hal.Graph):
        blocks += describe_callable(f"graph.{name}", method)
    blocks += ["## What graphs are made of", GRAPH.rstrip()]
    for part in PARTS:
        blocks += describe_callable(part.__name__, part)
    return "\n\n".join(blocks) + "\n"


def describe(subject: Any) -> str:
    """A docstring as Markdown: what is indented is code."""
    paragraphs = (inspect.getdoc(subject) or "").split("\n\n")
    return "\n\n".join(_describe_paragraph(text) for text in _join_code(paragraphs))


def describe_callable(name: str, subject: Callable[..., Any]) -> Iterator[str]:
    """A heading, the signature, and the docstring."""
    yield f"### {name}"
    yield f"```python\n{write_signature(name, subject)}\n```"
    yield describe(subject)


def describe_errors() -> Iterator[str]:
    """The tree of exceptions as their module draws it, then each class."""
    yield describe(errors)
    for name, error in vars(errors).items():
        if inspect.isclass(error) and issubclass(error, hal.HalationError):
            yield f"**{name}** (exit code {error.exit_code}): {describe(error)}"


def public_methods(kind: type) -> Iterator[tuple[str, Callable[..., Any]]]:
    """The public methods of a class and its bases in the order in which they are declared."""
    names = dict.fromkeys(name for base in kind.__mro__ for name in vars(base) if not name.startswith("_"))
    for name in names:
        if inspect.isfunction(method := getattr(kind, name)):
            yield name, method


def write_signature(name: str, subject: Callable[..., Any]) -> str:
    """`name(argument: type = default, ...) -> type`, on several lines where one is too long."""
    signature = inspect.signature(subject)
    parameters = [item for item in signature.parameters.values() if item.name != "self"]
    words = [_write_parameter(item) for item in parameters]
    keyword = [index for index, item in enumerate(parameters) if item.kind is inspect.Parameter.KEYWORD_ONLY]
    if keyword and not any(item.kind is inspect.Parameter.VAR_POSITIONAL for item in parameters):
        words.insert(keyword[0], "*")
    result = "" if inspect.isclass(subject) else f" -> {_write_type(signature.return_annotation)}"
    line = f"{name}({', '.join(words)}){result}"
    if len(line) <= 100:
        return line
    lines = "".join(f"    {word},\n" for word in words)
    return f"{name}(\n{lines}){result}"


def _write_parameter(item: inspect.Parameter) -> str:
    if item.default is item.empty:
        stars = {item.VAR_POSITIONAL: "*", item.VAR_KEYWORD: "**"}.get(item.kind, "")
        return f"{stars}{item.name}: {_write_type(item.annotation)}"
    return f"{item.name}: {_write_type(item.annotation)} = {_write_default(item.default)}"


def _write_default(default: object) -> str:
    if isinstance(default, Enum):
        return str(default)
    made_anew = repr(default).startswith("<")  # dataclasses and structs show a default that is a function so
    return "..." if made_anew else json.dumps(default) if isinstance(default, str) else repr(default)


def _write_type(annotation: Any) -> str:
    if get_origin(annotation) is Literal:
        return f"Literal[{', '.join(map(repr, get_args(annotation)))}]"
    if isinstance(origin := get_origin(annotation), type) and get_args(annotation) and origin is not UnionType:
        parts = ("..." if part is ... else _write_type(part) for part in get_args(annotation))
        return f"{origin.__name__}[{', '.join(parts)}]"
    text = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", str(annotation))
    return text.replace("Self", "Graph")


def _join_code(paragraphs: list[str]) -> Iterator[str]:
    """Paragraphs, those of one piece of indented code joined."""
    code: list[str] = []
    for paragraph in paragraphs:
        if paragraph.startswith("    "):
            code.append(paragraph)
            continue
        if code:
            yield "\n\n".join(code)
            code = []
        yield paragraph
    if code:
        yield "\n\n".join(code)


def _describe_paragraph(text: str) -> str:
    if not text.startswith("    "):
        return text
    code = textwrap.dedent(text)
    language = "text" if "└" in code else "python"
    return f"```{language}\n{code}\n```"
