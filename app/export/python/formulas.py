"""Writes numpy text for a formula of the user, in the language of expressions (`halation.graph.expressions`).

A number is a float or an Array with one channel, a list an Array with two to four.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from msgspec import Struct

from ...compiler.lowering.formulas import FormulaPart, FormulaWriter
from ...errors import GraphError
from ...graph.expressions import Expression, ExpressionError
from ...graph.expressions.evaluate import CHANNELS
from ...graph.expressions.functions import ExpressionFunction
from ...graph.expressions.parser import parse_parts

PICTURES, NUMBERS = ("a", "b", "c", "d"), ("p", "q", "r", "s")
PLACES = ("x", "y", "u", "v", "width", "height")
_NUMPY: Mapping[str, str] = MappingProxyType(
    {name: f"np.{name}" for name in ("sin", "cos", "tan", "exp", "abs", "sign", "floor", "ceil", "degrees", "radians")}
    | {"atan": "np.arctan", "clamp": "np.clip", "mix": "mix"}
)
"""Functions of expressions that numpy has, or that scripts have for other nodes."""

_OPERATORS: Mapping[str, str] = MappingProxyType({"/": "divide", "%": "mod", "^": "pow", "**": "pow"})


class FunctionText(Struct, frozen=True):
    """A function as text, and the functions of the library that it calls."""

    text: str
    helpers: frozenset[str]


def write_formula_text(text: str, owner: str) -> FunctionText:
    """A formula as a lambda of the names that it reads. Raises GraphError."""
    writer = _NumpyWriter((*PICTURES, *NUMBERS), owner)
    try:
        part = parse_parts(text, Expression(text).tokens, writer)
    except ExpressionError as fault:
        raise GraphError(f"node '{owner}': {fault}", node=owner) from None
    names = [name for name in (*PICTURES, *NUMBERS, *PLACES) if name in writer.read]
    return FunctionText(f"lambda {', '.join([*names, '**_'])}: {part.code}", frozenset(writer.helpers))


class _NumpyWriter(FormulaWriter):
    """Makes text of Python in place of GLSL; what may be combined is the same."""

    def __init__(self, names: tuple[str, ...], owner: str) -> None:
        super().__init__(names)
        self._owner = owner
        self.read, self.helpers = set[str](), set[str]()

    def make_constant(self, number: float | bool) -> FormulaPart:
        return FormulaPart(repr(float(number)), 1)

    def make_variable(self, name: str) -> FormulaPart:
        sentence = (
            f"the numpy text for 'pixel_formula' does not know '{name}': use another node, or write it with --to glsl"
        )
        raise GraphError(f"node '{self._owner}': {sentence}", node=self._owner)

    def make_name(self, text: str, position: int, name: str) -> FormulaPart:
        part = super().make_name(text, position, name)  # refuses what is unknown
        head, _, channel = name.partition(".")
        self.read.add(head)
        return FormulaPart(self._take_channel(head, channel), 1) if channel else FormulaPart(head, part.channels)

    def make_call(
        self, text: str, position: int, function: ExpressionFunction, arguments: Sequence[FormulaPart]
    ) -> FormulaPart:
        channels = super().make_call(text, position, function, arguments).channels
        codes = [part.code for part in arguments]
        if function.name in ("min", "max"):
            joined = codes[0]
            for code in codes[1:]:
                joined = f"np.{function.name}imum({joined}, {code})"
            return FormulaPart(joined, channels)
        if function.name == "clamp" and len(codes) == 1:
            codes += ["0.0", "1.0"]
        return FormulaPart(f"{self._find_helper(function.name)}({', '.join(codes)})", channels)

    def make_arithmetic(
        self, text: str, first: FormulaPart, steps: Sequence[tuple[str, int, FormulaPart]]
    ) -> FormulaPart:
        total = first
        for name, position, part in steps:
            channels = self._combine(text, position, (total, part))
            if name in _OPERATORS:
                code = f"{self._find_helper(_OPERATORS[name])}({total.code}, {part.code})"
            else:
                code = f"({total.code} {name} {part.code})"
            total = FormulaPart(code, channels)
        return total

    def make_comparison(
        self, text: str, left: FormulaPart, name: str, position: int, right: FormulaPart
    ) -> FormulaPart:
        super().make_comparison(text, left, name, position, right)
        return FormulaPart(f"(({left.code} {name} {right.code}) * 1.0)", 1)

    def make_logic(
        self, text: str, first: FormulaPart, steps: Sequence[tuple[str, int, FormulaPart]], *, any_of: bool
    ) -> FormulaPart:
        super().make_logic(text, first, steps, any_of=any_of)
        parts = [first, *(part for _, _, part in steps)]
        truths = (" | " if any_of else " & ").join(f"({part.code} != 0.0)" for part in parts)
        return FormulaPart(f"(({truths}) * 1.0)", 1)

    def make_negation(self, text: str, position: int, code: FormulaPart) -> FormulaPart:
        super().make_negation(text, position, code)
        return FormulaPart(f"(({code.code} == 0.0) * 1.0)", 1)

    def make_choice(
        self, text: str, position: int, condition: FormulaPart, yes: FormulaPart, no: FormulaPart
    ) -> FormulaPart:
        channels = super().make_choice(text, position, condition, yes, no).channels
        return FormulaPart(f"np.where({condition.code} != 0.0, {yes.code}, {no.code})", channels)

    def make_channel(self, text: str, position: int, code: FormulaPart, name: str) -> FormulaPart:
        super().make_channel(text, position, code, name)
        return FormulaPart(self._take_channel(code.code, name), 1)

    def make_list(self, text: str, position: int, codes: Sequence[FormulaPart]) -> FormulaPart:
        super().make_list(text, position, codes)
        self.helpers.add("formula_list")
        return FormulaPart(f"formula_list({', '.join(part.code for part in codes)})", len(codes))

    def _take_channel(self, code: str, name: str) -> str:
        place = CHANNELS[name]
        return f"{code}[..., {place}:{place + 1}]"

    def _find_helper(self, name: str) -> str:
        known = _NUMPY.get(name, f"formula_{name}")
        if not known.startswith("np."):
            self.helpers.add(known)
        return known
