"""Reading GLSL: the functions of a file, their signatures, what it includes, the words that it says."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType

from msgspec import Struct
from msgspec.structs import replace

COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
INCLUDE = re.compile(r'^[ \t]*#include[ \t]+"([^"]+)"[^\n]*$', re.MULTILINE)
_FUNCTION = re.compile(
    r"^[ \t]*(?:(?:highp|precise)\s+)*(\w+)\s+(?!(?:if|for|while|switch)\b)(\w+)\s*\(([^)]*)\)\s*\{", re.MULTILINE
)
_PARAMETER = re.compile(r"(?:(out)\s+)?((?:inout\s+)?\w+(?:\s*\[\w*\])?)\s*(\w*)\s*(\[\w*\])?")
_QUALIFIER = re.compile(r"\b(?:const|in|highp|mediump|lowp|precise)\s+")
_WORD = re.compile(r"[A-Za-z_]\w*")
_BRACE = re.compile(r"[{}]")
_BLANK = re.compile(r"[^\n]")


class GlslFunction(Struct, frozen=True):
    """A GLSL signature: `result name(parameters)`; `outputs` are the `out` parameters."""

    name: str
    result: str
    parameters: tuple[tuple[str, str], ...]
    outputs: tuple[tuple[str, str], ...]
    start: int
    end: int
    """Where it lies in the text of its file."""
    line: int
    words: frozenset[str]
    """All words of its body: what it calls is among them."""


class GlslText(Struct, frozen=True, dict=True):
    """One GLSL file without comments and `#include` lines (their lines stay, empty, so that numbers hold).

    `file` is what messages call it. `includes` are the lines of what it includes, by name. `functions` are by name;
    `all_functions` also has every overload, in order.
    """

    name: str
    file: str
    body: str
    includes: Mapping[str, int]
    functions: Mapping[str, GlslFunction]
    all_functions: tuple[GlslFunction, ...]
    words: frozenset[str]

    @cached_property
    def _cuts(self) -> dict[frozenset[str], GlslText]:
        return {}

    def keep_needed(self, entries: frozenset[str]) -> GlslText:
        """The text without functions that `entries` do not need: another draw may need other accessors.

        Their lines stay, empty.
        """
        entries &= frozenset(self.functions)
        if entries not in self._cuts:
            self._cuts[entries] = self._cut(entries)
        return self._cuts[entries]

    def _cut(self, entries: frozenset[str]) -> GlslText:
        needed: set[str] = set()
        todo = [*entries, *(self.outside & self.functions.keys())]
        while todo:
            name = todo.pop()
            if name not in needed:
                needed.add(name)
                for function in self.all_functions:
                    if function.name == name:
                        todo.extend(word for word in function.words if word in self.functions)
        text = self.body
        for function in self.all_functions:
            if function.name not in needed:
                blank = _BLANK.sub(" ", text[function.start : function.end])
                text = text[: function.start] + blank + text[function.end :]
        return replace(self, body=text, words=words(text))

    @property
    def outside(self) -> frozenset[str]:
        """The words that stand in no function: those of constants and macros."""
        text = self.body
        for function in reversed(self.all_functions):
            text = text[: function.start] + text[function.end :]
        return words(text)


def _function(match: re.Match[str], code: str) -> GlslFunction:
    result, name, inside = match.groups()
    depth, end = 1, len(code)
    for brace in _BRACE.finditer(code, match.end()):
        depth += 1 if brace[0] == "{" else -1
        if not depth:
            end = brace.end()
            break
    used = frozenset(_WORD.findall(code, match.end(), end))
    parameters: list[tuple[str, str]] = []
    outputs: list[tuple[str, str]] = []
    for part in _QUALIFIER.sub("", inside).split(","):
        declaration = _PARAMETER.match(part.strip())
        if declaration is not None and declaration[2] != "void":
            way, glsl, called, array = declaration.groups(default="")
            (outputs if way else parameters).append((glsl + array, called))
    line = code.count("\n", 0, match.start(2)) + 1
    return GlslFunction(name, result, tuple(parameters), tuple(outputs), match.start(), end, line, used)


def blank_comments(source: str) -> str:
    """Code whose comments are spaces of the same height: lines and columns stay.

    A brace in a sentence is no code then, and no driver sees letters beyond ASCII.
    """
    return COMMENT.sub(_blank, unify_lines(source))


def unify_lines(source: str) -> str:
    """The text with line ends of one kind."""
    return source.replace("\r\n", "\n").replace("\r", "\n").removeprefix("\ufeff")


def parse(name: str, source: str, file: str = "") -> GlslText:
    """Read a shader file's functions and includes. `file` is what messages call it."""
    code = blank_comments(source)
    functions = tuple(_function(match, code) for match in _FUNCTION.finditer(code))
    by_name = MappingProxyType({function.name: function for function in functions})
    includes = {
        match[1].removesuffix(".glsl"): code.count("\n", 0, match.start()) + 1 for match in INCLUDE.finditer(code)
    }
    words = frozenset(_WORD.findall(code))
    return GlslText(
        name,
        file or f"shaders/{name}.glsl",
        INCLUDE.sub(_blank, code),
        MappingProxyType(includes),
        by_name,
        functions,
        words,
    )


def macro_name(value: str, choice: str) -> str:
    """The macro that stands for a choice in GLSL: `MODE_SOFT_LIGHT`."""
    return "".join(letter if letter.isalnum() else "_" for letter in f"{value}_{choice}").upper()


def words(*code: str) -> frozenset[str]:
    """Every word that stands in pieces of GLSL."""
    return frozenset(_WORD.findall(" ".join(code)))


def _blank(match: re.Match[str]) -> str:
    return _BLANK.sub(" ", match[0])
