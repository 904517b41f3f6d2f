"""Sockets and values from the inputs that a head declares."""

from __future__ import annotations

import keyword
from collections.abc import Iterable, Mapping

from halation.nodes import Field, Image, Scalar, Socket, Uniform, Value

from .header import IsfInput

LIGHT = "light"
"""The name of the value that every node has: what numbers the shader is given."""

REQUIRED = ("inputImage", "startImage", "endImage")
"""Pictures without which a filter or a transition has nothing to do. All others may stay unlinked."""

_RENAMED_INPUTS = frozenset(
    [
        "category",
        "changed",
        "code",
        "function",
        "id",
        "identity",
        "inputs",
        "light",
        "order",
        "out",
        "output_size",
        "outputs",
        "passes",
        "shader",
        "text",
        "times",
        "title",
        "upgrade",
        "values",
        "version",
        "working",
    ]
)
"""Names of inputs that get a `_` at the end. Only `light` is taken, but graphs that were saved when the others were
taken, too, have them with the `_`: so the list stays as it is."""


def choose_input_names(entries: Iterable[IsfInput]) -> dict[str, str]:
    """What the node calls each input: its name, with a `_` where that is taken."""
    names = [entry.name for entry in entries]
    attribute_names: dict[str, str] = {}
    for name in names:
        node_name = name.lstrip("_") or name
        while (
            node_name in _RENAMED_INPUTS
            or keyword.iskeyword(node_name)
            or node_name in attribute_names.values()
            or (node_name != name and node_name in names)
        ):
            node_name += "_"
        attribute_names[name] = node_name
    return attribute_names


def make_isf_socket(entry: IsfInput) -> Socket:
    """The socket of a picture or of sound."""
    if entry.type != "image":
        content = "its spectrum" if entry.type == "audioFFT" else "its samples"
        doc = f"{entry.label or 'Sound'} as a picture, a row for each channel: {content}. Silent if unlinked."
        return Field(0.0, own_size=True, doc=doc)
    if entry.name in REQUIRED:
        return Image(doc=entry.label)
    return Image(0.0, own_size=True, doc=entry.label)


def make_isf_value(entry: IsfInput, name: str) -> Value:
    """The value of the node for an input that is no picture.

    Colors are display values in the format and light in a node. A position is counted from below there. Of two choices
    with the same number the first counts, so the last entries go into `by_number` first.
    """
    label = entry.label or entry.name.replace("_", " ")
    if entry.choices:
        labels = tuple(label for _, label in entry.choices)
        by_number = dict(reversed(entry.choices))
        default = by_number.get(int(entry.default[0]) if entry.default else entry.choices[0][0], labels[0])
        return Value(name, "choice", default, choices=labels, label=label)
    first = _choose_default(entry)
    if entry.type in ("bool", "event"):
        doc = "True for as long as it is on: key it for single frames." if entry.type == "event" else ""
        return Value(name, "bool", first[0] > 0.5, doc=doc, label=label)
    if entry.type == "color":
        rgba = (*(decode_light(part) for part in first[:3]), first[3])
        return Value(name, "color", rgba, length=4, label=label)
    if entry.type == "point2D":
        if is_position(entry):
            place = (first[0], 1.0 - first[1])
            return Value(name, "vector", place, length=2, low=0.0, high=1.0, handle=True, label=label)
        low, high = min(entry.low or (-1.0,)), max(entry.high or (1.0,))
        return Value(name, "vector", first, length=2, low=low, high=high, label=label)
    low, high = (entry.low or (min(0.0, first[0]),))[0], (entry.high or (max(1.0, first[0]),))[0]
    if entry.type == "long":
        return Value(name, "int", int(first[0]), low=low, high=max(high, low + 1), unit="count", label=label)
    return Value(name, "float", first[0], low=low, high=high, unit="ratio", label=label)


def make_uniform(entry: IsfInput, plain: Scalar, display: bool) -> Uniform:
    """What the shader is given for a value of the node."""
    if entry.choices:
        return next(number for number, label in entry.choices if label == plain)
    if isinstance(plain, str):
        return 0
    if isinstance(plain, tuple):
        if entry.type == "color":
            return (*(encode_light(part) if display else part for part in plain[:3]), plain[3])
        return (plain[0], 1.0 - plain[1]) if is_position(entry) else plain
    return bool(plain) if entry.type in ("bool", "event") else plain


def uniform_as_number(uniform: Uniform) -> float:
    """The number that a formula for the size of a pass reads; 0 for what is not a number."""
    return 0.0 if isinstance(uniform, tuple) else float(uniform)


def is_position(entry: IsfInput) -> bool:
    """True for a point that lies in the picture, as fractions of it: rows run from the bottom."""
    return (
        entry.type == "point2D"
        and len(entry.low) == 2
        and len(entry.high) == 2
        and min(entry.low) >= 0.0
        and max(entry.high) <= 1.0
    )


def write_isf_doc(doc: str, names: Mapping[str, str]) -> str:
    """The tooltip of the node: the description of the shader, and which inputs had to be renamed."""
    renamed = [f"{name} is called {node_name}" for name, node_name in names.items() if name != node_name]
    return "\n".join([doc, *(f"{', '.join(renamed)}." for _ in renamed[:1])])


def _choose_default(entry: IsfInput) -> tuple[float, ...]:
    """The default of the header; without one the middle of the range for points, black for colors, else the minimum."""
    if entry.default:
        return entry.default
    if entry.type == "point2D":
        return tuple(0.5 * (a + b) for a, b in zip(entry.low, entry.high, strict=True)) or (0.0, 0.0)
    if entry.type == "color":
        return (0.0, 0.0, 0.0, 1.0)
    low, high = (entry.low or (0.0,))[0], (entry.high or (float("inf"),))[0]
    return (min(max(0.0, low), high),)


def decode_light(code: float) -> float:
    """A display value of sRGB as light (IEC 61966-2-1)."""
    size = abs(code)
    light = size / 12.92 if size <= 0.04045 else ((size + 0.055) / 1.055) ** 2.4
    return light if code >= 0.0 else -light


def encode_light(light: float) -> float:
    """The inverse of `decode_light`."""
    size = abs(light)
    code = 12.92 * size if size <= 0.0031308 else 1.055 * size ** (1.0 / 2.4) - 0.055
    return code if light >= 0.0 else -code
