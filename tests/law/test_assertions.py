"""Every test asserts something, and every skip has a reason that is listed here."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from skips import find_cause

TESTS = Path(__file__).parents[1]
CHECKS = ("np.testing.assert_", "pytest.raises", "pytest.warns", "pytest.fail")

Function = ast.FunctionDef | ast.AsyncFunctionDef


@cache
def read_trees() -> dict[Path, ast.Module]:
    """All Python files of the tests but the benchmarks, which measure."""
    paths = (path for path in TESTS.rglob("*.py") if path.relative_to(TESTS).parts[0] != "bench")
    return {path: ast.parse(path.read_text("utf-8")) for path in sorted(paths)}


@cache
def list_nodes(tree: ast.AST) -> tuple[ast.AST, ...]:
    """All nodes of a tree, which each question about it goes through."""
    return tuple(ast.walk(tree))


@cache
def list_functions(tree: ast.AST) -> list[Function]:
    return [node for node in list_nodes(tree) if isinstance(node, Function)]


def is_trivial(condition: ast.expr) -> bool:
    """True for a condition that no fault can make false."""
    if isinstance(condition, ast.BoolOp) and isinstance(condition.op, ast.Or):
        return any(map(is_trivial, condition.values))
    if isinstance(condition, ast.Tuple | ast.List | ast.Set):
        return bool(condition.elts)
    if isinstance(condition, ast.Compare) and len(condition.ops) == 1:
        return ast.dump(condition.left) == ast.dump(condition.comparators[0]) and not calls_of(condition)
    return isinstance(condition, ast.JoinedStr | ast.Lambda) or (
        isinstance(condition, ast.Constant) and bool(condition.value)
    )


def name_function(call: ast.Call) -> str:
    """What a call calls, `np.testing.assert_allclose`; "" where that is no name."""
    parts, function = list[str](), call.func
    while isinstance(function, ast.Attribute):
        parts.append(function.attr)
        function = function.value
    return ".".join([function.id, *reversed(parts)]) if isinstance(function, ast.Name) else ""


def calls_of(tree: ast.AST) -> list[ast.Call]:
    return [node for node in list_nodes(tree) if isinstance(node, ast.Call)]


@cache
def asserts(function: Function) -> bool:
    """True for a function that has an assertion of its own."""
    own = any(isinstance(node, ast.Assert) and not is_trivial(node.test) for node in list_nodes(function))
    raises = any(
        isinstance(node, ast.Raise) and node.exc is not None and "AssertionError" in ast.unparse(node.exc)
        for node in list_nodes(function)
    )
    return own or raises or any(name_function(call).startswith(CHECKS) for call in calls_of(function))


Helpers = dict[Path | None, set[str]]


@cache
def list_checking_helpers() -> Helpers:
    """Names of functions, fixtures and methods that assert, by file; methods and fixtures of conftest have no file."""
    functions = [
        (path, function, is_method(tree, function) or path.name == "conftest.py")
        for path, tree in read_trees().items()
        for function in list_functions(tree)
    ]
    checking: Helpers = {None: set(), **{path: set() for path in read_trees()}}
    while True:
        more = [
            (None if is_shared else path, function.name)
            for path, function, is_shared in functions
            if function.name not in checking[None if is_shared else path]
            and (asserts(function) or uses_helper(path, function, checking))
        ]
        if not more:
            return checking
        for home, name in more:
            checking[home].add(name)


@cache
def list_used_names(function: Function) -> tuple[frozenset[str], frozenset[str]]:
    """The names and the methods that a function uses."""
    names = {node.id for node in list_nodes(function) if isinstance(node, ast.Name)}
    names |= {argument.arg for argument in function.args.args}
    methods = {call.func.attr for call in calls_of(function) if isinstance(call.func, ast.Attribute)}
    return frozenset(names - {function.name}), frozenset(methods - {function.name})


def is_method(tree: ast.Module, function: Function) -> bool:
    return function in list_methods(tree)


@cache
def list_methods(tree: ast.Module) -> frozenset[ast.stmt]:
    return frozenset(part for node in list_nodes(tree) if isinstance(node, ast.ClassDef) for part in node.body)


def uses_helper(path: Path, function: Function, checking: Helpers) -> bool:
    """True for a function that calls, or takes as a fixture, what asserts."""
    names, methods = list_used_names(function)
    return (
        not checking[None].isdisjoint(names | methods)
        or not checking[path].isdisjoint(names)
        or any(name in names and name in checking[home] for home, name in list_imports(path))
    )


@cache
def list_imports(path: Path) -> tuple[tuple[Path, str], ...]:
    """What a file takes from other files of the tests: the file and the name."""
    return tuple(
        (home, alias.name)
        for node in list_nodes(read_trees()[path])
        if isinstance(node, ast.ImportFrom) and node.module
        for home in (TESTS / f"{node.module.replace('.', '/')}.py", path.parent / f"{node.module}.py")
        if home in read_trees()
        for alias in node.names
    )


def list_tests() -> Iterator[tuple[Path, Function]]:
    for path, tree in read_trees().items():
        if path.name.startswith("test_"):
            yield from ((path, node) for node in list_functions(tree) if node.name.startswith("test_"))


def test_no_test_asserts_nothing() -> None:
    helpers = list_checking_helpers()
    idle = [
        f"{path.relative_to(TESTS)}:{test.lineno}: {test.name}"
        for path, test in list_tests()
        if not asserts(test) and not uses_helper(path, test, helpers)
    ]
    assert not idle, "\n".join(idle)


def reason_of(skip: ast.Call) -> str:
    """The constant beginning of the reason of a skip."""
    named = next((word.value for word in skip.keywords if word.arg == "reason"), None)
    text = named or (skip.args[0] if skip.args else None)
    if isinstance(text, ast.JoinedStr):
        text = text.values[0]
    return text.value if isinstance(text, ast.Constant) and isinstance(text.value, str) else ""


def test_every_skip_has_a_listed_reason() -> None:
    skips = [
        (path, call)
        for path, tree in read_trees().items()
        if path.name != "test_harness.py"
        for call in calls_of(tree)
        if name_function(call) in ("pytest.skip", "pytest.mark.skip", "pytest.mark.skipif", "pytest.importorskip")
    ]
    unlisted = [
        f"{path.relative_to(TESTS)}:{call.lineno}: {reason_of(call)!r}"
        for path, call in skips
        if find_cause(reason_of(call)) is None
    ]
    assert len(skips) > 40 and not unlisted, "\n".join(unlisted)


def test_no_assertion_is_always_true() -> None:
    trivial = [
        f"{path.relative_to(TESTS)}:{node.lineno}: {ast.unparse(node)}"
        for path, tree in read_trees().items()
        for node in list_nodes(tree)
        if isinstance(node, ast.Assert) and is_trivial(node.test)
    ]
    assert not trivial, "\n".join(trivial)


@pytest.mark.parametrize(
    ("text", "asserting"),
    [
        ("assert f() or True", False),
        ("assert (x, 'why')", False),
        ("assert x == x", False),
        ("assert 1", False),
        ("assert f() == f()", True),
        ("assert x", True),
        ("np.testing.assert_allclose(a, b)", True),
        ("with pytest.raises(ValueError):\n        f()", True),
        ("f()", False),
    ],
)
def test_the_law_knows_an_assertion(text: str, asserting: bool) -> None:
    (function,) = list_functions(ast.parse(f"def test_x():\n    {text}\n"))
    assert asserts(function) is asserting
