"""Writes GLSL for a formula of the user, in the language of expressions (`halation.graph.expressions`).

Every number is a vec4 in GLSL, with the same number in all channels, so that numbers and lists combine as they do in
expressions. How many channels count is known here, and faults point at the character. What has no value is 0: a pixel
cannot stop the render.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from hashlib import blake2b
from typing import NoReturn

from msgspec import Struct

from ...errors import GraphError
from ...glsl import parse
from ...graph.expressions import Expression, ExpressionError
from ...graph.expressions.evaluate import CHANNELS
from ...graph.expressions.functions import ExpressionFunction
from ...resources.color_program import ColorProgram

_MAX_FORMULAS = 256
"""Formulas that are kept as GLSL: chosen by judgement, more than a user has open at once."""

_PLACES = {
    "x": "vec4(float(pixel.x) + 0.5)",
    "y": "vec4(float(pixel.y) + 0.5)",
    "u": "vec4((float(pixel.x) + 0.5) / float(extent.x))",
    "v": "vec4((float(pixel.y) + 0.5) / float(extent.y))",
    "width": "vec4(float(extent.x))",
    "height": "vec4(float(extent.y))",
}
"""What a formula knows of the place of a pixel, by name."""

_PICTURES = ("a", "b", "c", "d")
"""The names that are pixels of pictures; all others are numbers."""

_CLOCK = {"frame": "x", "time": "y", "rate": "z"}
_OPERATORS = {"+": "{} + {}", "-": "{} - {}", "*": "{} * {}"}
_CALLED_OPERATORS = {"/": "divide", "%": "mod", "^": "pow", "**": "pow"}
_RANDOM = ("noise", "random")


class FormulaPart(Struct, frozen=True):
    """The GLSL of a part of a formula, and how many channels of it count: 1 for a number."""

    code: str
    channels: int


class FormulaWriter:
    """Makes the parts of a formula; `names` are the pictures and numbers that it can read."""

    def __init__(self, names: tuple[str, ...]) -> None:
        self._names = names

    def make_constant(self, number: float | bool) -> FormulaPart:
        """A number."""
        return FormulaPart(f"vec4({float(number)!r})", 1)

    def make_variable(self, name: str) -> FormulaPart:
        """`frame`, `time` or `rate`."""
        return FormulaPart(f"vec4(clock.{_CLOCK[name]})", 1)

    def make_name(self, text: str, position: int, name: str) -> FormulaPart:
        """A picture, a number, or the place of the pixel."""
        head, _, channel = name.partition(".")
        if head in _PLACES and not channel:
            return FormulaPart(_PLACES[head], 1)
        if head not in self._names:
            offered = ", ".join((*self._names, *_PLACES))
            raise ExpressionError(text, position, f"'{head}' is not known in a formula for pixels; there are {offered}")
        part = FormulaPart(f"named_{head}", 4 if head in _PICTURES else 1)
        return self.make_channel(text, position, part, channel) if channel else part

    def make_call(
        self, text: str, position: int, function: ExpressionFunction, arguments: Sequence[FormulaPart]
    ) -> FormulaPart:
        """A call of a function."""
        if function.name in _RANDOM:
            raise ExpressionError(
                text, position, f"{function.name} cannot be used in a formula for pixels: link a noise node instead"
            )
        channels = self._combine(text, position, arguments)
        codes = [part.code for part in arguments]
        if function.name in ("min", "max"):
            joined = codes[0]
            for code in codes[1:]:
                joined = f"{function.name}({joined}, {code})"
            return FormulaPart(joined, channels)
        if function.name == "clamp" and len(codes) == 1:
            codes += ["vec4(0.0)", "vec4(1.0)"]
        return FormulaPart(f"formula_{function.name}({', '.join(codes)})", channels)

    def make_arithmetic(
        self, text: str, first: FormulaPart, steps: Sequence[tuple[str, int, FormulaPart]]
    ) -> FormulaPart:
        """Operators of one level, from left to right."""
        total = first
        for name, position, part in steps:
            channels = self._combine(text, position, (total, part))
            if name in _OPERATORS:
                code = f"({_OPERATORS[name].format(total.code, part.code)})"
            else:
                code = f"formula_{_CALLED_OPERATORS[name]}({total.code}, {part.code})"
            total = FormulaPart(code, channels)
        return total

    def make_comparison(
        self, text: str, left: FormulaPart, name: str, position: int, right: FormulaPart
    ) -> FormulaPart:
        """A comparison of two numbers."""
        if left.channels > 1 or right.channels > 1:
            raise ExpressionError(text, position, "lists cannot be compared: take a channel of each, such as .x")
        return FormulaPart(f"vec4(({left.code}).x {name} ({right.code}).x)", 1)

    def make_logic(
        self, text: str, first: FormulaPart, steps: Sequence[tuple[str, int, FormulaPart]], *, any_of: bool
    ) -> FormulaPart:
        """`or` (`any_of`) or `and`."""
        truths = [self._write_truth(text, steps[0][1], first)]
        truths += [self._write_truth(text, position, part) for _, position, part in steps]
        return FormulaPart(f"vec4({(' || ' if any_of else ' && ').join(truths)})", 1)

    def make_negation(self, text: str, position: int, code: FormulaPart) -> FormulaPart:
        """`not`."""
        return FormulaPart(f"vec4(!{self._write_truth(text, position, code)})", 1)

    def make_sign(self, code: FormulaPart, *, minus: bool) -> FormulaPart:
        """A sign in front."""
        return FormulaPart(f"(-{code.code})", code.channels) if minus else code

    def make_choice(
        self, text: str, position: int, condition: FormulaPart, yes: FormulaPart, no: FormulaPart
    ) -> FormulaPart:
        """One of two operands."""
        channels = self._combine(text, position, (yes, no))
        return FormulaPart(f"({self._write_truth(text, position, condition)} ? {yes.code} : {no.code})", channels)

    def make_channel(self, text: str, position: int, code: FormulaPart, name: str) -> FormulaPart:
        """A channel of a list."""
        if name not in CHANNELS:
            raise ExpressionError(
                text, position, f"there is no channel '{name}': x, y, z, w or r, g, b, a are channels"
            )
        if code.channels == 1 or CHANNELS[name] >= code.channels:
            kind = "a number" if code.channels == 1 else f"a list of {code.channels}"
            raise ExpressionError(text, position, f"{kind} has no channel '{name}'")
        return FormulaPart(f"vec4(({code.code}).{'xyzw'[CHANNELS[name]]})", 1)

    def make_list(self, text: str, position: int, codes: Sequence[FormulaPart]) -> FormulaPart:
        """A list of numbers."""
        if any(part.channels > 1 for part in codes):
            raise ExpressionError(text, position, "a list holds numbers, not lists")
        if not 2 <= len(codes) <= 4:
            raise ExpressionError(text, position, "a list of a formula for pixels has two to four numbers")
        numbers = [f"({part.code}).x" for part in codes] + ["0.0", "1.0"][len(codes) - 2 :]
        return FormulaPart(f"vec4({', '.join(numbers)})", len(codes))

    def _combine(self, text: str, position: int, parts: Sequence[FormulaPart]) -> int:
        """The channels of what is made of several parts. Raises ExpressionError for lists of different lengths."""
        lengths = sorted({part.channels for part in parts} - {1})
        if len(lengths) > 1:
            sentence = f"a list of {lengths[0]} and a list of {lengths[1]} numbers cannot be combined"
            raise ExpressionError(text, position, sentence)
        return lengths[0] if lengths else 1

    def _write_truth(self, text: str, position: int, part: FormulaPart) -> str:
        if part.channels > 1:
            raise ExpressionError(
                text, position, "a list is neither true nor false: compare a channel of it, such as .x"
            )
        return f"(({part.code}).x != 0.0)"


def reads_time(text: str) -> bool:
    """True for a formula that reads the frame or the time."""
    return any(token.kind == "variable" for token in Expression(text).tokens)


def write_formula(text: str, names: tuple[str, ...], owner: str) -> ColorProgram:
    """The GLSL of a formula: a function of the clock and of all names. Raises GraphError that names the node."""
    try:
        return _write_function(text, names)
    except ExpressionError as error:
        _refuse(owner, error)


@lru_cache(_MAX_FORMULAS)
def _write_function(text: str, names: tuple[str, ...]) -> ColorProgram:
    from ...graph.expressions.parser import parse_parts  # most graphs have no formula

    part = parse_parts(text, Expression(text).tokens, FormulaWriter(names))
    function = f"formula_{blake2b(repr((text, names)).encode(), digest_size=8).hexdigest()}"
    parameters = ["vec3 clock", *(f"{'vec4' if name in _PICTURES else 'float'} {name}" for name in names)]
    lines = [f"    vec4 named_{name} = formula_read({name});" for name in names]
    ending = f"formula_end({part.code}, {part.channels})"
    body = "\n".join([f"vec4 {function}({', '.join(parameters)}) {{", *lines, f"    return {ending};", "}"])
    return ColorProgram(function, parse(function, body, "the formula"), ())


def _refuse(owner: str, error: ExpressionError) -> NoReturn:
    raise GraphError(f"node '{owner}': {error}") from None
