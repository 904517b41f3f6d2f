"""What can be known of an expression without a driver: that it is a float, and often its number.

Names are not looked up where they are declared: a name is a float if all that the text declares under it are floats. So
`is_float` is true only where it is sure, and False says nothing.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from msgspec import Struct

from .constants import Number, combine, construct, is_float_number, negate, read_number, wrap
from .tokens import GlslToken

TYPE = re.compile(r"float|double|int|uint|bool|void|[iubd]?vec[234]|d?mat[234](?:x[234])?")
_FLOAT = re.compile(r"float|double|d?vec[234]|d?mat[234](?:x[234])?")
_SWIZZLE = re.compile(r"[xyzw]{1,4}|[rgba]{1,4}|[stpq]{1,4}")
_MIXED = frozenset({"abs", "sign", "min", "max", "clamp", "mix"})
"""Functions that return the type of what they are given."""

_FLOATS = frozenset(
    {
        "acos",
        "acosh",
        "asin",
        "asinh",
        "atan",
        "atanh",
        "ceil",
        "cos",
        "cosh",
        "cross",
        "dFdx",
        "dFdy",
        "degrees",
        "determinant",
        "distance",
        "dot",
        "exp",
        "exp2",
        "faceforward",
        "floor",
        "fma",
        "fract",
        "frexp",
        "fwidth",
        "intBitsToFloat",
        "inverse",
        "inversesqrt",
        "ldexp",
        "length",
        "log",
        "log2",
        "matrixCompMult",
        "mod",
        "modf",
        "normalize",
        "outerProduct",
        "pow",
        "radians",
        "reflect",
        "refract",
        "round",
        "roundEven",
        "sin",
        "sinh",
        "smoothstep",
        "sqrt",
        "step",
        "tan",
        "tanh",
        "transpose",
        "trunc",
        "uintBitsToFloat",
        "unpackHalf2x16",
        "unpackSnorm2x16",
        "unpackSnorm4x8",
        "unpackUnorm2x16",
        "unpackUnorm4x8",
    }
)
"""Functions that return floats, whatever they are given."""

_PREFIXES = frozenset({"-", "+", "!", "~", "++", "--"})
_ASSIGNMENTS = frozenset({"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="})
_PRECEDENCE: Mapping[str, int] = MappingProxyType(
    {
        **dict.fromkeys(("*", "/", "%"), 10),
        **dict.fromkeys(("+", "-"), 9),
        **dict.fromkeys(("<<", ">>"), 8),
        **dict.fromkeys(("<", ">", "<=", ">="), 7),
        **dict.fromkeys(("==", "!="), 6),
        "&": 5,
        "^": 4,
        "|": 3,
        "&&": 2,
        "^^": 1,
        "||": 1,
    }
)
_COMPONENTS = "xyzwrgbastpq"


class Operand(Struct, frozen=True):
    """What is known of an expression: whether it surely is a float, and its number if that is constant."""

    is_float: bool = False
    number: Number | None = None
    is_struct: bool = False


class Names(Struct, frozen=True):
    """The types that a text declares for each name, those that its functions return, and its constants."""

    types: Mapping[str, frozenset[str]]
    returns: Mapping[str, frozenset[str]]
    constants: Mapping[str, Number]

    def is_float(self, name: str) -> bool:
        """True for a variable or member that is a float wherever it is declared."""
        return _are_floats(self.types.get(name))

    def is_struct(self, name: str) -> bool:
        """True for a variable or member that has members wherever it is declared."""
        types = self.types.get(name)
        return bool(types) and not any(TYPE.fullmatch(glsl) for glsl in types or ())

    def returns_float(self, name: str) -> bool:
        """True for a function or constructor that surely returns floats."""
        if name in self.returns:
            return _are_floats(self.returns[name])
        return bool(_FLOAT.fullmatch(name)) or name in _FLOATS


def _are_floats(types: frozenset[str] | None) -> bool:
    return bool(types) and all(_FLOAT.fullmatch(glsl) for glsl in types or ())


def collect_names(tokens: Sequence[GlslToken], partners: Mapping[int, int], outside_types: Mapping[str, str]) -> Names:
    """The names that tokens declare; `outside_types` are those of names from elsewhere, such as `a` or `f()`.

    A type and a name, then a bracket: a function. A type, then names with commas between them: variables; a list ends
    where the next word is a type, for then it was one of parameters. A constant has a number only if its name is
    declared once, because names are not followed into their scopes.
    """
    types = {name: {glsl} for name, glsl in outside_types.items() if not name.endswith("()")}
    returns = {name[:-2]: {glsl} for name, glsl in outside_types.items() if name.endswith("()")}
    structs = {tokens[at + 1].text for at, token in enumerate(tokens[:-1]) if token.text == "struct"}
    declared: list[tuple[str, int, bool]] = []
    for at, token in enumerate(tokens):
        if not (TYPE.fullmatch(token.text) or token.text in structs) or (at and tokens[at - 1].text == "struct"):
            continue
        place = skip_lengths(tokens, partners, at + 1)
        constant = at > 0 and tokens[at - 1].text == "const"
        if place + 1 < len(tokens) and tokens[place].is_word and tokens[place + 1].text == "(":
            returns.setdefault(tokens[place].text, set()).add(token.text)
            continue
        while place < len(tokens) and tokens[place].is_word:
            types.setdefault(tokens[place].text, set()).add(token.text)
            declared.append((tokens[place].text, place, constant))
            place = _skip_initializer(tokens, partners, place + 1)
            if place + 1 >= len(tokens) or tokens[place].text != "," or tokens[place + 1].text in structs:
                break
            place += 1
            if TYPE.fullmatch(tokens[place].text) or (place + 1 < len(tokens) and tokens[place + 1].is_word):
                break
    names = Names(
        {name: frozenset(kinds) for name, kinds in types.items()},
        {name: frozenset(kinds) for name, kinds in returns.items()},
        constants := {},
    )
    counts = dict[str, int]()
    for name, _, _ in declared:
        counts[name] = counts.get(name, 0) + 1
    reader = OperandReader(tokens, partners, names)
    for name, place, constant in declared:
        if constant and counts[name] == 1 and tokens[place + 1].text == "=":
            number = reader.read(place + 2, _skip_initializer(tokens, partners, place + 1)).number
            if number is not None:
                constants[name] = number
    return names


def skip_lengths(tokens: Sequence[GlslToken], partners: Mapping[int, int], at: int) -> int:
    """The place after the square brackets that begin at a place and are closed."""
    while at < len(tokens) and tokens[at].text == "[" and at in partners:
        at = partners[at] + 1
    return at


def _skip_initializer(tokens: Sequence[GlslToken], partners: Mapping[int, int], at: int) -> int:
    """The comma, semicolon or bracket that ends a declarator."""
    while at < len(tokens) and tokens[at].text not in (",", ";", ")", "]", "}"):
        at = partners.get(at, at) + 1
    return at


class OperandReader:
    """Reads expressions: ranges of tokens whose brackets match."""

    def __init__(self, tokens: Sequence[GlslToken], partners: Mapping[int, int], names: Names) -> None:
        self._tokens, self._partners, self._names = tokens, partners, names
        self._at = self._end = 0

    def read(self, start: int, end: int) -> Operand:
        """What is known of the expression between two places."""
        before = self._at, self._end
        self._at, self._end = start, end
        try:
            operand = self._read_sequence()
            return operand if self._at >= end else Operand()
        except (RecursionError, IndexError, KeyError, ArithmeticError, ValueError):
            return Operand()
        finally:
            self._at, self._end = before

    def _peek(self) -> str:
        return self._tokens[self._at].text if self._at < self._end else ""

    def _read_sequence(self) -> Operand:
        operand = self._read_assignment()
        while self._peek() == ",":
            self._at += 1
            operand = self._read_assignment()
        return operand

    def _read_assignment(self) -> Operand:
        left = self._read_binary(0)
        if self._peek() == "?":
            self._at += 1
            first = self._read_assignment()
            if self._peek() != ":":
                raise ValueError
            self._at += 1
            second = self._read_assignment()
            number = None
            if isinstance(left.number, int):
                number = first.number if left.number else second.number
            return Operand(first.is_float or second.is_float, number)
        if self._peek() in _ASSIGNMENTS:
            self._at += 1
            right = self._read_assignment()
            return Operand(left.is_float or right.is_float)
        return left

    def _read_binary(self, lowest: int) -> Operand:
        left = self._read_unary()
        while (level := _PRECEDENCE.get(sign := self._peek(), -1)) > lowest:
            self._at += 1
            right = self._read_binary(level)
            floats = level >= 9 and (left.is_float or right.is_float)
            left = Operand(floats, combine(sign, left.number, right.number))
        return left

    def _read_unary(self) -> Operand:
        signs: list[str] = []
        while self._peek() in _PREFIXES:
            signs.append(self._peek())
            self._at += 1
        operand = self._read_postfix()
        for sign in reversed(signs):
            number = operand.number
            if number is not None and sign == "-":
                number = tuple(wrap(-part) for part in number) if isinstance(number, tuple) else negate(number)
            elif sign == "~" and isinstance(number, int):
                number = ~number
            elif sign != "+":
                number = None
            operand = Operand(operand.is_float, number)
        return operand

    def _read_postfix(self) -> Operand:
        token = self._tokens[self._at]
        if self._at >= self._end:
            raise ValueError
        self._at += 1
        if token.text == "(":
            operand = self._read_brackets(self._at - 1)
        elif token.is_number:
            operand = Operand(is_float_number(token.text), read_number(token.text))
        elif token.is_word and self._peek() == "(":
            operand = self._read_call(token.text)
        elif token.is_word:
            if token.text in ("true", "false"):
                return Operand(False, int(token.text == "true"))
            name = token.text
            constant = self._names.constants.get(name)
            operand = Operand(self._names.is_float(name), constant, self._names.is_struct(name))
        else:
            raise ValueError
        while self._peek() in (".", "[", "(", "++", "--"):
            operand = self._read_selection(operand, self._peek())
        return operand

    def _read_brackets(self, opened: int) -> Operand:
        """What stands in brackets."""
        closed = self._partners[opened]
        operand = self.read(opened + 1, closed)
        self._at = closed + 1
        return operand

    def _read_call(self, name: str) -> Operand:
        opened, closed = self._at, self._partners[self._at]
        self._at = closed + 1
        arguments = [self.read(start, end) for start, end in self._split_arguments(opened, closed)]
        floats = self._names.returns_float(name) or (
            name in _MIXED and any(argument.is_float for argument in arguments)
        )
        return Operand(
            floats,
            None if name in self._names.returns else construct(name, [argument.number for argument in arguments]),
        )

    def _split_arguments(self, opened: int, closed: int) -> list[tuple[int, int]]:
        """The arguments between brackets."""
        parts, start, at = list[tuple[int, int]](), opened + 1, opened + 1
        while at < closed:
            if self._tokens[at].text == ",":
                parts.append((start, at))
                start = at + 1
            at = self._partners.get(at, at) + 1
        return [*parts, (start, closed)] if closed > opened + 1 else []

    def _read_selection(self, operand: Operand, sign: str) -> Operand:
        if sign == ".":
            name = self._tokens[self._at + 1].text
            self._at += 2
            if self._peek() == "(":  # the length of an array
                self._at = self._partners[self._at] + 1
                return Operand()
            swizzle = not operand.is_struct and _SWIZZLE.fullmatch(name)
            floats = operand.is_float if swizzle else self._names.is_float(name)
            if swizzle and isinstance(operand.number, tuple):
                parts = tuple(operand.number[_COMPONENTS.index(letter) % 4] for letter in name)
                return Operand(floats, parts[0] if len(parts) == 1 else parts)
            return Operand(floats, None, not swizzle and self._names.is_struct(name))
        if sign in ("++", "--"):
            self._at += 1
            return Operand(operand.is_float)
        self._at = self._partners[self._at] + 1
        return Operand(operand.is_float, None, operand.is_struct)
