"""Leaves out of functions what a graph never asks them for: branches and entries of other choices.

Lines are removed and no text is written anew, so comments and layout stay. A choice decides tests such as
`kind == "box"`, `mode in TABLE` and `if clip`, and entries of tables. Everything else stays.

A parameter of the same name means the same choice in all functions: so a choice of a node reaches the functions that it
is passed on to. Texts that functions pass to each other count as asked for, too.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping
from functools import lru_cache

from msgspec import Struct, field
from msgspec.structs import replace

from .library import Definition, FunctionLibrary, find_uses

_ROUNDS = 4
"""The most times that functions are pruned, unless nothing changes before: each time fewer texts are passed on. No
preset changes after the third time."""


class AskedChoices(Struct, frozen=True):
    """What a graph asks for, by function and parameter: choices, their options, and switches."""

    choices: Mapping[tuple[str, str], frozenset[str]]
    options: Mapping[tuple[str, str], frozenset[str]]
    switches: Mapping[tuple[str, str], frozenset[bool]]

    def list_functions(self) -> set[str]:
        """The functions of nodes that are asked for anything."""
        return {function for function, _ in (*self.choices, *self.switches)}


class Known(Struct):
    """What can be asked of one definition, by parameter: of all functions of nodes that use it."""

    choices: dict[str, set[str]] = field(default_factory=dict[str, "set[str]"])
    options: dict[str, set[str]] = field(default_factory=dict[str, "set[str]"])
    switches: dict[str, set[bool]] = field(default_factory=dict[str, "set[bool]"])

    def add(self, asked: AskedChoices, function: str) -> None:
        """Add what is asked of the function of a node."""
        tables = ((asked.choices, self.choices), (asked.options, self.options), (asked.switches, self.switches))
        for table, own in tables:
            for (name, parameter), values in table.items():
                if name == function:
                    own.setdefault(parameter, set()).update(values)  # pyright: ignore[reportArgumentType]


def prune(library: FunctionLibrary, names: Iterable[str], asked: AskedChoices) -> FunctionLibrary:
    """The library with functions that do what is asked for, as far as `names` need them."""
    names = list(names)
    for _ in range(_ROUNDS):
        definitions = library.collect(names)
        sources = {each.name: _read_source(each.text) for each in definitions}
        known = {each.name: Known() for each in definitions}
        for function in asked.list_functions():
            for each in library.collect([function]):
                known[each.name].add(asked, function)
        defaults: dict[str, set[bool]] = {}
        for source in sources.values():
            for name, state in source.default_switches:
                defaults.setdefault(name, set()).add(state)
        passed = frozenset[str]().union(*(source.passed_texts for source in sources.values()))
        tables = {name: source.keys for name, source in sources.items() if source.keys}
        pruned = {each.name: _Pruner(each, known[each.name], passed, defaults, tables).prune() for each in definitions}
        if all(pruned[each.name].text == each.text for each in definitions):
            break
        library = replace(library, definitions={**library.definitions, **pruned})
    return library


class _Source(Struct, frozen=True):
    """What the text of a definition says, whatever is asked of it."""

    uses: frozenset[str]
    """The names that it takes from outside."""
    passed_texts: frozenset[str]
    """Texts that it hands to other functions, and texts that stand for a missing argument."""
    default_switches: tuple[tuple[str, bool], ...]
    """The switches that it may be called without, and what they are then."""
    keys: frozenset[str]
    """Its keys, if it is a table."""
    own_tables: Mapping[str, frozenset[str]]
    """The keys of tables inside it, by name."""
    parts: tuple[ast.Dict | list[ast.stmt], ...]
    """Its tables and blocks, those outside before those inside."""


@lru_cache(maxsize=1024)
def _read_source(text: str) -> _Source:
    """Read a definition. Most are the same in all scripts, and each is asked for in all rounds."""
    tree = ast.parse(text)
    tables: dict[str, frozenset[str]] = {}
    parts: list[ast.Dict | list[ast.stmt]] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and isinstance(node.value, ast.Dict):
            tables[node.targets[0].id] = _list_keys(node.value)
        if isinstance(node, ast.Dict):
            parts.append(node)
        blocks = (getattr(node, "body", None), getattr(node, "orelse", None))
        parts += [block for block in blocks if isinstance(block, list)]
    return _Source(
        uses=find_uses(tree.body[0]),
        passed_texts=_find_passed_texts(tree),
        default_switches=_list_default_switches(tree),
        keys=_find_keys(tree),
        own_tables=tables,
        parts=tuple(parts),
    )


def _find_passed_texts(tree: ast.Module) -> frozenset[str]:
    parts: list[ast.expr] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            parts += [*node.args, *(keyword.value for keyword in node.keywords)]
        elif isinstance(node, ast.FunctionDef):
            parts += node.args.defaults
    constants = [part for each in parts for part in ast.walk(each) if isinstance(part, ast.Constant)]
    return frozenset(constant.value for constant in constants if isinstance(constant.value, str))


def _list_default_switches(tree: ast.Module) -> tuple[tuple[str, bool], ...]:
    node = tree.body[0]
    if not isinstance(node, ast.FunctionDef) or not node.args.defaults:
        return ()
    pairs = zip(node.args.args[-len(node.args.defaults) :], node.args.defaults, strict=True)
    return tuple(
        (each.arg, default.value)
        for each, default in pairs
        if isinstance(default, ast.Constant) and isinstance(default.value, bool)
    )


def _find_keys(tree: ast.Module) -> frozenset[str]:
    node = tree.body[0]
    return _list_keys(node.value) if isinstance(node, ast.Assign) and isinstance(node.value, ast.Dict) else frozenset()


def _list_keys(table: ast.Dict) -> frozenset[str]:
    keys = [key.value if isinstance(key, ast.Constant) else None for key in table.keys]
    return frozenset(str(key) for key in keys) if all(isinstance(key, str) for key in keys) else frozenset()


class _Pruner:
    """One definition. `dropped` are lines that go, `moved` those that move to the left, `reworded` other ones."""

    def __init__(
        self,
        definition: Definition,
        known: Known,
        passed: frozenset[str],
        defaults: Mapping[str, set[bool]],
        tables: Mapping[str, frozenset[str]],
    ) -> None:
        self.definition, self.known, self.passed = definition, known, passed
        self.defaults, self.tables = defaults, dict(tables)
        self.lines = definition.text.splitlines()
        self.dropped, self.moved, self.reworded = set[int](), dict[int, int](), dict[int, str]()

    def prune(self) -> Definition:
        """The definition without what nobody asks for."""
        source = _read_source(self.definition.text)
        self.tables |= source.own_tables
        for part in source.parts:
            if isinstance(part, ast.Dict):
                self._prune_table(part)
            else:
                self._prune_block(part)
        if not (self.dropped or self.moved or self.reworded):
            return self.definition
        lines: list[str] = []
        for number, line in enumerate(self.lines, start=1):
            if number not in self.dropped:
                line = self.reworded.get(number, line)
                away = self.moved.get(number, 0)
                lines.append(line[away:] if line[:away].isspace() else line)
        text = "\n".join(lines)
        return replace(self.definition, text=text, uses=_read_source(text).uses)

    def _prune_table(self, table: ast.Dict) -> None:
        """Drop the entries of choices that are not asked for, where each has lines of its own."""
        keys = _list_keys(table)
        names = [name for name, options in self.known.options.items() if keys and keys <= options]
        if not names:
            return
        texts = self.passed.union(*(self.known.choices[name] for name in names))
        spans = [
            (key.lineno, value.end_lineno or 0) for key, value in zip(table.keys, table.values, strict=True) if key
        ]
        apart = all(before[1] < after[0] for before, after in zip([(0, table.lineno), *spans], spans, strict=False))
        if not apart or not keys & texts or (table.end_lineno or 0) <= spans[-1][1]:
            return
        for key, span in zip(table.keys, spans, strict=True):
            if isinstance(key, ast.Constant) and key.value not in texts:
                self.dropped |= set(range(span[0], span[1] + 1))

    def _prune_block(self, block: list[ast.stmt]) -> None:
        """Prune the tests of a block, each for the choices that those before have not answered by returning."""
        answered: dict[str, set[str]] = {}
        for at, node in enumerate(block):
            if not isinstance(node, ast.If) or node.lineno in self.dropped or self._is_elif(node):
                continue
            always = self._prune_chain(node, {name: set(texts) for name, texts in answered.items()})
            if always and isinstance(always[-1], ast.Return):
                if at + 1 < len(block):
                    self.dropped |= set(range(block[at + 1].lineno, (block[-1].end_lineno or 0) + 1))
                return
            if isinstance(node.body[-1], ast.Return) and (comparison := self._read_test(node.test)) and comparison[2]:
                answered.setdefault(comparison[0], set()).update(comparison[1])

    def _prune_chain(self, node: ast.If, answered: dict[str, set[str]]) -> list[ast.stmt]:
        """Prune a test with its `elif` and `else`. Returns the body that always runs, if nothing is left to test."""
        tested: list[ast.If] = []
        last: ast.If | None = None  # the branch that always runs where the others do not
        at: ast.If | None = node
        end = node
        while at is not None and last is None:
            decided = self._decide(at.test, answered)
            if decided is None:
                tested.append(at)
            last = at if decided else None
            comparison = self._read_test(at.test)
            if comparison and comparison[2]:
                answered.setdefault(comparison[0], set()).update(comparison[1])
            end, after = at, at.orelse[0] if at.orelse else None
            at = after if isinstance(after, ast.If) and self._is_elif(after) else None
        spans = [self._find_span(each) for each in tested]
        body: list[ast.stmt] = last.body if last else []
        header, first = (last.lineno, (last.test.end_lineno or 0) + 1) if last else (0, 0)
        if last is None and end.orelse and not (tested and self._has_nothing_left(end.test, answered)):
            body, header = end.orelse, self._find_else(end)
            first = header + 1
        kept_lines = {number for span in spans for number in span}
        if body:
            kept_lines |= set(range(first, (body[-1].end_lineno or 0) + 1))
            if tested:
                kept_lines.add(header)
                indent = " " * node.col_offset
                self.reworded[header] = f"{indent}else:" if last else self.lines[header - 1]
            else:
                for number in range(first, (body[-1].end_lineno or 0) + 1):
                    self.moved[number] = self.moved.get(number, 0) + 4
        self.dropped |= set(range(node.lineno, (node.end_lineno or 0) + 1)) - kept_lines
        if tested:
            line = self.lines[tested[0].lineno - 1]
            self.reworded[tested[0].lineno] = line.replace("elif ", "if ", 1) if self._is_elif(tested[0]) else line
        return [] if tested else body

    def _find_span(self, node: ast.If) -> range:
        """The lines of a test and its body."""
        return range(node.lineno, (node.body[-1].end_lineno or 0) + 1)

    def _find_else(self, node: ast.If) -> int:
        """The line of the `else` of a test."""
        between = range((node.body[-1].end_lineno or 0) + 1, node.orelse[0].lineno + 1)
        return next(number for number in between if self.lines[number - 1].lstrip().startswith("else:"))

    def _has_nothing_left(self, test: ast.expr, answered: Mapping[str, set[str]]) -> bool:
        comparison = self._read_test(test)
        possible = self._list_possible(comparison[0]) if comparison else None
        return comparison is not None and possible is not None and not possible - answered.get(comparison[0], set())

    def _is_elif(self, node: ast.If) -> bool:
        return self.lines[node.lineno - 1].lstrip().startswith("elif ")

    def _decide(self, test: ast.expr, answered: Mapping[str, set[str]]) -> bool | None:
        """True if a test holds for all that is asked, False if for nothing, None if it depends."""
        if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            decided = self._decide(test.operand, answered)
            return None if decided is None else not decided
        if isinstance(test, ast.Name):
            values = self.known.switches.get(test.id, set()) | self.defaults.get(test.id, set())
            return next(iter(values)) if len(values) == 1 and test.id in self.known.switches else None
        comparison = self._read_test(test)
        possible = self._list_possible(comparison[0]) if comparison else None
        if comparison is None or possible is None:
            return None
        name, texts, is_positive = comparison
        holds = {choice in texts for choice in possible - answered.get(name, set())}
        if len(holds) > 1:
            return None
        return (holds.pop() if holds else False) == is_positive

    def _list_possible(self, name: str) -> set[str] | None:
        """All texts that a choice can be; None if nothing is known about it."""
        if not self.known.choices.get(name):
            return None
        return self.known.choices[name] | (self.passed & self.known.options[name])

    def _read_test(self, test: ast.expr) -> tuple[str, frozenset[str], bool] | None:
        """The name that is compared, the texts that it is compared with, and whether it should be one of them."""
        if not isinstance(test, ast.Compare) or not isinstance(test.left, ast.Name) or len(test.ops) != 1:
            return None
        texts = self._list_wanted(test.comparators[0])
        if texts is None or not isinstance(test.ops[0], ast.Eq | ast.NotEq | ast.In | ast.NotIn):
            return None
        return test.left.id, texts, isinstance(test.ops[0], ast.Eq | ast.In)

    def _list_wanted(self, node: ast.expr) -> frozenset[str] | None:
        """The texts that a test compares with."""
        if isinstance(node, ast.Name):
            return self.tables.get(node.id)
        parts = node.elts if isinstance(node, ast.Tuple | ast.List) else [node]
        texts = [part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str)]
        return frozenset(texts) if len(texts) == len(parts) else None
