"""Reads checked values from TOML tables; every fault names the file and the key."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

from msgspec import Struct

from ..document.disk import read_text
from ..errors import DocumentError, HalationError
from ..graph import did_you_mean
from ..graph.frames import parse_frames
from ..resources.sandbox import Sandbox
from .cases import Golden

_MOST_PIXELS = 10**6
"""Pixels of a side, from which on a number is taken for a typing error."""


def parse_toml(path: Path, sandbox: Sandbox) -> dict[str, Any]:
    """The tables of a TOML file. Raises DocumentError."""
    try:
        return tomllib.loads(read_text(path, sandbox=sandbox))
    except tomllib.TOMLDecodeError as error:
        message = str(error)
        raise DocumentError(str(path), "", f"not valid TOML: {message[:1].lower()}{message[1:]}") from None
    except RecursionError:
        raise DocumentError(str(path), "", "the tables are nested too deeply") from None


class TomlTable(Struct, frozen=True):
    """A table of a file and its path there. All methods raise DocumentError for an invalid value."""

    file: str
    path: str
    items: dict[str, Any]

    def make_fault(self, key: str, sentence: str) -> DocumentError:
        """An error about a key."""
        return DocumentError(self.file, ".".join(filter(None, (self.path, key))), sentence)

    def refuse_other_keys(self, keys: Sequence[str]) -> None:
        """Raise DocumentError for any other key."""
        for key in self.items:
            if key not in keys:
                raise self.make_fault(key, f"there is no such key{did_you_mean(key, keys)}")

    def merge_over(self, defaults: TomlTable) -> TomlTable:
        """This table with defaults for missing keys; tables inside are merged, too."""
        mixed = {**defaults.items, **self.items}
        for key, item in self.items.items():
            below = defaults.items.get(key)
            if isinstance(item, dict) and isinstance(below, dict) and key != "golden":
                mixed[key] = {**below, **item}
        return TomlTable(self.file, self.path, mixed)

    def drop_key(self, key: str) -> TomlTable:
        """This table without a key."""
        return TomlTable(self.file, self.path, {name: item for name, item in self.items.items() if name != key})

    def read_table(self, key: str) -> TomlTable:
        """A table in this one; an empty one if it is not there."""
        table: Any = self.items.get(key, {})
        if not isinstance(table, dict):
            raise self.make_fault(
                key, f"a table is needed, as in [{self.path or key}]; this is {describe_value(table)}"
            )
        return TomlTable(self.file, ".".join(filter(None, (self.path, key))), cast("dict[str, Any]", table))

    def read_text(self, key: str) -> str:
        """A string; "" if it is not there."""
        text = self.items.get(key, "")
        if not isinstance(text, str):
            raise self.make_fault(key, f"text in quotes is needed; this is {describe_value(text)}")
        return text

    def read_number(self, key: str, default: float, low: float | None, high: float | None) -> float:
        """A finite number within its limits."""
        number = self.items.get(key, default)
        if isinstance(number, bool) or not isinstance(number, int | float) or not math.isfinite(number):
            raise self.make_fault(key, f"a number is needed; this is {describe_value(number)}")
        if (
            (low is not None and number < low)
            or (high is not None and number > high)
            or (key == "scale" and not number)
        ):
            raise self.make_fault(key, f"{number:g} is not within {low:g} and {high:g}")
        return float(number)

    def read_choice(self, key: str, options: Sequence[str], default: str) -> str:
        """One of a few words."""
        word = self.read_text(key) or default
        if word not in options:
            raise self.make_fault(key, f"there is no '{word}'{did_you_mean(word, options)}")
        return word

    def read_choices(self, key: str, options: Sequence[str]) -> tuple[str, ...]:
        """Some of a few words."""
        words: Any = self.items.get(key, [])
        if not isinstance(words, list) or not all(isinstance(item, str) for item in cast("list[Any]", words)):
            raise self.make_fault(
                key, f"a list is needed, such as [{', '.join(map(repr, options))}]; this is {describe_value(words)}"
            )
        for item in cast("list[str]", words):
            if item not in options:
                raise self.make_fault(key, f"there is no '{item}'{did_you_mean(item, options)}")
        return tuple(cast("list[str]", words))


def read_frames(table: TomlTable) -> tuple[int, ...]:
    """`frame = 3`, or `frames = "1-24x2"` or a list; none stands for the first frame of the graph."""
    frame, frames = table.items.get("frame"), table.items.get("frames")
    if frame is not None and frames is not None:
        raise table.make_fault("frames", "give frame or frames, not both")
    if frames is None:
        if frame is not None and (isinstance(frame, bool) or not isinstance(frame, int)):
            raise table.make_fault("frame", f"a whole number is needed; this is {describe_value(frame)}")
        return () if frame is None else (frame,)
    if isinstance(frames, list):
        numbers = cast("list[Any]", frames)
        if not numbers or not all(isinstance(item, int) and not isinstance(item, bool) for item in numbers):
            raise table.make_fault(
                "frames", f"whole numbers are needed, as in [1, 12, 24]; this is {describe_value(numbers)}"
            )
        return tuple(dict.fromkeys(numbers))
    try:
        return parse_frames(table.read_text("frames"))
    except HalationError as fault:
        raise table.make_fault("frames", str(fault)) from None


def read_size(table: TomlTable) -> tuple[int, int] | None:
    """`size = "480x270"` or `[480, 270]`."""
    size: Any = table.items.get("size")
    sides = size.lower().split("x") if isinstance(size, str) else size
    if size is None:
        return None
    if isinstance(sides, list) and len(cast("list[Any]", sides)) == 2:
        texts = [str(side) for side in cast("list[Any]", sides)]
        if all(text.isascii() and text.isdecimal() and 0 < int(text) < _MOST_PIXELS for text in texts):
            return int(texts[0]), int(texts[1])
    raise table.make_fault("size", 'write "WIDTHxHEIGHT" in pixels, such as "480x270"')


def read_inputs(table: TomlTable, folder: Path) -> dict[str, Any]:
    """Inputs by name: paths made complete, numbers and lists of them as they are."""
    values: dict[str, Any] = {}
    inputs = table.read_table("inputs")
    for name, item in inputs.items.items():
        if isinstance(item, str) and item:
            values[name] = str(folder / item)
        elif isinstance(item, int | float) and not isinstance(item, bool):
            values[name] = float(item)
        elif isinstance(item, list) and item and all(isinstance(part, int | float) for part in cast("list[Any]", item)):
            values[name] = tuple(map(float, cast("list[float]", item)))
        else:
            raise inputs.make_fault(
                name, f"a file, a number or a list of numbers is needed; this is {describe_value(item)}"
            )
    return values


def read_goldens(table: TomlTable, folder: Path, case: str, graph: str) -> tuple[Golden, ...]:
    """`golden = "FILE"`, or a table of files by output; {case} and {graph} in a name stand for those."""
    has_outputs = isinstance(table.items.get("golden"), dict)
    files = table.read_table("golden") if has_outputs else table
    goldens: list[Golden] = []
    for key in tuple(files.items) if has_outputs else ("golden",):
        text = files.read_text(key).replace("{case}", case).replace("{graph}", graph)
        if text:
            goldens.append(Golden(folder / text, key if has_outputs else ""))
    if len({golden.path for golden in goldens}) < len(goldens):
        raise table.make_fault("golden", "one file is named for two outputs; give every output a file of its own")
    return tuple(goldens)


def describe_value(item: object) -> str:
    """The type of a value of a file, for a sentence."""
    match item:
        case bool():
            return "true" if item else "false"
        case int() | float():
            return f"the number {item}"
        case str():
            return f"the text {item!r}" if len(item) < 40 else "a text"
        case dict():
            return "a table"
        case list():
            return "a list"
        case _:
            return "a date or a time"
