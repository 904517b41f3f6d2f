"""Writes values of nodes as text of Python, in units that a reader knows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from halation.nodes import Node, Value, read_reference, resolve_length_unit

from .formulas import FunctionText, write_formula_text
from .lamps import list_lamps

Plain = float | int | bool | str | tuple[Any, ...] | FunctionText | None

_GRID_POINTS = tuple(f"point_{row}{column}" for row in range(1, 5) for column in range(1, 5))

_LAMPS = (
    "lights",
    "swarm",
    "swarm_place",
    "swarm_spread",
    "swarm_colors",
    "swarm_intensity",
    "swarm_reach",
    "swarm_seed",
)
_SHADOWS = ("shadow_length", "shadow_thickness")

DERIVED: Mapping[str, tuple[tuple[str, ...], Callable[[Any, str], dict[str, Any]]]] = MappingProxyType(
    {
        "grid_warp": (
            _GRID_POINTS,
            lambda node, _: {"points": tuple(getattr(node, name) for name in _GRID_POINTS)},
        ),
        "gradient_map": (("palette", "ramp"), lambda node, _: {"ramp": node.resolve_ramp()}),
        "color_matrix": (("preset", "matrix", "direction"), lambda node, _: {"matrix": node.resolve_matrix()}),
        "convolve3x3": (("preset", "kernel", "normalize", "scale"), lambda node, _: {"kernel": node.weights()}),
        "freeze": (("frame",), lambda node, _: {"held": node.frame}),
        "deferred_lighting": ((*_LAMPS, *_SHADOWS), list_lamps),
    }
)
"""Values that decide parameters of a function together: their names, and what they and the path of the node make."""


def list_settings(node: Node, path: str) -> dict[str, Plain]:
    """What a function is given of a node, by parameter."""
    settings: dict[str, Plain] = dict(node.settings)
    if node.id == "pixel_formula":
        settings["formula"] = write_formula_text(str(settings["formula"]), path)
    if node.id in DERIVED:
        names, derive = DERIVED[node.id]
        settings = {other: setting for other, setting in settings.items() if other not in names}
        settings |= derive(node, path)
    return settings


def find_unit(node: Node, name: str, reference_height: int | None) -> str | None:
    """The unit of a number, such as px@1080; None for one that needs no conversion."""
    value = node.values.get(name)
    if value is None or value.unit is None:
        return None
    unit = dict(node.length_units).get(name) or resolve_length_unit(value.unit, reference_height)
    return unit if unit in ("deg", "height") or read_reference(unit) else None


def write_plain(value: Plain) -> str:
    """A value as text, with the nine digits that a 32-bit float has."""
    if isinstance(value, FunctionText):
        return value.text
    if isinstance(value, tuple):
        parts = [write_plain(part) for part in value]
        return f"({', '.join(parts)}{',' if len(parts) == 1 else ''})"
    if isinstance(value, float):
        short = repr(float(f"{value:.9g}"))
        return short if "inf" not in short and "nan" not in short else f"float({short!r})"
    if isinstance(value, str) and repr(value) == f"'{value}'":
        return f'"{value}"'
    return repr(value)


def count_channels(value: Value) -> int:
    """The channels of a picture that gives a value."""
    return 4 if value.type == "color" else value.length if value.type == "vector" else 1


def write_bound(bound: float) -> str:
    """One end of a range; None where it has none."""
    return "None" if bound in (float("inf"), float("-inf")) else write_plain(bound)


def write_exactly(value: float | tuple[Any, ...]) -> str:
    """Numbers with all their digits: a matrix of a camera is inverted."""
    return f"({', '.join(map(write_exactly, value))})" if isinstance(value, tuple) else repr(float(value))


def write_quantity(text: str, value: Plain, unit: str | None, height: str) -> str:
    """Text of a number, with its conversion from a unit to pixels or radians. `text` may be a lookup in a table."""
    if unit is None:
        return text
    if not value or (isinstance(value, tuple) and not any(value)):
        return text
    if unit == "deg":
        return f"np.radians({text})"
    reference = read_reference(unit)
    factor = height if reference is None else f"{height} / {reference}"
    if isinstance(value, tuple) and text == write_plain(value):
        return f"({', '.join(f'{write_plain(part)} * {factor}' if part else '0.0' for part in value)})"
    return f"np.multiply({text}, {factor})" if isinstance(value, tuple) else f"{text} * {factor}"
