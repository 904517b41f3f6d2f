"""Ways in which a value changes over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from halation.nodes import Value

from .expressions import Expression
from .keys import Keys
from .model import Port
from .values import coerce, value_fault

Animation = Keys | Expression

ANIMATED = frozenset({"float", "int", "bool", "color", "vector", "matrix"})
"""Types of values that can change over time."""


def adapt_animation(value: Value, animation: Animation) -> Animation:
    """The same with keys of the type that the value has: 1 becomes 1.0 where it takes numbers."""
    if isinstance(animation, Expression):
        return animation
    keys = (replace(key, value=plain) for key in animation.keys if (plain := coerce(value, key.value)) is not None)
    made = tuple(keys)
    return replace(animation, keys=made) if len(made) == len(animation.keys) else animation


def move_animation(animation: Mapping[Port, Animation], old: str, new: str = "") -> dict[Port, Animation]:
    """All `animation` after a node or control was renamed, or a node removed if `new` is empty."""
    found: dict[Port, Animation] = {}
    for port, item in animation.items():
        if port.node == old and not new:
            continue
        here = Port(new, port.socket) if port.node == old else port
        found[here] = item.rename(old, new) if new and isinstance(item, Expression) else item
    return found


def unfit(port: Port, value: Value, animation: Animation) -> str | None:
    """Why the value at `port` cannot change in that way, or None. What names in it mean is not looked at."""
    if value.type not in ANIMATED:
        return f"{port}: a {value.type} cannot change over time"
    if isinstance(animation, Expression):
        return f"{port}: {animation.fault}" if animation.fault else None
    if not animation.keys:
        return f"{port}: there are no keys"
    for key in animation.keys:
        if fault := value_fault(value, key.value):
            return f"{port} at frame {key.frame:g}: {fault}"
    return None
