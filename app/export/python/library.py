"""The text of the functions that scripts are made of."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import resources

from msgspec import Struct

_EDGES_OF_BODY = (ast.FunctionDef, ast.Lambda)


class FunctionParameter(Struct, frozen=True):
    """A parameter: whether it may vary from pixel to pixel, whether it has a default, and the choices that it knows.

    `takes_clip`: it is given a picture as a function of the frame.
    """

    name: str
    takes_array: bool
    has_default: bool
    choices: tuple[object, ...] = ()
    takes_clip: bool = False


class Definition(Struct, frozen=True):
    """A function or a constant: its text, the names that it uses, and for a function its parameters."""

    name: str
    text: str
    uses: frozenset[str]
    parameters: tuple[FunctionParameter, ...] = ()
    is_function: bool = False


class FunctionLibrary(Struct, frozen=True):
    """All definitions by name, and the lines that import everything else."""

    definitions: Mapping[str, Definition]
    imports: Mapping[str, str]

    def find_function(self, name: str) -> Definition | None:
        """The function of a node; None if there is none."""
        definition = self.definitions.get(name)
        return definition if definition and definition.is_function else None

    def collect(self, names: Iterable[str]) -> list[Definition]:
        """The definitions of these names and all that they use, each after those that it uses."""
        collected: dict[str, Definition] = {}

        def add(name: str) -> None:
            definition = self.definitions.get(name)
            if definition is None or name in collected:
                return
            collected[name] = definition  # before what it uses: functions may use each other
            for used in sorted(definition.uses - {name}):
                add(used)
            collected[name] = collected.pop(name)

        for name in names:
            add(name)
        return list(collected.values())

    def list_imports(self, definitions: Iterable[Definition]) -> list[str]:
        """The import lines that definitions need."""
        used = frozenset[str]().union(*(definition.uses for definition in definitions))
        return sorted({line for name, line in self.imports.items() if name in used})


@cache
def load_library() -> FunctionLibrary:
    """The functions that ship with Halation."""
    definitions: dict[str, Definition] = {}
    imports: dict[str, str] = {}
    folder = resources.files(__package__ or "") / "functions"
    trees: list[tuple[str, ast.Module]] = []
    for file in sorted(folder.iterdir(), key=lambda file: file.name):
        if file.name.endswith(".py") and not file.name.startswith("__"):
            text = file.read_text("utf-8")
            trees.append((text, ast.parse(text)))
    aliases = {name: choices for _, tree in trees for name, choices in _find_aliases(tree)}
    for text, tree in trees:
        for definition in _read_definitions(text, tree, aliases):
            assert definition.name not in definitions, f"two functions are called '{definition.name}'"
            definitions[definition.name] = definition
        imports |= dict(_read_imports(tree))
    return FunctionLibrary(definitions, imports)


def _find_aliases(tree: ast.Module) -> Iterator[tuple[str, tuple[object, ...]]]:
    for node in tree.body:
        if (
            isinstance(node, ast.Assign)
            and isinstance(node.targets[0], ast.Name)
            and (choices := _read_choices(node.value))
        ):
            yield node.targets[0].id, choices


def _read_choices(node: ast.AST | None) -> tuple[object, ...]:
    """The values of a `Literal[...]`; empty for anything else."""
    if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id == "Literal":
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        return tuple(ast.literal_eval(part) for part in parts)
    return ()


def _read_imports(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Imported names of other packages, with the line that imports each."""
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and not node.level and node.module != "__future__":
            for alias in node.names:
                yield alias.name, f"from {node.module} import {alias.name}"
        elif isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.asname or alias.name, ast.unparse(ast.Import([alias]))


def _read_definitions(text: str, tree: ast.Module, aliases: Mapping[str, tuple[object, ...]]) -> Iterator[Definition]:
    lines = text.splitlines()
    for node, after in zip(tree.body, [*tree.body[1:], None], strict=True):
        if isinstance(node, ast.FunctionDef):
            body = "\n".join(lines[node.lineno - 1 : node.end_lineno])
            yield Definition(node.name, body, find_uses(node), _read_parameters(node, aliases), True)
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            described = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
            end = after.end_lineno if described and after else node.end_lineno
            body = "\n".join(lines[node.lineno - 1 : end])
            yield Definition(node.targets[0].id, body, find_uses(node))


def _read_parameters(node: ast.FunctionDef, aliases: Mapping[str, tuple[object, ...]]) -> tuple[FunctionParameter, ...]:
    arguments = node.args.args
    first_default = len(arguments) - len(node.args.defaults)
    types = [{part.id for part in ast.walk(each) if isinstance(part, ast.Name)} for each in arguments]
    return tuple(
        FunctionParameter(
            each.arg,
            "Array" in types[at],
            at >= first_default,
            _read_choices(each.annotation) or aliases.get(ast.unparse(each.annotation or ast.Constant(0)), ()),
            "Clip" in types[at],
        )
        for at, each in enumerate(arguments)
    )


def find_uses(node: ast.AST) -> frozenset[str]:
    """The names that a definition takes from outside."""
    names = [part for part in ast.walk(node) if isinstance(part, ast.Name)]
    bound = {name.id for name in names if isinstance(name.ctx, ast.Store)}
    for part in ast.walk(node):
        if isinstance(part, _EDGES_OF_BODY):
            bound |= {argument.arg for argument in part.args.args}
        if isinstance(part, ast.FunctionDef) and part is not node:
            bound.add(part.name)
    return frozenset({name.id for name in names} - bound)
