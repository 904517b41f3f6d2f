"""What a client may ask for: requests as lines of JSON."""

from __future__ import annotations

import json
from typing import Any, Literal

from msgspec import Struct, field

from ..errors import HalationError, UsageError
from ..resources.struct_json import read_struct

MAX_LINE_BYTES = 2**27
"""Bytes of one request: a picture of 8 MP in four floats as base64 is 179 MB, one of 4 MP fits. Larger ones go by
file."""


class ServiceRequest(Struct, frozen=True, forbid_unknown_fields=True, rename={"action": "do"}):
    """One request. `graph` is a file, the name of a preset, or a graph as JSON.

    `input` and `set` are those of the command line, with numbers as numbers; an input may also be an array (see
    `unpack_array`). `output` are files by the name of an output, "" for all; without any, the reply holds the pixels,
    or `array_file` does, which may hold those of inputs too (see `ArrayFile`). `request` is what a `cancel` ends.
    `width` is that of a thumbnail.
    """

    action: Literal["render", "thumbnail", "explain", "check", "cancel"]
    id: str | int | None = None
    graph: str | dict[str, Any] = ""
    input: dict[str, Any] = field(default_factory=dict[str, Any])
    set: dict[str, Any] = field(default_factory=dict[str, Any])
    node: str = ""
    size: tuple[int, int] | None = None
    scale: float = 1.0
    frame: int | None = None
    precision: Literal["half", "float"] | None = None
    output: dict[str, str] = field(default_factory=dict[str, str])
    array_file: str = ""
    view: str = ""
    width: int = 320
    request: str | int | None = None


def parse_request(line: bytes) -> ServiceRequest:
    """The request in a line. Raises UsageError that says what is wrong with it."""
    try:
        return read_struct(line, ServiceRequest)
    except (ValueError, RecursionError) as fault:
        raise UsageError(
            f'the line is not a request ({fault}): write {{"do": "render", "graph": "look.json", ...}}'
        ) from None


def find_request_id(line: bytes) -> object:
    """The id in a line that is not a valid request, for the reply; None without one."""
    try:
        parsed = json.loads(line)
    except (ValueError, RecursionError):
        return None
    name = parsed.get("id") if isinstance(parsed, dict) else None  # pyright: ignore[reportUnknownVariableType, reportUnknownMemberType]
    return name if isinstance(name, str | int) else None  # pyright: ignore[reportUnknownVariableType]


def describe_failure(fault: BaseException) -> dict[str, Any]:
    """An error for a reply: its class, its sentence, and the exit code that a command would have."""
    if isinstance(fault, HalationError):
        return {"kind": type(fault).__name__, "message": str(fault), "exit_code": fault.exit_code}
    if isinstance(fault, MemoryError):
        return {"kind": "MemoryError", "message": str(fault) or "there is not enough memory", "exit_code": 1}
    sentence = f"this is a bug in Halation ({type(fault).__name__}: {fault})"
    return {"kind": "Bug", "message": sentence, "exit_code": 70}
