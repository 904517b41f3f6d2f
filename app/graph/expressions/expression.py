"""The expression of a value."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, cached_property
from typing import TYPE_CHECKING

from halation.nodes import Scalar
from msgspec import Struct

from .fault import ExpressionError

if TYPE_CHECKING:
    from .evaluate import Evaluator, Scope
    from .tokens import Token


class Expression(Struct, frozen=True, dict=True):
    """A formula such as `0.5 + 0.1 * sin(time * tau)` or `glow * move.offset.x`. It is parsed once, when first needed.

    Besides arithmetic it can use `frame`, `time` in seconds, `rate` in frames per second, FUNCTIONS, and other values:
    a control by its name, a value of a node as `node.value`, a channel of it as `node.value.x`. A name that is not an
    identifier is written in backquotes. A result that is not finite is an error that points at the character.
    """

    text: str

    def evaluate(self, frame: float, time: float, rate: float, value: Callable[[str], Scalar]) -> Scalar:
        """The result at a time; `value` returns that of a name. Raises ExpressionError, and what `value` raises."""
        evaluator = self._evaluator
        if isinstance(evaluator, ExpressionError):
            raise ExpressionError(evaluator.text, evaluator.position, evaluator.sentence)
        return evaluator(_load_scope()(float(frame), float(time), float(rate), value))

    @property
    def fault(self) -> ExpressionError | None:
        """Why the text cannot be parsed, or None."""
        return self._evaluator if isinstance(self._evaluator, ExpressionError) else None

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """The tokens of the text, also of one that cannot be parsed, for syntax coloring. Empty if it is too long."""
        return tuple(_load_tokenizer()(self.text))

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names of other values that it reads, in order, without repetitions."""
        return tuple(dict.fromkeys(token.name for token in self.tokens if token.kind == "name"))

    def rename(self, old: str, new: str) -> Expression:
        """The expression after a node, a control, or a value `node.value` is renamed; the rest of the text stays."""
        from .tokens import split_name, write_name

        text, end = "", 0
        for token in self.tokens:
            if token.kind == "name" and (token.name == old or token.name.startswith(f"{old}.")):
                rest = ".".join([new, *split_name(token.text)[old.count(".") + 1 :]])
                text, end = text + self.text[end : token.start] + write_name(rest), token.end
        return Expression(text + self.text[end:])

    def blame_name(self, name: str, sentence: str) -> ExpressionError:
        """An error that points at the first use of a name."""
        starts = (token.start for token in self.tokens if token.kind == "name" and token.name == name)
        return ExpressionError(self.text, next(starts, 0), sentence)

    @cached_property
    def _evaluator(self) -> Evaluator | ExpressionError:
        try:
            return _load_parser()(self.text, self.tokens)
        except ExpressionError as error:
            return error.with_traceback(None)

    def __reduce__(self) -> tuple[type[Expression], tuple[str]]:
        return Expression, (self.text,)


@cache
def _load_tokenizer() -> Callable[[str], list[Token]]:
    from .tokens import tokenize

    return tokenize


@cache
def _load_parser() -> Callable[[str, tuple[Token, ...]], Evaluator]:
    from .parser import parse_expression

    return parse_expression


@cache
def _load_scope() -> type[Scope]:
    from .evaluate import Scope

    return Scope
