"""The GLSL library: shader texts by name, their functions' signatures, their includes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from types import MappingProxyType

from ..errors import ShaderError

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_INCLUDE = re.compile(r'^[ \t]*#include[ \t]+"([^"]+)"[^\n]*$', re.MULTILINE)
_FUNCTION = re.compile(
    r"^[ \t]*(?:(?:highp|precise)\s+)*(\w+)\s+(?!(?:if|for|while|switch)\b)(\w+)\s*\(([^)]*)\)\s*\{", re.MULTILINE
)
_PARAMETER = re.compile(r"(?:(out)\s+)?((?:inout\s+)?\w+(?:\s*\[\w*\])?)\s*(\w*)\s*(\[\w*\])?")
_QUALIFIER = re.compile(r"\b(?:const|in|highp|mediump|lowp|precise)\s+")
_WORD = re.compile(r"[A-Za-z_]\w*")
_BLANK = re.compile(r"[^\n]")


@dataclass(frozen=True)
class Function:
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


@dataclass(frozen=True)
class Text:
    """One GLSL file without comments and `#include` lines (their lines stay, empty, so that numbers hold).

    `includes` are the lines of what it includes, by name. `functions` are by name; `all_functions` also has every
    overload, in order.
    """

    name: str
    body: str
    includes: Mapping[str, int]
    functions: Mapping[str, Function]
    all_functions: tuple[Function, ...]
    words: frozenset[str]
    _cuts: dict[frozenset[str], Text] = field(default_factory=dict[frozenset[str], "Text"], compare=False, repr=False)

    def only(self, entries: frozenset[str]) -> Text:
        """The text without functions that `entries` do not need: another draw may need other accessors.

        Their lines stay, empty.
        """
        entries &= frozenset(self.functions)
        if entries not in self._cuts:
            self._cuts[entries] = self._only(entries)
        return self._cuts[entries]

    def _only(self, entries: frozenset[str]) -> Text:
        needed: set[str] = set()
        todo = [*entries, *(self._outside() & self.functions.keys())]
        while todo:
            name = todo.pop()
            if name not in needed:
                needed.add(name)
                for one in self.all_functions:
                    if one.name == name:
                        todo.extend(word for word in one.words if word in self.functions)
        text = self.body
        for one in self.all_functions:
            if one.name not in needed:
                blank = _BLANK.sub(" ", text[one.start : one.end])
                text = text[: one.start] + blank + text[one.end :]
        return replace(self, body=text, words=words(text), _cuts={})

    def _outside(self) -> frozenset[str]:
        """The words that stand in no function: those of constants and macros."""
        text = self.body
        for one in reversed(self.all_functions):
            text = text[: one.start] + text[one.end :]
        return words(text)


def _function(match: re.Match[str], code: str) -> Function:
    result, name, inside = match.groups()
    depth, end = 1, match.end()
    while depth and end < len(code):
        depth += {"{": 1, "}": -1}.get(code[end], 0)
        end += 1
    used = frozenset(_WORD.findall(code, match.end(), end))
    taken: list[tuple[str, str]] = []
    given: list[tuple[str, str]] = []
    for part in _QUALIFIER.sub("", inside).split(","):
        found = _PARAMETER.match(part.strip())
        if found is not None and found[2] != "void":
            way, glsl, called, array = found.groups(default="")
            (given if way else taken).append((glsl + array, called))
    line = code.count("\n", 0, match.start(2)) + 1
    return Function(name, result, tuple(taken), tuple(given), match.start(), end, line, used)


def parse(name: str, source: str) -> Text:
    """Read a shader file's functions and includes."""
    # Comments become spaces of the same height: a brace in a sentence is no code, lines keep their numbers, and no
    # driver sees letters beyond ASCII.
    code = _COMMENT.sub(_blanked, source.replace("\r\n", "\n").removeprefix("\ufeff"))
    functions = tuple(_function(match, code) for match in _FUNCTION.finditer(code))
    by_name = MappingProxyType({one.name: one for one in functions})
    includes = {
        match[1].removesuffix(".glsl"): code.count("\n", 0, match.start()) + 1 for match in _INCLUDE.finditer(code)
    }
    words = frozenset(_WORD.findall(code))
    return Text(name, _INCLUDE.sub(_blanked, code), MappingProxyType(includes), by_name, functions, words)


def words(*code: str) -> frozenset[str]:
    """Every word that stands in pieces of GLSL."""
    return frozenset(_WORD.findall(" ".join(code)))


def _blanked(match: re.Match[str]) -> str:
    return _BLANK.sub(" ", match[0])


@dataclass(frozen=True)
class Library:
    """Shader texts by name, such as `color/exposure` or `lib/color`."""

    texts: Mapping[str, Text]
    _closures: dict[tuple[str, ...], tuple[Text, ...]] = field(
        default_factory=dict[tuple[str, ...], tuple[Text, ...]], compare=False, repr=False
    )

    def function(self, shader: str, name: str, asker: str) -> Function:
        """A function of a file, or a ShaderError that names who asked."""
        text = self._text(shader, asker)
        if name not in text.functions:
            raise ShaderError(asker, f"shaders/{shader}.glsl", 1, f"there is no function '{name}' in it")
        return text.functions[name]

    def closure(self, names: tuple[str, ...], asker: str) -> tuple[Text, ...]:
        """The files and all they include, each once, includes first. `asker` is named in a ShaderError."""
        if names not in self._closures:
            done: dict[str, Text] = {}
            for name in names:
                self._include(name, asker, (), done)
            self._closures[names] = tuple(done.values())
        return self._closures[names]

    def uses(self, shader: str, words: frozenset[str], asker: str) -> bool:
        """True if the file or anything it includes says one of `words`."""
        return any(words & text.words for text in self.closure((shader,), asker))

    def _text(self, name: str, asker: str) -> Text:
        if name not in self.texts:
            raise ShaderError(asker, f"shaders/{name}.glsl", 1, "there is no such shader file")
        return self.texts[name]

    def _include(self, name: str, asker: str, trail: tuple[str, ...], done: dict[str, Text]) -> None:
        """Add a file to `done`, after all that it includes. `trail` are the files that led to it."""
        if name in done:
            return
        text = self._text(name, asker)
        for include, line in text.includes.items():
            circle = include in (*trail, name)
            if circle or include not in self.texts:
                fault = "goes in a circle" if circle else "names no shader file"
                raise ShaderError(asker, f"shaders/{name}.glsl", line, f'#include "{include}.glsl" {fault}')
            self._include(include, asker, (*trail, name), done)
        done[name] = text


def _walk(folder: Traversable, prefix: str) -> dict[str, Text]:
    found: dict[str, Text] = {}
    for item in folder.iterdir():
        if item.is_dir():
            found |= _walk(item, f"{prefix}{item.name}/")
        elif item.name.endswith(".glsl"):
            name = prefix + item.name.removesuffix(".glsl")
            found[name] = parse(name, item.read_bytes().decode(errors="replace"))
    return found


@cache
def installed() -> Library:
    """The library that ships with Halation."""
    return Library(MappingProxyType(_walk(resources.files(f"{__name__.partition('.')[0]}.shaders"), "")))
