"""Small faults that a program may have, each a text that replaces another: the mutants of a file.

Python is read as a syntax tree, so that only what runs is changed: no annotations, no texts, no `__all__`, no branches
for type checkers. GLSL is read as tokens without comments and directives. A mutant changes one place: an operator, a
number, a condition, an order of two arguments, the call of a statement.

Some mutants change nothing that anybody can see (`<` for `<=` where both agree, the size of a cache). Whoever reads the
survivors decides; a score of 100 % is not what is wanted.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

OPERATORS = {
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.FloorDiv: "*", ast.Mod: "*", ast.Pow: "*",
    ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "==", ast.Is: "is not",
    ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in", ast.And: "or", ast.Or: "and", ast.BitAnd: "|", ast.BitOr: "&",
}  # fmt: skip
"""Operator -> the one that stands in its place."""

PAIRS = {"min": "max", "max": "min", "any": "all", "all": "any", "floor": "ceil", "ceil": "floor"}
"""Functions of Python that change places."""

GLSL = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==",
    "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "min": "max", "max": "min", "sin": "cos", "cos": "sin",
    "floor": "ceil", "ceil": "floor", "true": "false", "false": "true",
}  # fmt: skip
"""Token of GLSL -> the one that stands in its place."""

COMMUTATIVE = {"add", "multiply", "maximum", "minimum", "hypot", "dist", "gcd", "logical_and", "logical_or",
               "equal", "isclose"}  # fmt: skip
"""Functions of numpy and math whose two arguments may change places."""

_TOKEN = re.compile(r"\d+\.\d*(?:[eE][-+]?\d+)?|\.?\d+(?:[eE][-+]?\d+)?|\w+|&&|\|\||[-+*/<>=!]=|<<|>>|\S")
_IGNORED = re.compile(r"//[^\n]*|/\*.*?\*/|^[ \t]*#(?:[^\n\\]|\\.|\\\n)*|\blayout\s*\(.*?\)", re.S | re.M)


@dataclass(frozen=True)
class Mutant:
    """A place of a file and what stands there instead."""

    path: Path
    start: int
    end: int
    text: str

    def apply(self, source: str) -> str:
        """The text of the file with the fault."""
        return source[: self.start] + self.text + source[self.end :]

    def describe(self, source: str) -> str:
        """The line and both texts, for a list of survivors."""
        line = source.count("\n", 0, self.start) + 1
        return f"{self.path}:{line}: {source[self.start : self.end]!r} -> {self.text!r}"


def list_mutants(path: Path, source: str) -> tuple[Mutant, ...]:
    """All mutants of a file, in its order."""
    places = _read_glsl(source) if path.suffix == ".glsl" else _PythonReader(source).read()
    return tuple(Mutant(path, *place) for place in sorted(set(places)) if source[place[0] : place[1]] != place[2])


def _read_glsl(source: str) -> Iterator[tuple[int, int, str]]:
    code = _IGNORED.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source)
    for match in _TOKEN.finditer(code):
        token = match[0]
        if token in GLSL:
            yield (*match.span(), GLSL[token])
        elif re.fullmatch(r"\d*\.\d*(?:[eE][-+]?\d+)?", token) and token != ".":
            yield (*match.span(), "1.0" if float(token) == 0.0 else f"{2.0 * float(token)!r}")


class _PythonReader:
    def __init__(self, source: str) -> None:
        self._source = source
        self._lines = [0]
        for line in source.splitlines(keepends=True):
            self._lines.append(self._lines[-1] + len(line))
        self._places: list[tuple[int, int, str]] = []

    def read(self) -> list[tuple[int, int, str]]:
        self._visit(ast.parse(self._source))
        return self._places

    def _visit(self, node: ast.AST) -> None:
        if isinstance(node, ast.JoinedStr):  # Python 3.11 does not say where its parts are
            return
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            return
        if isinstance(node, ast.Assign) and any(isinstance(at, ast.Name) and at.id == "__all__" for at in node.targets):
            return
        if (method := getattr(self, f"_read_{type(node).__name__.lower()}", None)) is not None:
            method(node)
        for name, field in ast.iter_fields(node):
            if name in ("annotation", "returns", "decorator_list", "type_params"):
                continue
            if isinstance(node, ast.ClassDef) and name == "keywords":
                continue
            for child in field if isinstance(field, list) else [field]:
                if isinstance(child, ast.AST):
                    self._visit(child)

    def _read_binop(self, node: ast.BinOp) -> None:
        # A text that is formatted, and types that are joined, are no arithmetic.
        texts = (ast.JoinedStr, ast.Constant)
        if isinstance(node.left, texts) and not isinstance(getattr(node.left, "value", ""), int | float):
            return
        self._replace_between(node.left, node.right, node.op)

    def _read_compare(self, node: ast.Compare) -> None:
        for left, operator, right in zip([node.left, *node.comparators], node.ops, node.comparators, strict=False):
            self._replace_between(left, right, operator)

    def _read_boolop(self, node: ast.BoolOp) -> None:
        self._replace_between(node.values[0], node.values[1], node.op)

    def _read_unaryop(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.Not) and (word := re.match(r"not\s*", self._text(node))):
            self._places.append((self._at(node), self._at(node) + word.end(), ""))

    def _read_constant(self, node: ast.Constant) -> None:
        number = node.value
        if isinstance(number, bool):
            self._replace(node, str(not number))
        elif isinstance(number, int):
            self._replace(node, str(number + 1))
        elif isinstance(number, float):
            self._replace(node, repr(2.0 * number) if number else "1.0")

    def _read_if(self, node: ast.If) -> None:
        self._replace(node.test, f"not ({self._text(node.test)})")

    def _read_ifexp(self, node: ast.IfExp) -> None:
        self._replace(node.test, f"(not ({self._text(node.test)}))")

    def _read_call(self, node: ast.Call) -> None:
        if isinstance(node.func, ast.Name) and node.func.id in PAIRS:
            self._replace(node.func, PAIRS[node.func.id])
        elif len(node.args) == 2 and not any(isinstance(part, ast.Starred) for part in node.args):
            if self._text(node.func).removeprefix("np.").removeprefix("math.") in COMMUTATIVE:
                return
            first, second = node.args
            between = self._source[self._at(first, end=True) : self._at(second)]
            swap = f"{self._text(second)}{between}{self._text(first)}"
            self._places.append((self._at(first), self._at(second, end=True), swap))

    def _read_expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call):
            self._replace(node.value, "None")

    def _replace(self, node: ast.expr, text: str) -> None:
        self._places.append((self._at(node), self._at(node, end=True), text))

    def _replace_between(self, left: ast.expr, right: ast.expr, operator: ast.AST) -> None:
        start, end = self._at(left, end=True), self._at(right)
        new = OPERATORS.get(type(operator))
        match = re.search(r"not\s+in|is\s+not|\w+|\*\*|//|[<>=!]=|[-+*/%<>|&]", self._source[start:end])
        if new is not None and match is not None and "#" not in self._source[start:end]:
            self._places.append((start + match.start(), start + match.end(), new))

    def _at(self, node: ast.expr | ast.stmt, end: bool = False) -> int:
        """Where a node begins or ends in the text; Python counts columns in bytes."""
        line, column = (node.end_lineno, node.end_col_offset) if end else (node.lineno, node.col_offset)
        start = self._lines[(line or 1) - 1]
        return start + len(self._source[start:].partition("\n")[0].encode()[: column or 0].decode())

    def _text(self, node: ast.expr) -> str:
        return self._source[self._at(node) : self._at(node, end=True)]
