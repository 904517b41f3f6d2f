"""Which shaders draw with a function of a shader: those that call it, and those that call these."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

SHADERS = Path(__file__).parents[2] / "shaders"

_HEAD = re.compile(r"^(?:\w+ )*\w+ (\w+)\([^;{}]*\)\s*\{", re.MULTILINE)
_CALL = re.compile(r"\b([a-z]\w*)\(")


def list_users(path: Path, line: int) -> list[str]:
    """Names of shaders without their folders: that of the file, then those that call what is in the line, the nearest
    first. Where the line is in no function, they are those that call any function of the file.
    """
    functions = list_functions()
    own = [each for each in functions if each[0] == path]
    here = {name for _, name, first, last, _ in own if first <= line <= last} or {name for _, name, *_ in own}
    stems, seen = dict.fromkeys([path.stem]), set[str]()
    while here:
        seen |= here
        callers = [(file, name) for file, name, _, _, calls in functions if calls & here]
        stems |= dict.fromkeys(file.stem for file, _ in callers)
        here = {name for _, name in callers} - seen
    return [*stems]


@cache
def list_functions() -> list[tuple[Path, str, int, int, set[str]]]:
    """All functions of shaders: the file, the name, the first and the last line, and the names that it calls."""
    root = SHADERS.parent
    files = sorted(SHADERS.rglob("*.glsl"))
    return [(file.relative_to(root), *each) for file in files for each in _read_functions(file.read_text("utf-8"))]


def _read_functions(text: str) -> Iterator[tuple[str, int, int, set[str]]]:
    for head in _HEAD.finditer(text):
        end, depth = head.end(), 1
        while depth and end < len(text):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        lines = (text.count("\n", 0, place) + 1 for place in (head.start(), end))
        yield (head[1], *lines, {*_CALL.findall(text[head.end() : end])})  # pyright: ignore[reportReturnType]
