"""How a value changes over time: by keys or by an expression."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import ROWS, Value
from msgspec.structs import replace

from .expressions import Expression
from .keys import Keys
from .model import Port
from .values import coerce, value_fault

Animation = Keys | Expression

ANIMATED = frozenset({"float", "int", "bool", "color", "vector", "matrix", "spline", "stroke", "point"})
"""Types of values that can be animated."""


def adapt_animation(value: Value, animation: Animation) -> Animation:
    """The animation with keys converted to the type of the value: 1 becomes 1.0 for a float."""
    if isinstance(animation, Expression):
        return animation
    keys = (replace(key, value=plain) for key in animation.keys if (plain := coerce(value, key.value)) is not None)
    adapted_keys = tuple(keys)
    return replace(animation, keys=adapted_keys) if len(adapted_keys) == len(animation.keys) else animation


def move_animation(animation: Mapping[Port, Animation], old: str, new: str = "") -> dict[Port, Animation]:
    """All animation after a node or control is renamed, or removed if `new` is empty."""
    moved_animation: dict[Port, Animation] = {}
    for port, item in animation.items():
        if port.node == old and not new:
            continue
        moved_port = Port(new, port.socket) if port.node == old else port
        moved_animation[moved_port] = item.rename(old, new) if new and isinstance(item, Expression) else item
    return moved_animation


def animation_type_fault(port: Port, value: Value, animation: Animation) -> str | None:
    """Why the value at `port` cannot be animated in this way, or None. Names in expressions are not checked."""
    if value.type not in ANIMATED:
        return f"{port}: a {value.type} cannot change over time"
    if isinstance(animation, Expression) and value.type in (*ROWS, "point"):
        return f"{port}: a {value.type} cannot follow an expression; set keys"
    if isinstance(animation, Expression):
        return f"{port}: {animation.fault}" if animation.fault else None
    if not animation.keys:
        return f"{port}: there are no keys"
    for key in animation.keys:
        if fault := value_fault(value, key.value):
            return f"{port} at frame {key.frame:g}: {fault}"
    return None
