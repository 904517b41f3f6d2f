"""Copies of functions for the constants that they are called with.

A node calls functions of many modes with the one that its value chose: `merge(a, b, mask, 8, ...)`. Drivers put
functions in the place of their calls, and most drop what a constant rules out. SwiftShader does not, and spends a
second on a program of 30 KB. Copies in which the mode is a constant take half of it: what reads the text for WebGL
drops the rest.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from msgspec import Struct, field

from ...glsl.text import GlslFunction, parse

_HEAD = re.compile(r"(?P<result>[\w\s]+?)\b\w+\s*\((?P<parameters>[^()]*)\)\s*\{")
_CALL = re.compile(r"\b(?P<name>[A-Za-z_]\w*)\s*\(")
_CONSTANT = re.compile(r"\d+|true|false")
_CHANGED = (
    r"\b{0}\s*(?:(?:[-+*/%&|^]|<<|>>)?=(?!=)|\+\+|--)|(?:\+\+|--)\s*{0}\b"
    r"|\b(?:int|bool|uint|float|[iu]?vec[234])\s+{0}\b"
)
"""Where a parameter gets another value, or another variable its name."""

Constants = Mapping[str, str]


class _Function(Struct, frozen=True):
    """A function of a program, taken apart."""

    name: str
    result: str
    parameters: tuple[str, ...]
    body: str
    """What stands between its braces."""
    start: int
    end: int

    def find_constants(self, arguments: Sequence[str], known: Constants) -> dict[int, tuple[str, str]]:
        """Declarations of parameters that a call gives constants, with these, by their places."""
        constants: dict[int, tuple[str, str]] = {}
        for place, (argument, parameter) in enumerate(zip(arguments, self.parameters, strict=True)):
            constant = known.get(argument, argument)
            kind, _, name = parameter.partition(" ")
            if kind not in ("int", "bool") or not name.isidentifier() or not _CONSTANT.fullmatch(constant):
                continue
            if not re.search(_CHANGED.format(name), self.body):
                constants[place] = parameter, constant
        return constants


class _Copies(Struct):
    """The copies so far: of each function, in the order in which they must stand behind it."""

    functions: Mapping[tuple[str, int], _Function]
    """By name and number of parameters; not those of which there are several."""
    taken: set[str]
    names: dict[tuple[int, tuple[tuple[int, str], ...]], str] = field(default_factory=dict)
    texts: dict[int, list[str]] = field(default_factory=dict[int, list[str]])

    def rewrite(self, code: str, known: Constants) -> str:
        """Code with calls of copies, where some names are constants."""
        parts: list[str] = []
        at = 0
        for call in _CALL.finditer(code):
            if call.start() < at:
                continue
            end = _find_end(code, call.end() - 1)
            arguments = _split(code[call.end() : end - 1])
            function = self.functions.get((call["name"], len(arguments)))
            if function is None or not (constants := function.find_constants(arguments, known)):
                continue
            name = self._make_copy(function, constants)
            others = [self.rewrite(each, known) for place, each in enumerate(arguments) if place not in constants]
            parts += [code[at : call.start()], f"{name}({', '.join(others)})"]
            at = end
        return "".join(parts) + code[at:]

    def _make_copy(self, function: _Function, constants: Mapping[int, tuple[str, str]]) -> str:
        """The name of the copy of a function for some constants."""
        key = function.start, tuple((place, constant) for place, (_, constant) in constants.items())
        if key in self.names:
            return self.names[key]
        words = "_".join(constant for _, constant in constants.values())
        name = next(name for name in _list_names(f"{function.name.rstrip('_')}_at_{words}") if name not in self.taken)
        self.taken.add(name)
        self.names[key] = name
        known = {parameter.partition(" ")[2]: constant for parameter, constant in constants.values()}
        declared = "".join(f" const {parameter} = {constant};" for parameter, constant in constants.values())
        parameters = [each for place, each in enumerate(function.parameters) if place not in constants]
        body = self.rewrite(function.body, known)
        text = f"\n{function.result}{name}({', '.join(parameters)}) {{{declared}{body}}}"
        self.texts.setdefault(function.start, []).append(text)
        return name


def specialize_functions(text: str) -> str:
    """A program, GLSL 4.10, that calls copies of its functions for constants, without what it does not need."""
    parsed = parse("program", text)
    functions = [_take_apart(parsed.body, function) for function in parsed.all_functions]
    signatures = [(function.name, len(function.parameters)) for function in functions]
    single = {key: each for key, each in zip(signatures, functions, strict=True) if signatures.count(key) == 1}
    copies = _Copies(single, set(parsed.words))
    main = single["main", 0]
    changed_main = copies.rewrite(main.body, {})
    parts: list[str] = []
    at = 0
    for function in functions:
        parts.append(parsed.body[at : function.end])
        if function is main:
            parts[-1] = parts[-1].removesuffix(f"{main.body}}}") + changed_main + "}"
        parts += copies.texts.get(function.start, ())
        at = function.end
    return parse("program", "".join(parts) + parsed.body[at:]).keep_needed(frozenset({"main"})).body


def _take_apart(text: str, function: GlslFunction) -> _Function:
    head = _HEAD.match(text, function.start)
    assert head is not None
    parameters = tuple(" ".join(part.split()) for part in _split(head["parameters"]))
    body = text[head.end() : function.end - 1]
    return _Function(function.name, head["result"].lstrip(), parameters, body, function.start, function.end)


def _list_names(name: str) -> Iterator[str]:
    """The name, then others like it."""
    yield name
    yield from map(partial("{}_{}".format, name), range(1, 1 << 20))


def _find_end(code: str, opened: int) -> int:
    """The place behind the bracket that closes the one at `opened`."""
    depth = 0
    for at in range(opened, len(code)):
        depth += {"(": 1, ")": -1}.get(code[at], 0)
        if depth == 0:
            return at + 1
    return len(code)


def _split(arguments: str) -> list[str]:
    """Arguments between commas that stand in no brackets."""
    parts, depth, at = list[str](), 0, 0
    for place, letter in enumerate(arguments):
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append(arguments[at:place].strip())
            at = place + 1
    return [*parts, arguments[at:].strip()] if arguments.strip() else parts
