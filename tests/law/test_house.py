"""House rules that no other tool checks: short files, few comments, documented modules, a tidy root."""

from __future__ import annotations

import ast
import os
import re
import tokenize
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import pytest
from generated_pages import WHOLE_PAGES

ROOT = Path(__file__).parents[2]
ENTRIES = {
    ".ci",
    ".git",
    ".git-blame-ignore-revs",
    ".github",
    ".gitignore",
    "LICENSE",
    "README.md",
    "app",
    "dev",
    "docs",
    "nodes",
    "presets",
    "pyproject.toml",
    "shaders",
    "tests",
}
TEXT = {"", ".py", ".glsl", ".md", ".toml", ".json", ".yml", ".txt"}


@cache
def ignored() -> tuple[str, ...]:
    """The patterns of .gitignore."""
    return tuple(line.rstrip("/") for line in (ROOT / ".gitignore").read_text().split())


def is_ours(path: Path) -> bool:
    return not any(fnmatch(part, pattern) for part in path.relative_to(ROOT).parts for pattern in ignored())


@cache
def files() -> tuple[Path, ...]:
    """Every text file of the project."""
    tops = [ROOT / name for name in sorted(ENTRIES - {".git"})]
    found = [path for top in tops for path in ([top] if top.is_file() else top.rglob("*"))]
    return tuple(path for path in found if path.is_file() and is_ours(path) and path.suffix in TEXT)


def python_files() -> list[Path]:
    return [path for path in files() if path.suffix == ".py"]


