"""The GLSL library: shader texts by name, their functions' signatures, their includes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from types import MappingProxyType

from ..errors import ShaderError

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_INCLUDE = re.compile(r'^[ \t]*#include[ \t]+"([^"]+)"[^\n]*$', re.MULTILINE)
_FUNCTION = re.compile(r"^(\w+)[ \t]+(\w+)[ \t]*\(([^)]*)\)\s*\{", re.MULTILINE)
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
    words: frozenset[str]


@dataclass(frozen=True)
class Text:
    """One GLSL file without its `#include` lines (their lines stay, empty, so that numbers hold).

    `functions` are by name; `all_functions` also has every overload, in order.
    """

    name: str
    body: str
    includes: tuple[str, ...]
    functions: Mapping[str, Function]
    all_functions: tuple[Function, ...]
    words: frozenset[str]

    def only(self, entries: frozenset[str]) -> str:
        """The text without functions that `entries` do not need: another draw may need other accessors.

        Their lines stay, empty.
        """
        needed: set[str] = set()
        todo = [name for name in entries if name in self.functions]
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
        return text


def _function(match: re.Match[str], code: str) -> Function:
    result, name, inside = match.groups()
    depth, end = 1, match.end()
    while depth and end < len(code):
        depth += {"{": 1, "}": -1}.get(code[end], 0)
        end += 1
    used = frozenset(_WORD.findall(code, match.end(), end))
    taken: list[tuple[str, str]] = []
    given: list[tuple[str, str]] = []
    for part in filter(None, (item.strip() for item in inside.split(","))):
        words = [word for word in part.split() if word not in ("const", "in", "highp")]
        if words[0] == "out":
            given.append((words[1], words[2]))
        else:
            taken.append((words[0], words[1]))
    return Function(name, result, tuple(taken), tuple(given), match.start(), end, used)


def parse(name: str, source: str) -> Text:
    """Read a shader file's functions and includes."""
    # Comments become spaces of the same height, so that a brace in a sentence is no code and lines keep their numbers.
    code = _COMMENT.sub(lambda match: _BLANK.sub(" ", match[0]), source)
    functions = tuple(_function(match, code) for match in _FUNCTION.finditer(code))
    by_name = MappingProxyType({one.name: one for one in functions})
    body = _INCLUDE.sub(lambda match: _BLANK.sub(" ", match[0]), source)
    words = frozenset(_WORD.findall(code))
    return Text(name, body, tuple(_INCLUDE.findall(source)), by_name, functions, words)


@dataclass(frozen=True)
class Library:
    """Shader texts by name, such as `color/exposure` or `lib/color`."""

    texts: Mapping[str, Text]
    _closures: dict[tuple[str, ...], tuple[Text, ...]] = field(
        default_factory=dict[tuple[str, ...], tuple[Text, ...]], compare=False, repr=False
    )

    def text(self, name: str, asker: str = "") -> Text:
        """The file, or a ShaderError that names who asked."""
        try:
            return self.texts[name]
        except KeyError:
            raise ShaderError(asker or name, f"shaders/{name}.glsl", 1, "there is no such shader file") from None

    def function(self, shader: str, name: str, asker: str) -> Function:
        """A function of a file, or a ShaderError that names who asked."""
        text = self.text(shader, asker)
        if name not in text.functions:
            raise ShaderError(asker, f"shaders/{shader}.glsl", 1, f"there is no function '{name}' in it")
        return text.functions[name]

    def closure(self, names: tuple[str, ...]) -> tuple[Text, ...]:
        """The files and all they include, each once, includes first."""
        if names not in self._closures:
            done: dict[str, Text] = {}

            def visit(name: str, asker: str) -> None:
                if name in done:
                    return
                text = self.text(name, asker)
                for include in text.includes:
                    visit(include.removesuffix(".glsl"), name)
                done[name] = text

            for name in names:
                visit(name, name)
            self._closures[names] = tuple(done.values())
        return self._closures[names]

    def uses(self, shader: str, word: str) -> bool:
        """True if the file or anything it includes says `word`."""
        return any(word in text.words for text in self.closure((shader,)))


def _walk(folder: Traversable, prefix: str) -> dict[str, Text]:
    found: dict[str, Text] = {}
    for item in folder.iterdir():
        if item.is_dir():
            found |= _walk(item, f"{prefix}{item.name}/")
        elif item.name.endswith(".glsl"):
            name = prefix + item.name.removesuffix(".glsl")
            found[name] = parse(name, item.read_text(encoding="utf-8"))
    return found


@cache
def installed() -> Library:
    """The library that ships with Halation."""
    return Library(MappingProxyType(_walk(resources.files(f"{__name__.partition('.')[0]}.shaders"), "")))
