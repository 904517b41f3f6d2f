"""How large a shader may be: what drivers cannot compile in any time, or die of, is refused before they see it.

Compilers of shaders walk expressions and statements by recursion, write the text of a function wherever it is called,
and keep arrays in registers. So what counts is how deep things lie inside each other, how long the text is with all
calls written out, and how many numbers the arrays hold. The bounds are far above what shaders have, and below
what ends Mesa 22.3, measured: sums of 30,000 terms end the process, arrays of 16,384 floats and switches of 1,000 cases
take a minute. What lies between is ended by `--timeout`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from msgspec import Struct

from .constants import Number
from .operands import TYPE, OperandReader, collect_names, skip_lengths
from .tokens import GlslFault, GlslToken, count_line, mask_directives, match_brackets, read_tokens

DEEPEST_BRACKETS = 100
"""Brackets inside each other. The limits without figures are chosen by judgement: far above hand-written code."""

DEEPEST_STATEMENTS = 100
"""Statements inside each other without brackets: `if (a) if (b)`."""

LONGEST_CHAIN = 250
"""Of `else if`, of `? :` and of `=` in a row."""

MOST_TERMS = 4000
"""Operators between two brackets, commas or semicolons."""

MOST_CASES = 256
"""Of one switch: 500 take Mesa five seconds, 1000 take forty."""

MOST_FLOATS = 16_384
"""Numbers in all arrays together. Arrays that are read at places known only at run time take Mesa a second for 1000
floats, and the square of that for more."""

LARGEST_EXPANSION = 250_000
"""Words and signs of a function with all that it calls written out."""

MOST_FUNCTIONS = 1000
"""Functions of a text."""

DEEPEST_CALLS = 100
"""Functions that call each other in a chain: 1000 take Mesa a gigabyte."""

LONGEST_PATH = 32
"""Members and places of arrays in a row: `a.b[1].c`."""

_OPERATORS = frozenset({*"+-*/%<>&|^", "<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "^^"})
_PREFIXES = frozenset({"-", "+", "!", "~", "++", "--"})
_ASSIGNMENTS = frozenset({"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="})
_CONTROL = frozenset({"if", "for", "while", "do", "switch", "else"})
_COUNTED = _OPERATORS | _PREFIXES | _ASSIGNMENTS | _CONTROL | {".", "[", "?", "case", ",", ";"}


def check_size(code: str, outside_types: Mapping[str, str] | None = None) -> None:
    """Raise GlslFault with the line where code without comments and macros is too large.

    `outside_types` are the types of names that come from elsewhere.
    """
    tokens = read_tokens(mask_directives(code))
    bounds = _Bounds(code, tokens, match_brackets(tokens, code, DEEPEST_BRACKETS), outside_types or {})
    bounds.check_statements()
    bounds.check_arrays()
    bounds.check_calls()


class _Bounds:
    """What the checks share."""

    def __init__(
        self, code: str, tokens: Sequence[GlslToken], partners: Mapping[int, int], outside_types: Mapping[str, str]
    ) -> None:
        self.code, self.tokens, self.partners = code, tokens, partners
        self.names = collect_names(tokens, partners, outside_types)
        self.reader = OperandReader(tokens, partners, self.names)
        self.sizes: dict[str, int] = {}
        """The floats of each struct."""
        self.lengths: dict[str, int] = {}
        """The length of each array, by its name."""
        self.arrays: dict[int, int] = {}
        """The floats of each array, by the token that it begins with."""

    def fault(self, at: int, sentence: str) -> GlslFault:
        """What is wrong at a token."""
        return GlslFault(count_line(self.code, self.tokens[at].start), sentence)

    # --- statements and expressions ----------------------------------------------------------------------------------

    def check_statements(self) -> None:
        """Terms, signs, chains, members and cases: counted anew inside each bracket."""
        outer: list[_Counts] = []
        counts, before = _Counts(), ""
        for at, token in enumerate(self.tokens):
            counts.add(token.text, before)
            if token.text in _COUNTED and (excess := counts.excess()):
                raise self.fault(at, f"there are more than {excess}")
            if token.text in ("(", "[", "{"):
                outer.append(counts)
                counts = _Counts()
            elif token.text in (")", "]", "}"):
                counts = outer.pop()
                if token.text == "}":
                    counts.end_statement()
            before = token.text

    # --- arrays ------------------------------------------------------------------------------------------------------

    def check_arrays(self) -> None:
        """Lengths, and places that are numbers: those make some arrays as long as they say."""
        lengths = set[int]()
        inside: list[tuple[str, int]] = []
        for at, token in enumerate(self.tokens):
            while inside and at > inside[-1][1]:
                inside.pop()
            text = token.text
            if text == "struct" and at + 2 < len(self.tokens) and self.tokens[at + 2].text == "{":
                inside.append((self.tokens[at + 1].text, self.partners[at + 2]))
                self.sizes[self.tokens[at + 1].text] = 0
            elif (TYPE.fullmatch(text) or text in self.sizes) and self.tokens[max(at - 1, 0)].text != "struct":
                floats = self._measure_declaration(at, lengths)
                if inside:
                    self.sizes[inside[-1][0]] += floats
                    self._limit(at, self.sizes[inside[-1][0]])
                elif floats > _count_floats(text):
                    self.arrays[at] = floats
                    self._limit(at, sum(self.arrays.values()))
            elif text == "[" and at not in lengths:
                place = self.reader.read(at + 1, self.partners[at]).number
                if isinstance(place, int) and not 0 <= place <= MOST_FLOATS:
                    raise self.fault(at, f"an array has no index {place}: {MOST_FLOATS} numbers are the most")

    def _limit(self, at: int, floats: int) -> None:
        if floats > MOST_FLOATS:
            raise self.fault(at, f"arrays hold {floats} numbers: {MOST_FLOATS} are the most, all arrays together")

    def _measure_declaration(self, at: int, lengths: set[int]) -> int:
        """The floats of all that is declared after a type; the brackets of its lengths are added to `lengths`."""
        glsl = self.tokens[at].text
        floats = self.sizes.get(glsl, 0) or _count_floats(glsl)
        place = skip_lengths(self.tokens, self.partners, at + 1)
        following = self.tokens[place].text if place < len(self.tokens) else ""
        own = self._multiply(at + 1, place, lengths, self._count_items(place) if following == "(" else 0)
        total = floats * own if following == "(" and place > at + 1 else 0
        while place < len(self.tokens) and self.tokens[place].is_word:
            after = skip_lengths(self.tokens, self.partners, place + 1)
            following = self.tokens[after].text if after < len(self.tokens) else ""
            items = self._count_items(after + 1) if following == "=" else 0
            length = (own or items) * self._multiply(place + 1, after, lengths, items)
            if length == 0:
                raise self.fault(place, f"the array '{self.tokens[place].text}' needs a length")
            self.lengths[self.tokens[place].text] = length
            total += floats * length
            if following != ",":
                break
            place = after + 1
            if TYPE.fullmatch(self.tokens[place].text) or self.tokens[place].text in self.sizes:
                break
        return total

    def _count_items(self, at: int) -> int:
        """The parts that stand in the first brackets from a place on: an array without a length is as long."""
        while at < len(self.tokens) and self.tokens[at].text not in ("(", "{", ";", ",", ")", "]", "}"):
            at = self.partners.get(at, at) + 1
        if at >= len(self.tokens) or self.tokens[at].text not in ("(", "{"):
            return 0
        closed, count = self.partners[at], 1
        at += 1
        while at < closed:
            count += self.tokens[at].text == ","
            at = self.partners.get(at, at) + 1
        return count

    def _multiply(self, at: int, end: int, lengths: set[int], items: int) -> int:
        """The product of the lengths between two places; `items` for one that is not said."""
        product = 1
        while at < end:
            lengths.add(at)
            closed = self.partners[at]
            if closed == at + 1:
                product *= items
            else:
                length = self._read_length(at + 1, closed)
                if not isinstance(length, int):
                    raise self.fault(at, "the length of an array must be a number, or a constant that is one")
                if not 0 < length <= MOST_FLOATS:
                    raise self.fault(at, f"an array cannot have the length {length}: {MOST_FLOATS} is the most")
                product *= length
            at = closed + 1
        return product

    def _read_length(self, start: int, end: int) -> Number | None:
        texts = [token.text for token in self.tokens[start:end]]
        if texts[1:] == [".", "length", "(", ")"]:
            return self.lengths.get(texts[0])
        return self.reader.read(start, end).number

    # --- calls -------------------------------------------------------------------------------------------------------

    def check_calls(self) -> None:
        """The text with all calls written out, as compilers have it."""
        bodies, prototypes = self._find_functions()
        if len(bodies) > MOST_FUNCTIONS:
            raise self.fault(bodies[-1][1], f"there are more than {MOST_FUNCTIONS} functions")
        by_name: dict[str, list[int]] = {}
        for number, (name, _, _) in enumerate(bodies):
            by_name.setdefault(name, []).append(number)
        costs: dict[int, tuple[int, int]] = {}
        for number in range(len(bodies)):
            self._write_out(number, bodies, by_name, prototypes, costs, frozenset())

    def _find_functions(self) -> tuple[list[tuple[str, int, int]], set[str]]:
        """Each function with its name and where its body is, and the names that are declared before."""
        bodies: list[tuple[str, int, int]] = []
        prototypes = set[str]()
        at = 0
        while at < len(self.tokens):
            if self.tokens[at].text == "(" and at and self.tokens[at - 1].is_word:
                after = self.partners[at] + 1
                following = self.tokens[after].text if after < len(self.tokens) else ""
                if following == "{":
                    bodies.append((self.tokens[at - 1].text, after, self.partners[after]))
                elif following == ";":
                    prototypes.add(self.tokens[at - 1].text)
            at = self.partners.get(at, at) + 1
        return bodies, prototypes

    def _write_out(
        self,
        number: int,
        bodies: Sequence[tuple[str, int, int]],
        by_name: Mapping[str, Sequence[int]],
        prototypes: set[str],
        costs: dict[int, tuple[int, int]],
        callers: frozenset[int],
    ) -> tuple[int, int]:
        """The length of a function with all that it calls, and how many call each other in a chain.

        Each function is measured once. A call is taken for one of the functions of that name that GLSL can see from
        there: those above, or all with a prototype. Which overload it is, only a compiler knows, so the longest one
        counts.
        """
        if number in costs:
            return costs[number]
        _, start, end = bodies[number]
        depth = 0
        if len(callers) > DEEPEST_CALLS:
            raise self.fault(start, f"more than {DEEPEST_CALLS} functions call each other in a chain")
        cost = end - start + sum(floats // 4 for at, floats in self.arrays.items() if start < at < end)
        for at in range(start, end):
            name = self.tokens[at].text
            if name not in by_name or self.tokens[at + 1].text != "(":
                continue
            callees = [
                callee for callee in by_name[name] if callee < number or (name in prototypes and callee != number)
            ]
            called = [
                self._write_out(callee, bodies, by_name, prototypes, costs, callers | {number})
                for callee in callees
                if callee not in callers
            ]
            cost += max((length for length, _ in called), default=0)
            depth = max([depth, *(1 + deep for _, deep in called)])
            if depth > DEEPEST_CALLS:
                raise self.fault(at, f"more than {DEEPEST_CALLS} functions call each other in a chain")
            if cost > LARGEST_EXPANSION:
                raise self.fault(
                    at,
                    f"with all that '{bodies[number][0]}' calls written out, it has more than {LARGEST_EXPANSION} "
                    "words and signs: call fewer functions, or call them in a loop",
                )
        costs[number] = cost, depth
        return costs[number]


class _Counts(Struct):
    """What is counted inside a bracket."""

    terms: int = 0
    signs: int = 0
    members: int = 0
    links: int = 0
    nested: int = 0
    alternatives: int = 0
    cases: int = 0

    def add(self, text: str, before: str) -> None:
        """Count a token that follows another one."""
        if before in (";", "}") and text != "else":
            self.alternatives = 0
        if text not in _COUNTED:
            self.signs = 0
            return
        self.signs = self.signs + 1 if text in _PREFIXES else 0
        self.terms += text in _OPERATORS
        self.members = self.members + 1 if text in (".", "[") else 0 if text in _OPERATORS else self.members
        self.links += text == "?" or text in _ASSIGNMENTS
        self.nested += text in _CONTROL
        self.alternatives += text == "else"
        self.cases += text == "case"
        if text in (",", ";"):
            self.terms = self.members = 0
        if text == ";":
            self.end_statement()

    def end_statement(self) -> None:
        """Begin to count a statement."""
        self.terms = self.members = self.links = self.nested = 0

    def excess(self) -> str:
        """What there is too much of, if anything."""
        for count, most, description in (
            (self.terms, MOST_TERMS, "terms in an expression"),
            (self.signs, LONGEST_PATH, "signs in a row"),
            (self.members, LONGEST_PATH, "members in a row"),
            (self.links, LONGEST_CHAIN, "choices or assignments in a row"),
            (self.nested, DEEPEST_STATEMENTS, "statements inside each other"),
            (self.alternatives, LONGEST_CHAIN, "alternatives ('else') in a row"),
            (self.cases, MOST_CASES, "cases in a switch"),
        ):
            if count > most:
                return f"{most} {description}"
        return ""


def _count_floats(glsl: str) -> int:
    """The numbers in a variable of a type."""
    sizes = [int(digit) for digit in glsl if digit.isdigit()]
    doubled = 2 if glsl[0] == "d" else 1
    if "mat" in glsl:
        return doubled * sizes[0] * sizes[-1]
    return doubled * (sizes[0] if sizes else 1)
