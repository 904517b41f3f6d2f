"""Refuses declarations that would mean something else than their author thinks, in sentences for that author."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping
from difflib import get_close_matches
from typing import Any, cast, get_args

_NUMBERS: Mapping[type, tuple[type, ...]] = {float: (float, int), int: (int,), bool: (bool,), str: (str,)}
"""What a default may be, by the type of its value: a whole number stands for a number of fractions."""


def check_names(names: Collection[str], reserved_names: Collection[str]) -> None:
    """Raise TypeError for an input, output or value that hides what every node has."""
    for name in names:
        if name in reserved_names:
            raise TypeError(f"'{name}' is a name that every node uses for something else: choose another one")


def check_aliases(aliases: object) -> None:
    """Raise TypeError for other names that are no tuple of texts in lower case."""
    if isinstance(aliases, str):
        raise TypeError(f"its aliases are one text, which would be taken letter by letter: write ({aliases!r},)")
    names = cast("tuple[object, ...]", aliases) if isinstance(aliases, tuple) else None
    if names is None or not all(isinstance(name, str) and name == name.lower() for name in names):
        raise TypeError(f"its aliases are {aliases!r}: write a tuple of names in lower case")


def check_default(name: str, base: object, default: object) -> None:
    """Raise TypeError for a value without a default, or with one of another type."""
    if default is dataclasses.MISSING:
        raise TypeError(f"value '{name}': it has no default, which every value needs")
    types = _NUMBERS.get(base) if isinstance(base, type) else None
    if types and (not isinstance(default, types) or (isinstance(default, bool) and base is not bool)):
        raise TypeError(f"value '{name}': its default {default!r} is no {getattr(base, '__name__', base)}")


def check_unit(name: str, unit: str, units: Any) -> None:
    """Raise TypeError for a unit that nothing converts. `units` is the Literal of those that there are."""
    known = get_args(units)
    if unit not in known:
        near = get_close_matches(unit, known, 1, 0.3)
        hint = f"did you mean '{near[0]}'? They are" if near else "use one of"
        raise TypeError(f"value '{name}': there is no unit '{unit}'; {hint} {', '.join(known)}")
