"""Reads an expression into code: functions of ours, one inside the other, and nothing else.

Precedence climbing (Richards 1979; Clarke 1986). From loosest to tightest, all from left to right but ^ and ?: :

    c ? a : b    as in GLSL, so that conditions come first and no word is lost to names
    or ||        and &&        not
    < <= > >= == !=            of two numbers
    + -          * / %         - + ! in front        ^ **        .x
"""

from __future__ import annotations

import math
from typing import NoReturn

from ..names import did_you_mean
from . import evaluate
from .evaluate import CHANNELS, Code
from .fault import ExpressionError
from .functions import FUNCTIONS, OPERATORS
from .tokens import Token, tokens

MAX_LENGTH = 1000
"""Characters of an expression."""

MAX_DEPTH = 64
"""How far parts of an expression can be inside one another."""

_OR, _AND, _COMPARE, _SUM, _PRODUCT = 1, 2, 3, 4, 5

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

Part = tuple[Code, int]
"""Code, and how deep it is."""


def parsed(text: str) -> Code:
    """The code of an expression. Raises ExpressionError."""
    if len(text) > MAX_LENGTH:
        raise ExpressionError(text, MAX_LENGTH, f"the expression is longer than {MAX_LENGTH:,} characters")
    if not text.strip():
        raise ExpressionError(text, 0, "the expression is empty")
    return _Parser(text).all()


