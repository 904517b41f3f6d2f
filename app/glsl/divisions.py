"""Divisions of whole numbers that cannot stop the process.

The smallest int divided by -1, and anything divided by 0, has no result. Where a driver computes such a division while
it compiles, the processor stops the process. So `a / b` becomes `halation_quotient(a, b)`, `a % b`
`halation_remainder(a, b)`: functions of `lib/whole.glsl` that never divide by 0 or -1. Floats are left as they are,
and so are divisions by a constant that is neither. Constants whose divisor only the driver can tell become variables,
since constants cannot be made by functions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .operands import Names, Operand, OperandReader, collect_names
from .tokens import GlslFault, GlslToken, count_line, mask_directives, match_brackets, read_tokens

QUOTIENT = "halation_quotient"
REMAINDER = "halation_remainder"
MOST_DIVISIONS = 100
"""Divisions in a row: each is a call inside the next one, and 500 of those take Mesa ten seconds."""

DEEPEST = 250
"""Brackets inside each other of text whose size is checked elsewhere."""

_KEYWORDS = frozenset({"return", "if", "while", "for", "switch", "else", "case", "do", "in", "out", "inout", "const"})
_QUALIFIERS = frozenset({"const", "highp", "mediump", "lowp"})
_PREFIXES = frozenset({"-", "+", "!", "~", "++", "--"})
_MULTIPLICATIVE = frozenset({"*", "/", "%"})
_DIVIDERS: Mapping[str, str] = {"/": QUOTIENT, "%": REMAINDER, "/=": QUOTIENT, "%=": REMAINDER}
_SMALLEST = -(1 << 31)
"""The smallest int of GLSL. Divided by -1 it has no result, which ends the process on a processor (SIGFPE)."""


def guard_divisions(code: str, outside_types: Mapping[str, str] | None = None) -> str:
    """The text with divisions of whole numbers made by functions.

    `outside_types` are the types of names that it does not declare. Lines stay. The same text if
    there is nothing to guard. Raises GlslFault for what cannot be guarded.
    """
    tokens = read_tokens(mask_directives(code))
    if not any(token.text in _DIVIDERS for token in tokens):
        return code
    try:
        partners = match_brackets(tokens, code, DEEPEST)
    except GlslFault:
        return code  # the driver refuses it
    names = collect_names(tokens, partners, outside_types or {})
    return _DivisionGuard(code, tokens, partners, names).rewrite(0, len(tokens))


class _DivisionGuard:
    """The work in progress."""

    def __init__(self, code: str, tokens: Sequence[GlslToken], partners: Mapping[int, int], names: Names) -> None:
        self.code, self.tokens, self.partners = code, tokens, partners
        self.reader = OperandReader(tokens, partners, names)
        self.starts: dict[int, int] = {}
        """Where the chain of products before an operator begins."""
        self.variables: set[int] = set()
        """The `const` of constants that are made by functions."""
        self.floats: dict[int, bool] = {}
        """By where a chain of products begins: whether one of its factors so far is a float."""

    def rewrite(self, first: int, last: int) -> str:
        """The text of some tokens, guarded.

        `a / b` becomes `halation_quotient(a , b)`: the call is inserted before the first token of `a`, a comma replaces
        the operator, and a bracket follows the last token of `b`. Nothing moves, so that messages keep their lines.
        """
        inserted: dict[int, list[str]] = {}
        appended: dict[int, list[str]] = {}
        replaced: dict[int, str] = {}
        for at in range(first, last):
            function = _DIVIDERS.get(self.tokens[at].text)
            if not function:
                continue
            if self.tokens[at].text.endswith("="):
                start, end = self._find_operand_start(at), self._find_assigned_end(at)
                if self._is_harmless(start, at, end):
                    continue
                replaced[at] = f"= {function}({self._repeat(start, at)},"
            else:
                start, end = self._find_chain_start(at), self._find_operand_end(at)
                if self._is_harmless(start, at, end):
                    continue
                inserted.setdefault(start, []).append(f"{function}(")
                if len(inserted[start]) > MOST_DIVISIONS:
                    line = count_line(self.code, self.tokens[at].start)
                    raise GlslFault(line, f"more than {MOST_DIVISIONS} whole numbers divide each other in a row")
                replaced[at] = ","
            appended.setdefault(end - 1, []).append(")")
        if first >= last:
            return ""
        if self.variables:
            replaced |= dict.fromkeys(self._list_variables(), "")
        whole = last - first == len(self.tokens)
        parts, place = list[str](), 0 if whole else self.tokens[first].start
        for at in range(first, last):
            token = self.tokens[at]
            parts.append(self.code[place : token.start])
            parts += reversed(inserted.get(at, []))  # what begins at the same place and ends later is around it
            parts.append(replaced.get(at, token.text))
            parts += appended.get(at, [])
            place = token.end
        return "".join([*parts, self.code[place:] if whole else ""])

    # --- what is divided by what -------------------------------------------------------------------------------------

    def _find_chain_start(self, at: int) -> int:
        """Where the left operand of an operator begins: a chain of products."""
        start, passed = self._find_operand_start(at), [at]
        while start > 0 and self.tokens[start - 1].text in _MULTIPLICATIVE:
            passed.append(start - 1)
            start = self.starts.get(start - 1) or self._find_operand_start(start - 1)
        self.starts |= dict.fromkeys(passed, start)
        return start

    def _find_operand_start(self, end: int) -> int:
        """Where the operand begins that ends before a place, with its signs."""
        at = end - 1
        while at > 0 and self.tokens[at].text in ("++", "--"):
            at -= 1
        while at >= 0:
            text = self.tokens[at].text
            if text in (")", "]") and at in self.partners:
                at = self.partners[at]
                before = self.tokens[at - 1] if at else None
                if self.tokens[at].text == "[" or (before and before.text == "]"):
                    at -= 1
                    continue
                if before and before.is_word and before.text not in _KEYWORDS:
                    at -= 1
            if at > 1 and self.tokens[at - 1].text == ".":
                at -= 2
                continue
            break
        at = max(at, 0)
        while at > 0 and self.tokens[at - 1].text in _PREFIXES and not self._ends_operand(at - 2):
            at -= 1
        return at

    def _ends_operand(self, at: int) -> bool:
        if at < 0:
            return False
        token = self.tokens[at]
        if token.text in (")", "]", "++", "--"):
            return True
        return token.is_number or (token.is_word and token.text not in _KEYWORDS)

    def _find_operand_end(self, at: int) -> int:
        """The place after the right operand of an operator."""
        at += 1
        while at < len(self.tokens) and self.tokens[at].text in _PREFIXES:
            at += 1
        if self.partners.get(at, at) < at:
            return at
        at = self.partners.get(at, at) + 1
        while at < len(self.tokens) and (text := self.tokens[at].text) in (".", "(", "[", "++", "--"):
            at = at + 2 if text == "." else self.partners.get(at, at) + 1
        return min(at, len(self.tokens))

    def _find_assigned_end(self, at: int) -> int:
        """The place after what is assigned."""
        at, choices = at + 1, 0
        while at < len(self.tokens) and (text := self.tokens[at].text) not in (",", ";", ")", "]", "}"):
            choices += (text == "?") - (text == ":")
            if choices < 0:
                break
            at = self.partners.get(at, at) + 1
        return min(at, len(self.tokens))

    def _repeat(self, start: int, end: int) -> str:
        """What is assigned to, once more: it may change nothing."""
        if any(token.text in ("++", "--") or token.text.endswith("=") for token in self.tokens[start:end]):
            line = count_line(self.code, self.tokens[start].start)
            raise GlslFault(line, "a division that assigns may change nothing else: write a = a / b")
        return " ".join(self.rewrite(start, end).split())

    # --- whether it needs a guard ------------------------------------------------------------------------------------

    def _is_harmless(self, start: int, at: int, end: int) -> bool:
        divisor = self.reader.read(at + 1, end)
        if divisor.is_float or self._is_float(start, at):
            self.floats[start] = True
            return True
        if _is_safe(divisor):
            return True
        qualifier = self._find_qualifier(at)
        if qualifier is not None:
            line = count_line(self.code, self.tokens[at].start)
            self._check_constant(divisor, self.reader.read(start, at), line)
            if self.tokens[qualifier].text == "case":
                raise GlslFault(line, "a case label divides by a number that is not known here: write the number")
            if divisor.number is not None:
                return True
            self.variables.add(qualifier)
        return False

    def _is_float(self, start: int, at: int) -> bool:
        """Whether a chain of products has a float: each factor is looked at once."""
        if not self.floats.get(start):
            factor = self._find_operand_start(at)
            while True:
                self.floats[start] = self.reader.read(factor, self._find_operand_end(factor - 1)).is_float
                if self.floats[start] or factor <= start or self.tokens[factor - 1].text in ("/", "%"):
                    break
                factor = self._find_operand_start(factor - 1)
        return self.floats[start]

    def _find_qualifier(self, at: int) -> int | None:
        """The `const` or `case` of a statement where functions may not be called, if it has one."""
        while at >= 0 and self.tokens[at].text not in (";", "{", "}"):
            if self.tokens[at].text in ("const", "case"):
                return at
            at = self.partners[at] - 1 if self.tokens[at].text in (")", "]") and at in self.partners else at - 1
        return None

    def _list_variables(self) -> set[int]:
        """The `const` of each constant that becomes a variable: its value is made by functions, or by such a one."""
        statements = [
            (at, self._list_assigned_names(at)) for at, token in enumerate(self.tokens) if token.text == "const"
        ]
        variables, names, before = self.variables, set[str](), -1
        while len(variables) > before:
            before = len(variables)
            for at, (declared, read) in statements:
                if at in variables or read & names:
                    variables.add(at)
                    names |= declared
        return variables

    def _list_assigned_names(self, at: int) -> tuple[set[str], set[str]]:
        """The names that a statement declares, behind a type or a comma, and all that it says."""
        declared, read = set[str](), set[str]()
        while at + 1 < len(self.tokens) and self.tokens[at].text != ";":
            token, before = self.tokens[at], self.tokens[at - 1]
            if token.is_word:
                read.add(token.text)
                is_behind = before.text in (",", "]") or (before.is_word and before.text not in _QUALIFIERS)
                if is_behind and self.tokens[at + 1].text in ("=", "["):
                    declared.add(token.text)
            at += 1
        return declared, read

    def _check_constant(self, divisor: Operand, dividend: Operand, line: int) -> None:
        """Raise GlslFault for a constant that would be divided by 0, or by -1 where it may be the smallest int."""
        numbers = divisor.number if isinstance(divisor.number, tuple) else (divisor.number,)
        if 0 in numbers:
            raise GlslFault(line, "a whole number is divided by 0")
        if -1 in numbers and (not isinstance(dividend.number, int) or dividend.number == _SMALLEST):
            raise GlslFault(line, "a constant is divided by -1: change its sign instead")


def _is_safe(divisor: Operand) -> bool:
    number = divisor.number
    parts = number if isinstance(number, tuple) else (number,)
    return all(isinstance(part, int) and part not in (0, -1) for part in parts)
