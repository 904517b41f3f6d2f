"""Parses an expression by precedence climbing (Richards 1979; Clarke 1986).

What a part of an expression becomes is up to the `PartMaker`: `evaluate` makes nested evaluators.

The operators from lowest to highest precedence; all are left-associative except ^ and ?: .

    c ? a : b    as in GLSL, so that `if` and `else` stay free as names
    or ||        and &&        not
    < <= > >= == !=            of two numbers
    + -          * / %         - + ! in front        ^ **        .x
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Generic, NoReturn, Protocol, TypeVar

from ..names import did_you_mean
from . import evaluate
from .evaluate import CHANNELS, Evaluator
from .fault import ExpressionError
from .functions import FUNCTIONS, OPERATORS, ExpressionFunction
from .tokens import MAX_LENGTH, Token

Part = TypeVar("Part")
"""What a part of an expression becomes."""

MAX_DEPTH = 64
"""The deepest nesting: a choice, far below the recursion limit of Python."""

_OR, _AND, _COMPARE, _SUM, _PRODUCT = 1, 2, 3, 4, 5
"""Levels of operators that have two operands: a higher one binds more tightly."""

_LEVELS = {
    "or": _OR,
    "||": _OR,
    "and": _AND,
    "&&": _AND,
    "+": _SUM,
    "-": _SUM,
    "*": _PRODUCT,
    "/": _PRODUCT,
    "%": _PRODUCT,
    **dict.fromkeys(evaluate.COMPARISONS, _COMPARE),
}
_CONSTANTS = {"pi": math.pi, "tau": math.tau, "e": math.e, "true": True, "false": False}
_CLOSING = {"(": ")", "[": "]"}
_PREFIXES = frozenset({"-", "+", "!", "not"})
_POWERS = frozenset({"^", "**"})

ParsedPart = tuple[Part, int]
"""A part, and how deep it is nested."""


class PartMaker(Protocol[Part]):
    """Makes the parts of an expression from smaller ones: see `evaluate` for what each is."""

    def make_constant(self, number: float | bool, /) -> Part: ...
    def make_variable(self, name: str, /) -> Part: ...
    def make_name(self, text: str, position: int, name: str, /) -> Part: ...
    def make_call(
        self, text: str, position: int, function: ExpressionFunction, arguments: Sequence[Part], /
    ) -> Part: ...
    def make_arithmetic(self, text: str, first: Part, steps: Sequence[tuple[str, int, Part]], /) -> Part: ...
    def make_comparison(self, text: str, left: Part, name: str, position: int, right: Part, /) -> Part: ...
    def make_logic(
        self, text: str, first: Part, steps: Sequence[tuple[str, int, Part]], /, *, any_of: bool
    ) -> Part: ...
    def make_negation(self, text: str, position: int, code: Part, /) -> Part: ...
    def make_sign(self, code: Part, /, *, minus: bool) -> Part: ...
    def make_choice(self, text: str, position: int, condition: Part, yes: Part, no: Part, /) -> Part: ...
    def make_channel(self, text: str, position: int, code: Part, name: str, /) -> Part: ...
    def make_list(self, text: str, position: int, codes: Sequence[Part], /) -> Part: ...


def parse_expression(text: str, tokens: Sequence[Token]) -> Evaluator:
    """The evaluator of an expression with these tokens. Raises ExpressionError."""
    return parse_parts(text, tokens, evaluate)


def parse_parts(text: str, tokens: Sequence[Token], maker: PartMaker[Part]) -> Part:
    """What `maker` makes of an expression with these tokens. Raises ExpressionError."""
    if len(text) > MAX_LENGTH:
        raise ExpressionError(text, MAX_LENGTH, f"the expression is longer than {MAX_LENGTH:,} characters")
    if not text.strip():
        raise ExpressionError(text, 0, "the expression is empty")
    return _Parser(text, tokens, maker).parse()


class _Parser(Generic[Part]):
    """A parser of one text."""

    def __init__(self, text: str, tokens: Sequence[Token], maker: PartMaker[Part]) -> None:
        self._text, self._maker = text, maker
        self._rest = iter((*tokens, Token("end", len(text), len(text), "")))
        self._next, self._depth = next(self._rest), 0

    def parse(self) -> Part:
        code, _ = self._parse_choice(self._next)
        if self._next.kind != "end":
            self._refuse_rest()
        return code

    def _take(self) -> Token:
        token = self._next
        self._next = next(self._rest, token)
        return token

    def _take_if(self, word: str) -> Token | None:
        """Take the next token if it is this operator or bracket; else None. No token of another kind has its text."""
        return self._take() if self._next.text == word else None

    def _fail(self, token: Token, sentence: str) -> NoReturn:
        raise ExpressionError(self._text, token.start, sentence)

    def _check_depth(self, token: Token, code: Part, parts: Sequence[ParsedPart[Part]]) -> ParsedPart[Part]:
        """A part with its depth, one more than that of its own parts. Raises ExpressionError if it is too deep."""
        depth = 1 + max([depth for _, depth in parts], default=0)
        if depth > MAX_DEPTH:
            self._fail(token, f"the expression is more than {MAX_DEPTH} levels deep")
        return code, depth

    def _enter(self, token: Token) -> None:
        """Enter a nested part. Raises ExpressionError if the nesting is too deep."""
        self._depth += 1
        if self._depth > MAX_DEPTH:
            self._fail(token, f"the expression is more than {MAX_DEPTH} levels deep")

    def _parse_choice(self, opening: Token) -> ParsedPart[Part]:
        self._enter(opening)
        condition = self._parse_binary(_OR)
        token = self._take_if("?")
        if token is None:
            self._depth -= 1
            return condition
        yes = self._parse_choice(token)
        if self._take_if(":") is None:
            self._fail(self._next, "':' is missing: write a choice as condition ? yes : no")
        no = self._parse_choice(token)
        self._depth -= 1
        code = self._maker.make_choice(self._text, token.start, condition[0], yes[0], no[0])
        return self._check_depth(token, code, (condition, yes, no))

    def _parse_binary(self, level: int) -> ParsedPart[Part]:
        """Operands joined by operators of this level or higher precedence."""
        part = self._parse_unary()
        while (next_level := self._next_level()) >= level:
            part = self._parse_chain(part, next_level)
        return part

    def _next_level(self) -> int:
        """The level of the next token if it is an operator, else 0."""
        return _LEVELS.get(self._next.text, 0)

    def _parse_chain(self, first: ParsedPart[Part], level: int) -> ParsedPart[Part]:
        """All operators of one level after an operand, as one part, so that long sums are not deep."""
        rest: list[tuple[Token, ParsedPart[Part]]] = []
        while self._next_level() == level:
            token = self._take()
            if level == _COMPARE and rest:
                self._fail(token, "only two numbers can be compared: write a < b and b < c")
            self._enter(token)
            rest.append((token, self._parse_binary(level + 1)))
            self._depth -= 1
        steps = [(token.text, token.start, part[0]) for token, part in rest]
        if level in (_OR, _AND):
            code = self._maker.make_logic(self._text, first[0], steps, any_of=level == _OR)
        elif level == _COMPARE:
            code = self._maker.make_comparison(self._text, first[0], *steps[0])
        else:
            code = self._maker.make_arithmetic(self._text, first[0], steps)
        return self._check_depth(rest[0][0], code, [first, *[part for _, part in rest]])

    def _parse_unary(self) -> ParsedPart[Part]:
        """A power, or an operand with a sign or a negation."""
        if self._next.text in _PREFIXES:
            return self._parse_prefix()
        base = self._parse_postfix()
        if self._next.text not in _POWERS:
            return base
        token = self._take()
        self._enter(token)
        power = self._parse_unary()
        self._depth -= 1
        code = self._maker.make_arithmetic(self._text, base[0], [("^", token.start, power[0])])
        return self._check_depth(token, code, (base, power))

    def _parse_prefix(self) -> ParsedPart[Part]:
        """A sign or a negation, and its operand."""
        token = self._take()
        self._enter(token)
        part = self._parse_binary(_COMPARE) if token.text == "not" else self._parse_unary()
        self._depth -= 1
        if token.text in ("-", "+"):
            code = self._maker.make_sign(part[0], minus=token.text == "-")
        else:
            code = self._maker.make_negation(self._text, token.start, part[0])
        return self._check_depth(token, code, (part,))

    def _parse_postfix(self) -> ParsedPart[Part]:
        part = self._parse_primary()
        while self._take_if("."):
            name = self._take()
            if name.text not in CHANNELS:
                self._fail(name, "a channel is missing: x, y, z, w or r, g, b, a")
            code = self._maker.make_channel(self._text, name.start, part[0], name.text)
            part = self._check_depth(name, code, (part,))
        return part

    def _parse_primary(self) -> ParsedPart[Part]:
        token = self._take()
        if token.kind == "number":
            number = float(token.text)
            if math.isinf(number):
                self._fail(token, f"{token.text} is too large")
            return self._maker.make_constant(number), 1
        if token.kind == "constant":
            return self._maker.make_constant(_CONSTANTS[token.text]), 1
        if token.kind == "variable":
            return self._maker.make_variable(token.text), 1
        if token.kind == "name":
            return self._maker.make_name(self._text, token.start, token.name), 1
        if token.kind == "function":
            return self._parse_call(token)
        if token.kind == "bracket" and token.text == "(":
            part = self._parse_choice(token)
            self._take_closing(token)
            return part
        if token.kind == "bracket" and token.text == "[":
            parts = self._parse_list(token)
            if not parts:
                self._fail(token, "a list must have at least one number")
            code = self._maker.make_list(self._text, token.start, [code for code, _ in parts])
            return self._check_depth(token, code, parts)
        return self._refuse(token)

    def _parse_call(self, token: Token) -> ParsedPart[Part]:
        function = FUNCTIONS.get(token.text)
        if function is None:
            self._fail(token, f"there is no function '{token.text}'{did_you_mean(token.text, FUNCTIONS)}")
        parts = self._parse_list(self._take())
        if len(parts) not in function.counts:
            self._fail(token, f"{function.name} does not take {len(parts)} values: write {function.signature}")
        code = self._maker.make_call(self._text, token.start, function, [code for code, _ in parts])
        return self._check_depth(token, code, parts)

    def _parse_list(self, opening: Token) -> list[ParsedPart[Part]]:
        """The expressions between brackets, separated by commas; the opening bracket is already taken."""
        parts: list[ParsedPart[Part]] = []
        if self._take_if(_CLOSING[opening.text]):
            return parts
        while True:
            parts.append(self._parse_choice(opening))
            if not self._take_if(","):
                self._take_closing(opening)
                return parts

    def _take_closing(self, opening: Token) -> None:
        if self._take_if(_CLOSING[opening.text]):
            return
        if self._next.kind == "end":
            self._fail(opening, f"'{opening.text}' is never closed")
        self._refuse_rest()

    def _refuse(self, token: Token) -> NoReturn:
        """Raise the error for a token where a value is expected."""
        if token.kind == "end":
            self._fail(token, "the expression ends too early: a value is missing")
        if token.kind == "unknown":
            self._fail(token, _describe_stray(token))
        self._fail(token, f"a value is missing before '{token.text}'")

    def _refuse_rest(self) -> NoReturn:
        """Raise the error for a token that cannot follow a value."""
        token = self._next
        if token.kind == "unknown":
            self._fail(token, _describe_stray(token))
        if token.text == "if":
            self._fail(token, "write a choice as condition ? yes : no")
        if token.text in (")", "]"):
            self._fail(token, f"'{token.text}' has no opening bracket")
        if token.kind == "operator" or token.text in (",", "else"):
            self._fail(token, f"'{token.text}' does not belong here")
        self._fail(token, f"an operator is missing before '{token.text}'; {' '.join(OPERATORS)} are some")


def _describe_stray(token: Token) -> str:
    """Why a character cannot be part of an expression."""
    if token.text == "=":
        return "'=' cannot be used in an expression: compare with =="
    if token.text == "`":
        return "the closing backquote is missing"
    if token.text[0] in "\"'":
        return "an expression cannot hold text, only numbers; write unusual names in backquotes"
    visible = token.text if token.text.isprintable() else f"U+{ord(token.text[0]):04X}"
    return f"'{visible}' cannot be part of an expression"
