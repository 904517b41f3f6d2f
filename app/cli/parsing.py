"""What is typed behind the flags."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..errors import UsageError


def assignments(items: list[str], flag: str) -> dict[str, str]:
    """`name=text` pairs in order. Raises UsageError for anything else and for a name given twice."""
    found: dict[str, str] = {}
    for item in items:
        name, equals, text = item.partition("=")
        if not equals or not name or not text:
            raise UsageError(f"{flag} {item}: write {flag} NAME=VALUE")
        if name in found:
            raise UsageError(f"{flag} {item}: '{name}' is given twice")
        found[name] = text
    return found


def paths(items: list[str]) -> dict[str, Path]:
    """`-o out.exr` or `-o name=out.exr`; the name of a bare path is empty."""
    found: dict[str, Path] = {}
    for item in items:
        name, equals, text = item.partition("=")
        name, text = (name, text) if equals and "/" not in name and "." not in name else ("", item)
        if name in found:
            raise UsageError(f"-o {item}: {'an output' if not name else repr(name)} is given twice")
        found[name] = Path(text)
    return found


def value(text: str) -> Any:
    """A value as typed: a number, true or false, numbers with commas between, or a word."""
    for candidate in (text, f"[{text}]"):
        try:
            return json.loads(candidate, parse_constant=_refused)
        except ValueError:
            continue
    return text


def _refused(word: str) -> Any:
    raise UsageError(f"--set: {word} is no value; write a finite number")


def size(text: str | None) -> tuple[int, int] | None:
    """`960x540` as width and height."""
    if text is None:
        return None
    width, cross, height = text.lower().partition("x")
    if not cross or not width.isdecimal() or not height.isdecimal() or not int(width) or not int(height):
        raise UsageError(f"--size {text}: write WIDTHxHEIGHT in pixels, such as 1920x1080")
    return int(width), int(height)


def scale(number: float) -> float:
    """A proxy scale in 0..1."""
    if not 0.0 < number <= 1.0:
        raise UsageError(f"--scale {number:g}: write a number above 0 and up to 1; 0.5 renders at half size")
    return number


def choice(text: str | None, known: tuple[str, ...], flag: str) -> str | None:
    """One of a few words."""
    if text is not None and text not in known:
        raise UsageError(f"{flag} {text}: choose {' or '.join(known)}")
    return text
