"""Reads the header of an ISF file: the JSON in its first comment."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import Any, NoReturn, cast

from msgspec import Struct

from ...glsl import unify_lines
from ..code import CodeFault
from .sizes import SizeError, SizeFormula, read_size

_LARGEST_FLOAT = 3.4e38
"""Just below the largest float of 32 bits (3.403e38)."""

_LONGEST_NAME = 200
"""Letters of a name. Chosen by judgement: names become those of GLSL, which get a prefix."""

_SHOWN, _SHOWN_TEXT = 40, 60
"""How many characters of a wrong entry, and of a wrong text, a message repeats."""

MAX_INPUTS = 256
MAX_PASSES = 64
"""Choices, so that a hostile head costs little."""
TYPES = ("event", "bool", "long", "float", "point2D", "color", "image", "audio", "audioFFT")
PICTURES = ("image", "audio", "audioFFT")

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*|_[A-Za-z0-9][A-Za-z0-9_]*")
_RESERVED_NAMES = re.compile(
    r"gl_\w*|isf_\w*|vv_\w*|halation_\w*|IMG_\w*|\w*__\w*|PASSINDEX|RENDERSIZE|TIME|TIMEDELTA|DATE|FRAMEINDEX|main"
)

Section = dict[str, Any]


class IsfInput(Struct, frozen=True):
    """An input of the shader. Numbers are tuples: of one for a float, two for a point, four for a color."""

    name: str
    type: str
    label: str = ""
    default: tuple[float, ...] = ()
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    choices: tuple[tuple[int, str], ...] = ()
    """The values of a long, with their labels."""


class Buffer(Struct, frozen=True):
    """A buffer that passes draw into and read by name."""

    name: str
    persistent: bool = False
    floating: bool = False
    width: SizeFormula | None = None
    height: SizeFormula | None = None


class Header(Struct, frozen=True):
    """What a header declares. `passes` are the buffers they draw into, "" for the picture; there is at least one."""

    doc: str
    inputs: tuple[IsfInput, ...]
    passes: tuple[str, ...]
    buffers: Mapping[str, Buffer]
    imported: Mapping[str, str]
    """Files in the folder of the shader, by the names of their samplers."""
    categories: tuple[str, ...] = ()


def read_header(text: str) -> Header:
    """Read the header of a shader. Raises CodeFault with the line of the fault."""
    source = unify_lines(text)
    start = len(source) - len(source.lstrip())
    end = source.find("*/", start)
    if not source.startswith("/*", start) or end < 0:
        raise CodeFault(1, "this is no Interactive Shader Format: the file begins with /* {JSON} */, which is missing")
    return _HeaderReader(source, start + 2, source[start + 2 : end]).read()


class _HeaderReader:
    """Reads one header."""

    def __init__(self, source: str, start: int, head: str) -> None:
        self.source, self.end, self.first = source, start + len(head), source.count("\n", 0, start) + 1
        try:
            raw = json.loads(head, parse_constant=self._refuse_constant)
        except json.JSONDecodeError as fault:
            raise CodeFault(self.first + fault.lineno - 1, f"the head is no JSON: {_lower_first(fault.msg)}") from None
        except RecursionError:
            raise CodeFault(self.first, "the head is nested too deep") from None
        except ValueError:
            raise CodeFault(self.first, "the head holds a number that is too long") from None
        if not isinstance(raw, dict):
            self._fail("the head must be a JSON object, in braces")
        self.raw = cast(Section, raw)

    def read(self) -> Header:
        inputs = self._read_inputs()
        buffers: dict[str, Buffer] = {}
        self._read_old_buffers(buffers)
        passes = self._read_passes(buffers)
        imported = self._read_imported()
        used_names: set[str] = set()
        for name in (*(header_input.name for header_input in inputs), *buffers, *imported):
            if name in used_names:
                self._fail(f"the name '{name}' is used twice: rename one", name)
            used_names.add(name)
        size_names = {
            "WIDTH",
            "HEIGHT",
            *(header_input.name for header_input in inputs if header_input.type in ("float", "long", "bool", "event")),
        }
        for buffer in buffers.values():
            for formula in filter(None, (buffer.width, buffer.height)):
                for name in sorted(formula.names - size_names):
                    fault = f"the size '{formula.text}' of '{buffer.name}' reads '{name}', which is no number here"
                    self._fail(fault, buffer.name)
        credit = self._read_text(self.raw, "CREDIT")
        parts = (self._read_text(self.raw, "DESCRIPTION"), f"By {credit.removeprefix('by ')}." if credit else "")
        categories = tuple(part for part in self._read_list(self.raw, "CATEGORIES") if isinstance(part, str))
        doc = "\n".join(part for part in parts if part) or "A shader in the Interactive Shader Format."
        return Header(doc, inputs, passes, buffers, imported, categories)

    # --- inputs ------------------------------------------------------------------------------------------------------

    def _read_inputs(self) -> tuple[IsfInput, ...]:
        items = self._read_list(self.raw, "INPUTS")
        if len(items) > MAX_INPUTS:
            self._fail(f"there are {len(items)} INPUTS: {MAX_INPUTS} are the most", "INPUTS")
        return tuple(self._read_input(self._read_section(item, "INPUTS")) for item in items)

    def _read_input(self, raw: Section) -> IsfInput:
        name, kind = self._read_name(raw.get("NAME"), "an input"), raw.get("TYPE")
        if kind not in TYPES:
            self._fail(
                f"the input '{name}' has the TYPE {json.dumps(kind)[:_SHOWN]}: known are {', '.join(TYPES)}", name
            )
        label = self._read_text(raw, "LABEL")
        if kind in PICTURES:
            return IsfInput(name, kind, label)
        length = {"point2D": 2, "color": 4}.get(kind, 1)
        default, low, high = (self._read_numbers(raw, key, name, length) for key in ("DEFAULT", "MIN", "MAX"))
        if low and high:
            low, high = (tuple(pick(a, b) for a, b in zip(low, high, strict=True)) for pick in (min, max))
        return IsfInput(name, kind, label, default, low, high, self._read_choices(raw, name) if kind == "long" else ())

    def _read_choices(self, raw: Section, name: str) -> tuple[tuple[int, str], ...]:
        values, labels = self._read_list(raw, "VALUES"), self._read_list(raw, "LABELS")
        if not values and labels:
            values = list(range(len(labels)))
        numbers_by_label: dict[str, int] = {}
        for number, value in enumerate(values):
            if not _is_number(value) or value != int(value) or abs(value) >= 2**31:
                self._fail(
                    f"the VALUES of the input '{name}' are whole numbers, not {json.dumps(value)[:_SHOWN]}", name
                )
            written_label = str(labels[number]).strip() if number < len(labels) else ""
            written_label = label = written_label or str(int(value))
            again = 1
            while label in numbers_by_label:
                again += 1
                label = f"{written_label} ({again})"
            numbers_by_label[label] = int(value)
        return tuple((value, label) for label, value in numbers_by_label.items())

    def _read_numbers(self, raw: Section, key: str, name: str, length: int) -> tuple[float, ...]:
        """The numbers of an entry that is a number or a list of numbers; () if it is absent."""
        entry = raw.get(key)
        if entry is None:
            return ()
        parts = cast("list[Any]", entry) if isinstance(entry, list) else [entry]
        if length == 4 and len(parts) == 3:
            parts = [*parts, 1.0]
        if len(parts) != length or not all(_is_number(part) for part in parts):
            expected = "a number" if length == 1 else f"a list of {length} numbers"
            self._fail(f"the {key} of the input '{name}' is {json.dumps(entry)[:_SHOWN]}: it is {expected}", name)
        return tuple(float(part) for part in parts)

    # --- passes ------------------------------------------------------------------------------------------------------

    def _read_passes(self, buffers: dict[str, Buffer]) -> tuple[str, ...]:
        items = self._read_list(self.raw, "PASSES")
        if len(items) > MAX_PASSES:
            self._fail(f"there are {len(items)} PASSES: {MAX_PASSES} are the most", "PASSES")
        targets: list[str] = []
        for item in items:
            raw = self._read_section(item, "PASSES")
            target = raw.get("TARGET")
            targets.append(self._read_name(target, "the TARGET of a pass") if target not in (None, "") else "")
            if targets[-1]:
                self._read_buffer(buffers, targets[-1], raw, bool(_is_set(raw, "PERSISTENT")))
        return tuple(targets) or ("",)

    def _read_buffer(self, buffers: dict[str, Buffer], name: str, raw: Section, persistent: bool) -> None:
        """Add what a pass says of its buffer; several passes may draw into one buffer."""
        before = buffers.get(name, Buffer(name))
        buffers[name] = Buffer(
            name,
            persistent or before.persistent,
            bool(_is_set(raw, "FLOAT")) or before.floating,
            self._read_size(raw, "WIDTH", name) or before.width,
            self._read_size(raw, "HEIGHT", name) or before.height,
        )

    def _read_old_buffers(self, buffers: dict[str, Buffer]) -> None:
        """Read PERSISTENT_BUFFERS, where version 1 of the format lists buffers apart from passes."""
        entries = self.raw.get("PERSISTENT_BUFFERS") or []
        if not isinstance(entries, list | dict):
            self._fail("PERSISTENT_BUFFERS must be a list or an object", "PERSISTENT_BUFFERS")
        for item in cast("list[Any] | Section", entries):
            inner = cast(Section, entries).get(item) if isinstance(entries, dict) else None
            raw = cast(Section, inner) if isinstance(inner, dict) else {}
            self._read_buffer(buffers, self._read_name(item, "a persistent buffer"), raw, True)

    def _read_size(self, raw: Section, key: str, name: str) -> SizeFormula | None:
        entry = raw.get(key)
        if entry is None or entry == "":
            return None
        if not isinstance(entry, str) and not _is_number(entry):
            fault = f"the {key} of '{name}' must be a formula such as \"$WIDTH/2.0\", not {json.dumps(entry)[:_SHOWN]}"
            self._fail(fault, name)
        try:
            return read_size(str(entry))
        except SizeError as fault:
            self._fail(f"the {key} of '{name}', '{str(entry)[:_SHOWN_TEXT]}', cannot be read: {fault}", name)

    def _read_imported(self) -> dict[str, str]:
        section = self.raw.get("IMPORTED") or {}
        if isinstance(section, list):
            items = [
                (entry.get("NAME"), entry)
                for entry in (self._read_section(item, "IMPORTED") for item in cast(Any, section))
            ]
        elif isinstance(section, dict):
            items = [(name, self._read_section(item, "IMPORTED")) for name, item in cast(Section, section).items()]
        else:
            self._fail("IMPORTED must be an object", "IMPORTED")
        paths: dict[str, str] = {}
        for name_entry, raw in items:
            name, path = self._read_name(name_entry, "an imported picture"), self._read_text(raw, "PATH")
            parts = PurePosixPath(path).parts
            if not parts or "\\" in path or ":" in path or path.startswith("/") or ".." in parts or "\0" in path:
                self._fail(
                    f"the imported picture '{name}' has the PATH '{path[:_SHOWN_TEXT]}': name a file in the "
                    "folder of the shader or in one below",
                    name,
                )
            paths[name] = path
        return paths

    # --- parts -------------------------------------------------------------------------------------------------------

    def _fail(self, sentence: str, near: str = "") -> NoReturn:
        at = self.source.find(f'"{near}"', 0, self.end) if near else -1
        raise CodeFault(self.source.count("\n", 0, at) + 1 if at >= 0 else self.first, sentence)

    def _refuse_constant(self, word: str) -> NoReturn:
        self._fail(f"the head is not valid JSON: {word} is not a number")

    def _read_section(self, item: Any, key: str) -> Section:
        if not isinstance(item, dict):
            self._fail(f"{key} holds {json.dumps(item)[:_SHOWN]}, which is not a JSON object", key)
        return cast(Section, item)

    def _read_list(self, raw: Section, key: str) -> list[Any]:
        entries = raw.get(key)
        if entries is None:
            return []
        if not isinstance(entries, list):
            self._fail(f"{key} must be a list, in brackets", key)
        return cast("list[Any]", entries)

    def _read_text(self, raw: Section, key: str) -> str:
        entry = raw.get(key)
        return entry.strip() if isinstance(entry, str) else ""

    def _read_name(self, name: Any, owner: str) -> str:
        if not isinstance(name, str) or not _NAME.fullmatch(name) or len(name) > _LONGEST_NAME:
            self._fail(
                f"{owner} has the name {json.dumps(name)[:_SHOWN_TEXT]}: use letters, digits and _, as GLSL does",
                name if isinstance(name, str) else "",
            )
        if _RESERVED_NAMES.fullmatch(name):
            self._fail(f"{owner} is called '{name}', which means something else: choose another name", name)
        return name


def _is_number(item: Any) -> bool:
    return isinstance(item, int | float) and abs(item) < _LARGEST_FLOAT and math.isfinite(item)


def _is_set(raw: Section, key: str) -> bool:
    """True for true, 1, "1", "true" and "yes", all of which files have."""
    return str(raw.get(key, raw.get(key.lower(), ""))).strip().lower() in ("true", "1", "1.0", "yes")


def _lower_first(message: str) -> str:
    return message[:1].lower() + message[1:]
