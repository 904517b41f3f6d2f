"""Names that a user lists in one text, with commas between them, and choices among them."""

from __future__ import annotations

from msgspec.structs import replace

from .values import Value


def list_names(text: str) -> tuple[str, ...]:
    """The names in a text; one that is left out is empty."""
    return tuple(name.strip() for name in text.split(","))


def find_number(text: str, name: str) -> int | None:
    """The number of a name in a text that lists names, from 1 on, or the number that it says; None if it says none."""
    names = list_names(text)
    if name and name in names:
        return names.index(name) + 1
    return int(name) if is_number(name) else None


def is_number(text: str) -> bool:
    """True for the digits of a small number, without zeros before it."""
    return text.isascii() and text.isdecimal() and text == text.lstrip("0")[:3]


def declare_choice(value: Value, names: str) -> Value:
    """The value as a choice among the names that a text lists."""
    known = (name for name in list_names(names)[: int(value.maximum)] if name)
    return replace(value, type="choice", choices=("", *dict.fromkeys(known)))
