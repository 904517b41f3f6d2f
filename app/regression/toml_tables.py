"""TOML -> checked values; every fault names the file and the key."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from ..document.disk import read_text
from ..errors import DocumentError, HalationError
from ..graph import did_you_mean
from ..graph.frames import parse_frames
from ..resources.sandbox import Sandbox
from .cases import Golden


def parse_toml(path: Path, sandbox: Sandbox) -> dict[str, Any]:
    """The tables of a TOML file. Raises DocumentError."""
    try:
        return tomllib.loads(read_text(path, sandbox=sandbox))
    except tomllib.TOMLDecodeError as error:
        said = str(error)
        raise DocumentError(str(path), "", f"not valid TOML: {said[:1].lower()}{said[1:]}") from None
    except RecursionError:
        raise DocumentError(str(path), "", "the tables are nested too deeply") from None


@dataclass(frozen=True)
class TomlTable:
    """A table of a file, and where it stands there. Raises DocumentError for what is not as it should be."""

    file: str
    path: str
    items: dict[str, Any]

    def fault(self, key: str, said: str) -> DocumentError:
        """What is wrong with a key."""
        return DocumentError(self.file, ".".join(filter(None, (self.path, key))), said)

    def refuse_other_keys(self, known: Sequence[str]) -> None:
        """Refuse other keys than these."""
        for key in self.items:
            if key not in known:
                raise self.fault(key, f"there is no such key{did_you_mean(key, known)}")

    def merge_over(self, defaults: TomlTable) -> TomlTable:
        """This table, with what it lacks from another; tables in it are mixed too."""
        mixed = {**defaults.items, **self.items}
        for key, item in self.items.items():
            below = defaults.items.get(key)
            if isinstance(item, dict) and isinstance(below, dict) and key != "golden":
                mixed[key] = {**below, **item}
        return TomlTable(self.file, self.path, mixed)

    def without(self, key: str) -> TomlTable:
        """This table less a key."""
        return TomlTable(self.file, self.path, {name: item for name, item in self.items.items() if name != key})

    def table(self, key: str) -> TomlTable:
        """A table in this one; an empty one if it is not there."""
        found: Any = self.items.get(key, {})
        if not isinstance(found, dict):
            raise self.fault(key, f"a table is needed, as in [{self.path or key}]; this is {describe_value(found)}")
        return TomlTable(self.file, ".".join(filter(None, (self.path, key))), cast("dict[str, Any]", found))

    def text(self, key: str) -> str:
        """A string; "" if it is not there."""
        found = self.items.get(key, "")
        if not isinstance(found, str):
            raise self.fault(key, f"text in quotes is needed; this is {describe_value(found)}")
        return found

    def number(self, key: str, default: float, low: float | None, high: float | None) -> float:
        """A finite number within its limits."""
        found = self.items.get(key, default)
        if isinstance(found, bool) or not isinstance(found, int | float) or not math.isfinite(found):
            raise self.fault(key, f"a number is needed; this is {describe_value(found)}")
        if (low is not None and found < low) or (high is not None and found > high) or (key == "scale" and not found):
            raise self.fault(key, f"{found:g} is not within {low:g} and {high:g}")
        return float(found)

    def choice(self, key: str, known: Sequence[str], default: str) -> str:
        """One of a few words."""
        found = self.text(key) or default
        if found not in known:
            raise self.fault(key, f"there is no '{found}'{did_you_mean(found, known)}")
        return found

    def choices(self, key: str, known: Sequence[str]) -> tuple[str, ...]:
        """Some of a few words."""
        found: Any = self.items.get(key, [])
        if not isinstance(found, list) or not all(isinstance(item, str) for item in cast("list[Any]", found)):
            raise self.fault(
                key, f"a list is needed, such as [{', '.join(map(repr, known))}]; this is {describe_value(found)}"
            )
        for item in cast("list[str]", found):
            if item not in known:
                raise self.fault(key, f"there is no '{item}'{did_you_mean(item, known)}")
        return tuple(cast("list[str]", found))


def read_frames(table: TomlTable) -> tuple[int, ...]:
    """`frame = 3`, or `frames = "1-24x2"` or a list; none stands for the first frame of the graph."""
    one, several = table.items.get("frame"), table.items.get("frames")
    if one is not None and several is not None:
        raise table.fault("frames", "give frame or frames, not both")
    if several is None:
        if one is not None and (isinstance(one, bool) or not isinstance(one, int)):
            raise table.fault("frame", f"a whole number is needed; this is {describe_value(one)}")
        return () if one is None else (one,)
    if isinstance(several, list):
        listed = cast("list[Any]", several)
        if not listed or not all(isinstance(item, int) and not isinstance(item, bool) for item in listed):
            raise table.fault(
                "frames", f"whole numbers are needed, as in [1, 12, 24]; this is {describe_value(listed)}"
            )
        return tuple(dict.fromkeys(listed))
    try:
        return parse_frames(table.text("frames"))
    except HalationError as fault:
        raise table.fault("frames", str(fault)) from None


def read_size(table: TomlTable) -> tuple[int, int] | None:
    """`size = "480x270"` or `[480, 270]`."""
    found: Any = table.items.get("size")
    sides = found.lower().split("x") if isinstance(found, str) else found
    if found is None:
        return None
    if isinstance(sides, list) and len(cast("list[Any]", sides)) == 2:
        texts = [str(side) for side in cast("list[Any]", sides)]
        if all(text.isascii() and text.isdecimal() and 0 < int(text) < 10**6 for text in texts):
            return int(texts[0]), int(texts[1])
    raise table.fault("size", 'write "WIDTHxHEIGHT" in pixels, such as "480x270"')


def read_inputs(table: TomlTable, folder: Path) -> dict[str, Any]:
    """Inputs by name: paths made complete, numbers and lists of them as they are."""
    found: dict[str, Any] = {}
    inputs = table.table("inputs")
    for name, item in inputs.items.items():
        if isinstance(item, str) and item:
            found[name] = str(folder / item)
        elif isinstance(item, int | float) and not isinstance(item, bool):
            found[name] = float(item)
        elif isinstance(item, list) and item and all(isinstance(part, int | float) for part in cast("list[Any]", item)):
            found[name] = tuple(map(float, cast("list[float]", item)))
        else:
            raise inputs.fault(name, f"a file, a number or a list of numbers is needed; this is {describe_value(item)}")
    return found


def read_goldens(table: TomlTable, folder: Path, case: str, graph: str) -> tuple[Golden, ...]:
    """`golden = "FILE"`, or a table of files by output; {case} and {graph} in a name stand for those."""
    several = isinstance(table.items.get("golden"), dict)
    named = table.table("golden") if several else table
    made: list[Golden] = []
    for key in tuple(named.items) if several else ("golden",):
        text = named.text(key).replace("{case}", case).replace("{graph}", graph)
        if text:
            made.append(Golden(folder / text, key if several else ""))
    if len({golden.path for golden in made}) < len(made):
        raise table.fault("golden", "one file is named for two outputs; give every output a file of its own")
    return tuple(made)


def describe_value(item: object) -> str:
    """What a value of a file is, for a sentence."""
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
