"""Which module of the tree imports which, read from the code. The law tests stand on it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDERS = {"app": "halation", "nodes": "halation.nodes", "shaders": "halation.shaders", "presets": "halation.presets"}
"""Top-level folder -> the package that it is."""


def name_of(path: Path) -> str:
    """The import name of a file of the tree; a package's own name ends in `__init__`."""
    top, *rest = path.relative_to(ROOT).with_suffix("").parts
    return ".".join([FOLDERS[top], *rest])


MODULES = {name_of(path): path for top in FOLDERS for path in (ROOT / top).rglob("*.py")}


def resolve(name: str) -> str:
    """The module of the tree that importing `name` loads, or `name` itself if it is from outside."""
    if f"{name}.__init__" in MODULES:
        return f"{name}.__init__"
    return name


def targets(tree: ast.AST, package: str) -> Iterator[str]:
    """Every module that code inside `package` imports, wherever in the file it does so."""
    for statement in ast.walk(tree):
        if isinstance(statement, ast.Import):
            yield from (resolve(alias.name) for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom):
            parts = package.split(".")
            above = parts[: len(parts) - statement.level + 1] if statement.level else []
            base = ".".join([*above, *filter(None, [statement.module])])
            for alias in statement.names:
                inner = resolve(f"{base}.{alias.name}".lstrip("."))
                yield inner if inner in MODULES else resolve(base)


@cache
def imports(name: str) -> frozenset[str]:
    """What a module of the tree imports: names of the tree, and names of libraries."""
    return frozenset(targets(ast.parse(MODULES[name].read_text(encoding="utf-8"), name), name.rpartition(".")[0]))


@cache
def links() -> tuple[tuple[str, str], ...]:
    """(module, what it imports) for the whole tree."""
    return tuple(sorted((name, target) for name in MODULES for target in imports(name)))