def label(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def test_the_root_holds_only_what_belongs_there() -> None:
    assert {path.name for path in ROOT.iterdir() if is_ours(path)} <= ENTRIES
    assert len(files()) > 50


def test_scripts_can_be_run() -> None:
    assert all(os.access(ROOT / name, os.X_OK) for name in ("dev", ".ci/run"))


def test_the_sample_stays_small() -> None:
    assert sum(path.stat().st_size for path in (ROOT / "presets").rglob("*") if path.is_file()) <= 6 * 2**20


def test_files_are_short() -> None:
    lines = {label(path): path.read_text("utf-8").count("\n") for path in files() if path.suffix != ".json"}
    long_files = {name: count for name, count in lines.items() if count > 400 and name not in WHOLE_PAGES}
    assert not long_files, (
        f"longer than 400 lines: {long_files}; split them (a page that is generated as a whole goes into WHOLE_PAGES "
        "in tests/generated_pages.py)"
    )


@pytest.mark.parametrize(
    "pattern",
    [
        rf"\b{'TO' + 'DO'}\b|\b{'FIX' + 'ME'}\b|\b{'XX' + 'X'}\b",
        r"(?<![\w.~*])/(?:home|root|work|Users|opt|srv|mnt)/\w",
        r"\bpy" + r"pi\.|files\.python" + r"hosted|\bartifact" + r"ory\b",
        r"\.\./shar" + r"ed\b|\bissue #?\d",
        "\r\n|[^\\S\n]+$|\t",
    ],
    ids=["notes to self", "paths of one machine", "registries", "outside", "white space"],
)
def test_no_text_is_unfinished_or_points_elsewhere(pattern: str) -> None:
    """No notes to self, no machine's own paths, no registry's name, no stray white space."""
    found = [
        f"{label(path)}:{number}: {line.strip()}"
        for path in files()
        if path != Path(__file__)
        for number, line in enumerate(path.read_bytes().decode("utf-8").split("\n"), 1)
        if re.search(pattern, line)
    ]
    assert not found, "\n".join(found)


def test_this_machine_is_not_mentioned() -> None:
    here = [word for word in (str(ROOT), str(Path.home())) if len(word) > 5]
    assert not [label(path) for path in files() for word in here if word in path.read_text("utf-8")]


@dataclass(frozen=True)
class Survey:
    """What the laws ask of a module: it is read once, and not kept."""

    undocumented: list[str]
    """The module and its public names that have no docstring."""
    mutable: list[str]
    """Where mutable values are at the top of it, and statements that make names global."""
    lengths: dict[str, int]
    """The lines of each function, by where it is."""
    unexplained: list[str]
    """Constants that are numbers without a reason."""


@cache
def survey(path: Path) -> Survey:
    text = path.read_text("utf-8")
    tree = ast.parse(text, label(path))
    return Survey(
        find_undocumented(path, tree),
        find_mutable(path, tree),
        measure_functions(path, tree),
        find_unexplained_numbers(path, tree, text.splitlines()),
    )


def list_product(*tops: str) -> list[Path]:
    """The Python files of some top-level folders."""
    return [path for path in python_files() if path.relative_to(ROOT).parts[0] in tops]


def find_undocumented(path: Path, tree: ast.Module) -> list[str]:
    """The module and its public names that have no docstring. A node's class speaks for its file."""
    kinds = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    public = [item for item in tree.body if isinstance(item, kinds) and not item.name.startswith("_")]
    silent = [f"{label(path)}: {item.name}" for item in public if not (ast.get_docstring(item) or is_overload(item))]
    is_node = path.match("nodes/[!_]*/[!_]*.py")
    return silent if is_node or ast.get_docstring(tree) else [label(path), *silent]


def is_overload(item: ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return any(isinstance(mark, ast.Name) and mark.id == "overload" for mark in item.decorator_list)


def test_everything_public_is_documented() -> None:
    product = [path for path in python_files() if path.relative_to(ROOT).parts[0] != "tests"]
    assert len(product) > 30
    assert not [line for path in product for line in survey(path).undocumented]


def comments(path: Path) -> int:
    """How many comments a file has, those that talk to tools aside."""
    with tokenize.open(path) as text:
        found = [token.string for token in tokenize.generate_tokens(text.readline) if token.type == tokenize.COMMENT]
    return sum(not re.match(r"#!|# (noqa|type:|pyright:|ruff:|fmt:)", comment) for comment in found)


def test_comments_are_few() -> None:
    """At most 8 % of the lines: what the code does is the code's to say."""
    too_many: dict[str, tuple[int, int]] = {}
    for path in python_files():
        lines = path.read_text("utf-8").splitlines()
        most = max(2, 0.08 * len(lines))
        # A line that has a comment has its sign: most files need not be taken apart.
        if sum("#" in line for line in lines) > most and (count := comments(path)) > most:
            too_many[label(path)] = count, len(lines)
    assert not too_many


def find_mutable(path: Path, tree: ast.Module) -> list[str]:
    """Lists, dicts and sets at the top of a module that are neither constants by name nor frozen, and `global`."""
    makers = (ast.List, ast.Dict, ast.Set, ast.ListComp, ast.DictComp, ast.SetComp)
    tops = [
        f"{label(path)}:{item.lineno}"
        for item in tree.body
        if isinstance(item, ast.Assign | ast.AnnAssign) and isinstance(item.value, makers)
        for target in (item.targets if isinstance(item, ast.Assign) else [item.target])
        if not (isinstance(target, ast.Name) and (target.id.isupper() or target.id == "__all__"))
    ]
    return tops + [f"{label(path)}:{item.lineno}" for item in ast.walk(tree) if isinstance(item, ast.Global)]


DATACLASSES = {"app/graph/graph.py", "app/graph/model.py", "nodes/_declare/node.py", "nodes/_declare/sockets.py"}
"""Where values are dataclasses: graphs and nodes, those of plug-ins too, are changed by `dataclasses.replace`."""


def test_values_are_structs() -> None:
    """Python takes 0.3 ms to make a dataclass, which commands and the editor would pay at each start."""
    written = re.compile(r"^@(?:dataclasses\.)?dataclass\b", re.MULTILINE)
    paths = list_product("app", "nodes")
    assert {
        path.relative_to(ROOT).as_posix() for path in paths if written.search(path.read_text("utf-8"))
    } == DATACLASSES


def test_no_module_keeps_mutable_state() -> None:
    assert not [place for path in list_product("app", "nodes") for place in survey(path).mutable]


LONGEST_FUNCTION = 50
"""Lines of a function. Of a command its flags and its help, which are the arguments and the docstring, do not count."""


def measure_functions(path: Path, tree: ast.Module) -> dict[str, int]:
    """The lines of each function of a file, by where it is."""
    is_command = path.relative_to(ROOT).parts[:2] == ("app", "cli")
    lengths: dict[str, int] = {}
    for item in ast.walk(tree):
        if isinstance(item, ast.FunctionDef | ast.AsyncFunctionDef):
            start = item.lineno
            if is_command and len(item.body) > 1:
                start = item.body[1 if ast.get_docstring(item) else 0].lineno
            lengths[f"{label(path)}: {item.name}"] = (item.end_lineno or start) - start + 1
    return lengths


def test_functions_are_short() -> None:
    files = list_product("app", "nodes")
    lengths = {name: length for path in files for name, length in survey(path).lengths.items()}
    assert not {name: length for name, length in lengths.items() if length > LONGEST_FUNCTION}


_PLAIN_NUMBERS = (-1, 0, 1, 2)
"""Numbers that need no reason."""


def list_numbers(value: ast.expr) -> list[complex]:
    """The numbers that an expression is written of; none where it holds names or calls, which say what they are."""
    parts = [item for item in ast.walk(value) if isinstance(item, ast.expr)]
    kinds = (ast.Constant, ast.Tuple, ast.BinOp, ast.UnaryOp)
    if not all(isinstance(item, kinds) for item in parts):
        return []
    numbers = [item.value for item in parts if isinstance(item, ast.Constant)]
    return [number for number in numbers if isinstance(number, int | float) and not isinstance(number, bool)]


def find_unexplained_numbers(path: Path, tree: ast.Module, lines: list[str]) -> list[str]:
    """The constants of a module that are numbers and have neither a comment nor a text below, alone or as a group."""
    body = tree.body
    unexplained: list[str] = []
    for place, item in enumerate(body):
        if not isinstance(item, ast.Assign | ast.AnnAssign) or item.value is None:
            continue
        if all(number in _PLAIN_NUMBERS for number in list_numbers(item.value)):
            continue
        last = place
        while last + 1 < len(body) and body[last + 1].lineno == (body[last].end_lineno or 0) + 1:
            last += 1
        has_text = any(isinstance(near, ast.Expr) for near in body[place + 1 : last + 1])
        if not has_text and "#" not in lines[item.lineno - 1] and not lines[item.lineno - 2].startswith("#"):
            unexplained.append(f"{label(path)}:{item.lineno}: {lines[item.lineno - 1]}")
    return unexplained


def test_numbers_say_where_they_come_from() -> None:
    """Or what they are: see "Words" in CONTRIBUTING.md, by which the layout of the editor needs no reason."""
    reasoned = [path for path in list_product("app", "nodes") if path.relative_to(ROOT).parts[:2] != ("app", "editor")]
    assert not [line for path in reasoned for line in survey(path).unexplained]
