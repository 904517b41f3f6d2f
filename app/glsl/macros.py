"""Macros and conditions of GLSL, expanded within bounds.

Drivers expand macros without any bound: eight lines can ask for gigabytes, and `##` makes words that nobody sees in the
text. So no driver expands macros of users: it gets the expanded text, and that text is what is checked. Each line stays
on its line, since messages of drivers name lines.

The rules are those of C: a macro is not expanded inside of itself, arguments are expanded before they are inserted,
except beside `##`. Names that no macro has are 0 in conditions.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct

from .conditions import evaluate_condition
from .text import INCLUDE
from .tokens import GlslFault, count_line, split_tokens

MOST_TOKENS = 50_000
"""Words, numbers and signs of a shader after expansion. The largest public shaders that we know have 20,000; Mesa
dies of an expression of 30,000 terms, and takes minutes for as many statements."""

MOST_MACROS = 1000
"""Macros defined at a time: the largest public shaders have 100."""

DEEPEST_MACROS = 64
"""Macros whose expansions lie inside each other."""

LONGEST_WORD = 1024
"""Letters of a name, as the specification of OpenGL ES has it; desktop drivers promise no more."""

_DIRECTIVE = re.compile(r"[ \t]*#[ \t]*(\w*)(.*)", re.DOTALL)
_DEFINITION = re.compile(r"\s*([A-Za-z_]\w*)(\(([^()]*)\))?(.*)", re.DOTALL)
_WORD = re.compile(r"[A-Za-z_]\w*")
_STRANGE = re.compile(r"[^\t\n\v\f\r -~]")
_PREDEFINED = {"__VERSION__": "410", "GL_core_profile": "1"}
_FIXED = frozenset({"__LINE__", "__FILE__", "__VERSION__", "defined"})

_Painted = tuple[str, frozenset[str]]
"""A token, and the macros that are not expanded in it any more."""


class _Macro(Struct, frozen=True):
    """What a name stands for; `parameters` is None where it takes none, not even an empty list."""

    body: tuple[str, ...]
    parameters: tuple[str, ...] | None = None


def expand_macros(code: str, names: Mapping[str, str] | None = None, *, may_include: bool = True) -> str:
    """The text without macros and conditions, line by line; `names` are defined from the start.

    `#include` lines stay if it `may_include` files. `code` has no comments. Raises GlslFault for what is invalid or
    too large.
    """
    if strange := _STRANGE.search(code):
        raise GlslFault(count_line(code, strange.start()), f"the character {strange[0]!a} is not allowed here")
    if (place := code.find("/*")) >= 0:
        raise GlslFault(count_line(code, place), "the comment that begins here is never closed")
    return _Expander(code, {**_PREDEFINED, **(names or {})}, may_include).expand()


class _Expander:
    """The work in progress."""

    def __init__(self, code: str, names: Mapping[str, str], may_include: bool) -> None:
        self.lines, self.may_include = code.split("\n"), may_include
        self.macros = {name: _Macro(tuple(split_tokens(text))) for name, text in names.items()}
        self.at = 0
        self.spent = 0
        self.conditions: list[tuple[bool, bool, int]] = []
        """Of each condition that is open: whether its part is used, whether one was already, and its line."""

    def expand(self) -> str:
        """The whole text."""
        expanded: list[str] = []
        while self.at < len(self.lines):
            first = self.at
            line = self._read_line()
            directive = _DIRECTIVE.fullmatch(line) if line.lstrip().startswith("#") else None
            if directive:
                expanded.append(self._apply_directive(directive[1], directive[2], line, first + 1))
            elif not self._is_used():
                expanded.append("")
            else:
                expanded.append(self._expand_line(line, first + 1))
            expanded += [""] * (self.at - first - 1)
        if self.conditions:
            raise GlslFault(self.conditions[-1][2], "the condition that begins here has no #endif")
        return "\n".join(expanded)

    def _read_line(self) -> str:
        """The next line, with those that a backslash joins to it."""
        parts = [self.lines[self.at]]
        self.at += 1
        while parts[-1].endswith("\\") and self.at < len(self.lines):
            parts[-1] = parts[-1][:-1]
            parts.append(self.lines[self.at])
            self.at += 1
        return "".join(parts)

    def _is_used(self) -> bool:
        return all(used for used, _, _ in self.conditions)

    def _spend(self, line: int, count: int = 1) -> None:
        self.spent += count
        if self.spent > MOST_TOKENS:
            raise GlslFault(
                line,
                f"the code has more than {MOST_TOKENS} words and signs once its macros are expanded: make it smaller",
            )

    # --- directives --------------------------------------------------------------------------------------------------

    def _apply_directive(self, name: str, rest: str, whole: str, line: int) -> str:
        """What stays of a line with a directive."""
        match name:
            case "if" | "ifdef" | "ifndef":
                used = self._is_used() and self._holds(name, rest, line)
                if len(self.conditions) >= DEEPEST_MACROS:
                    raise GlslFault(line, f"more than {DEEPEST_MACROS} conditions lie inside each other")
                self.conditions.append((used, used or not self._is_used(), line))
            case "elif" | "else" | "endif":
                if not self.conditions:
                    raise GlslFault(line, f"#{name} belongs to no #if")
                _, is_settled, begun = self.conditions.pop()
                if name != "endif":
                    used = not is_settled and self._is_used() and (name == "else" or self._holds("if", rest, line))
                    self.conditions.append((used, is_settled or used, begun))
            case _ if not self._is_used():
                pass
            case "define":
                self._define(rest, line)
            case "undef":
                self.macros.pop(rest.strip(), None)
            case "error":
                raise GlslFault(line, f"#error {rest.strip()}".strip())
            case "include":
                if not self.may_include or not INCLUDE.fullmatch(whole):
                    raise GlslFault(line, "#include has no place here")
                return whole
            case "" | "pragma" | "line" | "version" | "extension":
                pass
            case _:
                raise GlslFault(line, f"there is no #{name}")
        return ""

    def _define(self, rest: str, line: int) -> None:
        definition = _DEFINITION.fullmatch(rest)
        if not definition or definition[1] in _FIXED:
            raise GlslFault(line, "#define must be followed by the name of the macro")
        body = tuple(split_tokens(definition[4]))
        if "##" in (body[:1] + body[-1:]):
            raise GlslFault(line, f"'##' joins nothing in the macro '{definition[1]}'")
        parameters = None
        if definition[2]:
            parameters = tuple(part.strip() for part in definition[3].split(",")) if definition[3].strip() else ()
            if len(set(parameters)) < len(parameters) or not all(_WORD.fullmatch(part) for part in parameters):
                raise GlslFault(line, f"the parameters of the macro '{definition[1]}' are not names")
        self._spend(line, len(body) // 8)  # to read it costs less than to use it: chosen by judgement
        if len(self.macros) >= MOST_MACROS:
            raise GlslFault(line, f"there are more than {MOST_MACROS} macros")
        self.macros[definition[1]] = _Macro(body, parameters)

    def _holds(self, name: str, rest: str, line: int) -> bool:
        """Whether a condition is true."""
        if name != "if":
            word = rest.split()
            if not word:
                raise GlslFault(line, f"#{name} must be followed by the name of a macro")
            return (word[0] in self.macros) == (name == "ifdef")
        tokens = deque[_Painted]()
        texts = iter(split_tokens(rest))
        for text in texts:
            if text != "defined":
                tokens.append((text, frozenset()))
                continue
            word = next(texts, "")
            if word == "(":
                word, closing = next(texts, ""), next(texts, "")
                if closing != ")":
                    raise GlslFault(line, "'defined' must be followed by a name")
            tokens.append(("1" if word in self.macros else "0", frozenset()))
        return evaluate_condition(list(self._expand(tokens, line, follow=False)), line) != 0

    # --- expansion ---------------------------------------------------------------------------------------------------

    def _expand_line(self, line: str, number: int) -> str:
        """A line without macros; it is left as it is where it has none."""
        texts = split_tokens(line)
        self._spend(number, len(texts))
        if longest := next((text for text in texts if len(text) > LONGEST_WORD), None):
            raise GlslFault(number, f"'{longest[:16]}...' has more than {LONGEST_WORD} letters")
        if not any(text in self.macros or text in _FIXED or text in ("#", "##", "\\") for text in texts):
            return line
        if bad := next((text for text in texts if text in ("#", "##", "\\")), None):
            raise GlslFault(number, f"'{bad}' is not allowed here")
        return " ".join(self._expand(deque((text, frozenset[str]()) for text in texts), number, follow=True))

    def _expand(self, tokens: deque[_Painted], line: int, *, follow: bool, depth: int = 0) -> Iterator[str]:
        return (text for text, _ in self._paint(tokens, line, follow, depth))

    def _paint(self, tokens: deque[_Painted], line: int, follow: bool, depth: int) -> Iterator[_Painted]:
        """Expand everything. With `follow` the arguments of a macro may go on in the next lines."""
        if depth > DEEPEST_MACROS:
            raise GlslFault(line, f"more than {DEEPEST_MACROS} macros lie inside each other")
        while tokens:
            text, painted = tokens.popleft()
            self._spend(line)
            macro = self.macros.get(text)
            if text == "__LINE__":
                yield str(line), painted
            elif text == "__FILE__":
                yield "0", painted
            elif macro is None or text in painted:
                yield text, painted
            elif macro.parameters is None:
                self._insert(tokens, self._join(macro.body, {}, line, depth), painted | {text}, line)
            elif self._is_called(tokens, follow):
                arguments, closing = self._read_arguments(tokens, text, len(macro.parameters), follow, line)
                named = dict(zip(macro.parameters, arguments, strict=True))
                # As Prosser's algorithm has it: what the call and its end share is not expanded any more.
                self._insert(tokens, self._join(macro.body, named, line, depth), (painted & closing) | {text}, line)
            else:
                yield text, painted

    def _insert(self, tokens: deque[_Painted], body: Iterable[_Painted], painted: frozenset[str], line: int) -> None:
        if len(painted) > DEEPEST_MACROS:
            raise GlslFault(line, f"more than {DEEPEST_MACROS} macros lie inside each other")
        inserted = [(text, own | painted) for text, own in body]
        self._spend(line, len(inserted) // 2)
        tokens.extendleft(reversed(inserted))

    def _is_called(self, tokens: deque[_Painted], follow: bool) -> bool:
        """Whether brackets follow the name of a macro."""
        while not tokens and follow and self._read_more(tokens):
            pass
        return bool(tokens) and tokens[0][0] == "("

    def _read_more(self, tokens: deque[_Painted]) -> bool:
        """Add the next line, unless it is a directive; False at the end."""
        if self.at >= len(self.lines) or self.lines[self.at].lstrip().startswith("#"):
            return False
        texts = split_tokens(self._read_line())
        self._spend(self.at, len(texts))
        tokens.extend((text, frozenset()) for text in texts)
        return True

    def _read_arguments(
        self, tokens: deque[_Painted], name: str, count: int, follow: bool, line: int
    ) -> tuple[list[list[_Painted]], frozenset[str]]:
        """The arguments of a call, whose opening bracket comes next, and what its closing bracket is painted with."""
        tokens.popleft()
        arguments: list[list[_Painted]] = [[]]
        depth = 0
        while True:
            if not tokens and not (follow and self._read_more(tokens)):
                raise GlslFault(line, f"the arguments of the macro '{name}' do not end")
            if not tokens:
                continue
            text, painted = tokens.popleft()
            if text == ")" and depth == 0:
                break
            if text == "," and depth == 0:
                arguments.append([])
                continue
            depth += (text in "([{") - (text in ")]}")
            arguments[-1].append((text, painted))
        if count == 0 and arguments == [[]]:
            arguments = []
        if len(arguments) != count:
            raise GlslFault(line, f"the macro '{name}' takes {count} arguments, not {len(arguments)}")
        return arguments, painted

    def _join(
        self, body: tuple[str, ...], arguments: Mapping[str, list[_Painted]], line: int, depth: int
    ) -> list[_Painted]:
        """The body of a macro with its arguments inserted, and `##` obeyed."""
        joined: list[_Painted] = []
        expanded: dict[str, list[_Painted]] = {}
        place = 0
        while place < len(body):
            text = body[place]
            if text == "##":
                following = body[place + 1]
                right = list(arguments.get(following, [(following, frozenset[str]())]))
                left = [joined.pop()] if joined and joined[-1][0] else []
                joined += self._paste(left, right, line)
                place += 2
                continue
            if text in arguments and body[place + 1 : place + 2] == ("##",):
                joined += arguments[text] or [("", frozenset())]
            elif text in arguments:
                if text not in expanded:
                    expanded[text] = list(self._paint(deque(arguments[text]), line, False, depth + 1))
                joined += expanded[text]
                self._spend(line, len(expanded[text]))
            else:
                joined.append((text, frozenset()))
            place += 1
        return [token for token in joined if token[0]]

    def _paste(self, left: list[_Painted], right: list[_Painted], line: int) -> list[_Painted]:
        """Join the last token on the left to the first on the right."""
        if not left or not right:
            return left or right or [("", frozenset())]
        text = left[0][0] + right[0][0]
        if split_tokens(text) != [text] or len(text) > LONGEST_WORD:
            raise GlslFault(line, f"'##' makes '{text[:40]}', which is not one word, number or sign")
        return [(text, left[0][1] & right[0][1]), *right[1:]]