class _Parser:
    """One reading of one text."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._tokens = [*tokens(text), Token("end", len(text), len(text), "")]
        self._place = self._depth = 0

    def all(self) -> Code:
        code, _ = self._expression(self._next)
        if self._next.kind != "end":
            self._refuse_rest()
        return code

    @property
    def _next(self) -> Token:
        return self._tokens[self._place]

    def _take(self) -> Token:
        token = self._next
        self._place += 1
        return token

    def _taken(self, *words: str) -> Token | None:
        """The next token if it is one of these words of ours."""
        token = self._next
        return self._take() if token.kind in ("operator", "bracket", "word") and token.text in words else None

    def _fail(self, token: Token, sentence: str) -> NoReturn:
        raise ExpressionError(self._text, token.start, sentence)

    def _made(self, token: Token, code: Code, *parts: Part) -> Part:
        """Code around other parts."""
        depth = 1 + max((depth for _, depth in parts), default=0)
        if depth > MAX_DEPTH:
            self._fail(token, f"the expression is more than {MAX_DEPTH} levels deep")
        return code, depth

    def _enter(self, token: Token) -> None:
        """Begin a part within another: readers that call themselves count how deep they are."""
        self._depth += 1
        if self._depth > MAX_DEPTH:
            self._fail(token, f"the expression is more than {MAX_DEPTH} levels deep")

    def _expression(self, opening: Token) -> Part:
        self._enter(opening)
        condition = self._binary(_OR)
        token = self._taken("?")
        if token is None:
            self._depth -= 1
            return condition
        yes = self._expression(token)
        if self._taken(":") is None:
            self._fail(self._next, "':' is missing: a choice is written condition ? yes : no")
        no = self._expression(token)
        self._depth -= 1
        code = evaluate.choice(self._text, token.start, condition[0], yes[0], no[0])
        return self._made(token, code, condition, yes, no)

    def _binary(self, level: int) -> Part:
        """Operands with operators of that level and tighter ones between them."""
        part = self._unary()
        while (found := self._level()) >= level:
            part = self._chain(part, found)
        return part

    def _level(self) -> int:
        """The level of the operator that comes next, or 0."""
        return _LEVELS.get(self._next.text, 0) if self._next.kind in ("operator", "word") else 0

    def _chain(self, first: Part, level: int) -> Part:
        """All that follows at one level; an operator that follows one operand is no deeper than the next."""
        rest: list[tuple[Token, Part]] = []
        while self._level() == level:
            token = self._take()
            if level == _COMPARE and rest:
                self._fail(token, "only two numbers can be compared: write a < b and b < c")
            self._enter(token)
            rest.append((token, self._binary(level + 1)))
            self._depth -= 1
        steps = [(token.text, token.start, part[0]) for token, part in rest]
        if level in (_OR, _AND):
            code = evaluate.logic(self._text, first[0], steps, any_of=level == _OR)
        elif level == _COMPARE:
            code = evaluate.comparison(self._text, first[0], *steps[0])
        else:
            code = evaluate.arithmetic(self._text, first[0], steps)
        return self._made(rest[0][0], code, first, *(part for _, part in rest))

    def _unary(self) -> Part:
        """A power, or what has a sign or a negation in front."""
        token = self._taken("-", "+", "!", "not")
        if token is None:
            base = self._postfix()
            token = self._taken("^", "**")
            if token is None:
                return base
            self._enter(token)
            power = self._unary()
            self._depth -= 1
            code = evaluate.arithmetic(self._text, base[0], [("^", token.start, power[0])])
            return self._made(token, code, base, power)
        self._enter(token)
        part = self._binary(_COMPARE) if token.text == "not" else self._unary()
        self._depth -= 1
        if token.text in ("-", "+"):
            code = evaluate.signed(part[0], minus=token.text == "-")
        else:
            code = evaluate.negation(self._text, token.start, part[0])
        return self._made(token, code, part)

    def _postfix(self) -> Part:
        part = self._primary()
        while self._taken("."):
            name = self._take()
            if name.text not in CHANNELS:
                self._fail(name, "a channel is missing: x, y, z, w or r, g, b, a")
            part = self._made(name, evaluate.channel(self._text, name.start, part[0], name.text), part)
        return part

    def _primary(self) -> Part:
        token = self._take()
        if token.kind == "number":
            number = float(token.text)
            if math.isinf(number):
                self._fail(token, f"{token.text} is too large")
            return self._made(token, evaluate.constant(number))
        if token.kind == "constant":
            return self._made(token, evaluate.constant(_CONSTANTS[token.text]))
        if token.kind == "variable":
            return self._made(token, evaluate.variable(token.text))
        if token.kind == "name":
            return self._made(token, evaluate.named(self._text, token.start, token.name))
        if token.kind == "function":
            return self._call(token)
        if token.kind == "bracket" and token.text == "(":
            part = self._expression(token)
            self._close(token)
            return part
        if token.kind == "bracket" and token.text == "[":
            parts = self._list(token)
            if not parts:
                self._fail(token, "a list has at least one number")
            return self._made(token, evaluate.listed(self._text, token.start, [code for code, _ in parts]), *parts)
        return self._refuse(token)

    def _call(self, token: Token) -> Part:
        function = FUNCTIONS.get(token.text)
        if function is None:
            self._fail(token, f"there is no function '{token.text}'{did_you_mean(token.text, FUNCTIONS)}")
        parts = self._list(self._take())
        if len(parts) not in function.counts:
            self._fail(token, f"{function.name} does not take {len(parts)} values: write {function.signature}")
        code = evaluate.call(self._text, token.start, function, [code for code, _ in parts])
        return self._made(token, code, *parts)

    def _list(self, opening: Token) -> list[Part]:
        """What stands between brackets, commas between; the bracket that opens is behind."""
        parts: list[Part] = []
        if self._taken(_CLOSING[opening.text]):
            return parts
        while True:
            parts.append(self._expression(opening))
            if not self._taken(","):
                self._close(opening)
                return parts

    def _close(self, opening: Token) -> None:
        if self._taken(_CLOSING[opening.text]):
            return
        if self._next.kind == "end":
            self._fail(opening, f"'{opening.text}' is never closed")
        self._refuse_rest()

    def _refuse(self, token: Token) -> NoReturn:
        """Say what is wrong with a token where a value was expected."""
        if token.kind == "end":
            self._fail(token, "the expression ends too early: a value is missing")
        if token.kind == "unknown":
            self._fail(token, _stray(token))
        self._fail(token, f"a value is missing before '{token.text}'")

    def _refuse_rest(self) -> NoReturn:
        """Say what is wrong with a token that follows a value."""
        token = self._next
        if token.kind == "unknown":
            self._fail(token, _stray(token))
        if token.text == "if":
            self._fail(token, "a choice is written condition ? yes : no")
        if token.text in (")", "]"):
            self._fail(token, f"'{token.text}' closes nothing")
        if token.kind == "operator" or token.text in (",", "else"):
            self._fail(token, f"'{token.text}' does not belong here")
        self._fail(token, f"an operator is missing before '{token.text}'; {' '.join(OPERATORS)} are some")


def _stray(token: Token) -> str:
    """Why a character is no part of an expression."""
    if token.text == "=":
        return "'=' sets nothing here: compare with =="
    if token.text == "`":
        return "a quoted name has no end"
    if token.text[0] in "\"'":
        return "an expression knows no text, only numbers; odd names are put in backquotes"
    shown = token.text if token.text.isprintable() else f"U+{ord(token.text[0]):04X}"
    return f"'{shown}' is no part of an expression"
