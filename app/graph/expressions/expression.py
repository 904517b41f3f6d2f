"""A value as a formula of time and of other values."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from halation.nodes import Plain
from msgspec import Struct

from .fault import ExpressionError

if TYPE_CHECKING:
    from .evaluate import Code
    from .tokens import Token


class Expression(Struct, frozen=True, dict=True):
    """A text such as `0.5 + 0.1 * sin(time * tau)` or `glow * move.offset.x`. It is read once, when first needed.

    Beside arithmetic it knows `frame`, `time` in seconds, `rate` in frames per second, FUNCTIONS, and other values: a
    control by its name, a value of a node as `node.value`, a channel of it as `node.value.x`. Odd names stand in
    backquotes. Every number on the way is finite: what has no value is an error, which points at the character.
    """

    text: str

    def at(self, frame: float, time: float, rate: float, value: Callable[[str], Plain]) -> Plain:
        """The value at a time; `value` gives that of a name. Raises ExpressionError, and what `value` raises."""
        from .evaluate import Scope

        code = self._code
        if isinstance(code, ExpressionError):
            raise ExpressionError(code.text, code.position, code.sentence)
        return code(Scope(float(frame), float(time), float(rate), value))

    @property
    def fault(self) -> ExpressionError | None:
        """Why the text cannot be read."""
        return self._code if isinstance(self._code, ExpressionError) else None

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """The words of the text, for an editor to color; also of one that cannot be read. None if it is too long."""
        from .parser import MAX_LENGTH
        from .tokens import tokens

        return tuple(tokens(self.text)) if len(self.text) <= MAX_LENGTH else ()

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Every other value that it reads, in order, each once."""
        return tuple(dict.fromkeys(token.name for token in self.tokens if token.kind == "name"))

    def rename(self, old: str, new: str) -> Expression:
        """With another name of a node, of a control, or of a value as `node.value`; nothing else changes."""
        from .tokens import segments, write_name

        text, end = "", 0
        for token in self.tokens:
            if token.kind == "name" and (token.name == old or token.name.startswith(f"{old}.")):
                rest = ".".join([new, *segments(token.text)[old.count(".") + 1 :]])
                text, end = text + self.text[end : token.start] + write_name(rest), token.end
        return Expression(text + self.text[end:])

    def blame_name(self, name: str, sentence: str) -> ExpressionError:
        """An error that points at where the text first reads that name."""
        found = (token.start for token in self.tokens if token.kind == "name" and token.name == name)
        return ExpressionError(self.text, next(found, 0), sentence)

    @cached_property
    def _code(self) -> Code | ExpressionError:
        from .parser import parsed

        try:
            return parsed(self.text)
        except ExpressionError as error:
            return error.with_traceback(None)

    def __reduce__(self) -> tuple[type[Expression], tuple[str]]:
        return Expression, (self.text,)
