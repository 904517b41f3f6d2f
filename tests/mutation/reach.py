"""Which tests run which lines: recorded once, so that a fault is shown to the tests that run it.

    nice .venv/bin/python tests/mutation/reach.py                 # `./dev test --fast`
    nice .venv/bin/python tests/mutation/reach.py tests/media     # these anew, the others as they were

In a copy of the tree, each block of Python (a body of a function, a branch, a loop) begins with a call that notes it
for the test that runs. That takes a tenth more time, where tracing every line takes several times as much. Commands
that tests start note their blocks too. What is recorded lies in `out/`, and holds a block by its function's name and
its place therein: other lines of the file may change. A function that keeps its results is noted for the first test
that asks, and what a module does when it is imported is not noted: `choice.py` looks at names and imports as well.
"""

from __future__ import annotations

import ast
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from zlib import crc32

import numpy as np

sys.path.append(str(Path(__file__).parents[1]))

from source_trees import ROOT, copy_tree, run_in_tree

RECORD = ROOT / "out/mutation/reach.npz"
"""The names of tests, their seconds, and pairs of a block and a test."""

NOTED = "app", "nodes"
"""Folders whose blocks are noted."""

LEFT_OUT = Path("app/export/python/functions")
"""Text that other programs run."""

Functions = ast.FunctionDef | ast.AsyncFunctionDef

_HOOK = """
import builtins, fcntl, os, sys
from importlib.machinery import SourceFileLoader

sys.path.append({tests!r})

class Notes:
    def __init__(self):
        self.seen, self.file, self.process = set(), None, 0

    def begin(self, test):
        self.seen.clear()
        self.put(b"T" + test.encode().replace(b"\\n", b" ") + b"\\n")

    def put(self, line):
        if self.process != os.getpid():
            self.process = os.getpid()
            file = os.open(f"{folder}/{{self.process}}", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            self.file = fcntl.fcntl(file, fcntl.F_DUPFD_CLOEXEC, 100)  # 1 may be free: drivers print there
            os.close(file)
            self.seen.clear()
            self.put(b"T" + os.environ.get("PYTEST_CURRENT_TEST", "").rpartition(" ")[0].encode() + b"\\n")
        os.write(self.file, line)

    def note(self, block):
        if block not in self.seen:
            self.seen.add(block)
            self.put(b"%d\\n" % block)

notes = Notes()
builtins._noted, builtins._begin_test, builtins._note_line = notes.note, notes.begin, notes.put

def compile_noted(self, data, path, *, _optimize=-1, make=SourceFileLoader.source_to_code):
    if path.startswith({starts!r}) and not path.startswith({left_out!r}):
        from mutation.reach import note_blocks
        data = note_blocks(bytes(data).decode(), os.path.relpath(path, {tree!r}))
    return make(self, data, path, _optimize=_optimize)

SourceFileLoader.source_to_code = compile_noted
"""
"""What Python runs first in the copy. Notes are written at once: a process may be killed."""

_PLUGIN = """
import builtins, os, time
import pytest

@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    builtins._begin_test(item.nodeid)
    start, spent = time.perf_counter(), sum(os.times()[:4])
    try:
        return (yield)
    finally:
        builtins._note_line(b"S%f\\n" % (sum(os.times()[:4]) - spent))
        builtins._begin_test("")
"""


def list_blocks(tree: ast.Module) -> Iterator[tuple[str, int, list[ast.stmt], Functions]]:
    """Every block of functions: the function's name, the lines from its first to the block's, and its statements."""

    def visit(node: ast.AST, name: str, function: Functions | None) -> Iterator[tuple[str, int, list, Functions]]:
        if isinstance(node, Functions | ast.ClassDef):
            name = f"{name}.{node.name}"
        function = node if isinstance(node, Functions) else None if isinstance(node, ast.ClassDef) else function
        for field in ("body", "orelse", "finalbody"):
            block = getattr(node, field, None)
            if function is not None and isinstance(block, list) and block:
                yield name, block[0].lineno - function.lineno, block, function
        for child in ast.iter_child_nodes(node):
            yield from visit(child, name, function)

    yield from visit(tree, "", None)


def number_block(path: str, name: str, offset: int) -> int:
    """The number of a block, the same whenever the same function is read."""
    return crc32(f"{path}:{name}:{offset}".encode())


def note_blocks(source: str, path: str) -> ast.Module:
    """A module whose blocks say that they run."""
    tree = ast.parse(source)
    for name, offset, block, function in [*list_blocks(tree)]:
        has_text = block is function.body and ast.get_docstring(function, clean=False) is not None
        call = ast.parse(f"_noted({number_block(path, name, offset)})").body[0]
        for node in ast.walk(call):
            ast.copy_location(node, block[0])
        block.insert(int(has_text), call)
    return tree


@cache
def _read_blocks(path: Path) -> list[tuple[int, int, int]]:
    """First line, last line and number of the file's blocks; a function's own begins at its head."""
    found = []
    for name, offset, block, function in list_blocks(ast.parse((ROOT / path).read_text("utf-8"))):
        first = function.lineno if block is function.body else block[0].lineno
        found.append((first, block[-1].end_lineno or first, number_block(path.as_posix(), name, offset)))
    return found


@cache
def read_record() -> tuple[list[str], dict[str, float], dict[int, set[int]]]:
    """The tests, their seconds, and the tests of each block; empty where nothing was recorded."""
    if not RECORD.is_file():
        return [], {}, {}
    with np.load(RECORD) as file:
        names, seconds, pairs = file["names"].tolist(), file["seconds"].tolist(), file["pairs"]
    blocks = defaultdict[int, set[int]](set)
    for block, test in pairs.tolist():
        blocks[block].add(test)
    return names, dict(zip(names, seconds, strict=True)), blocks


def is_outside_functions(path: Path, line: int) -> bool:
    """Whether a line runs when its module is imported, which nobody notes."""
    return not any(first <= line <= last for first, last, _ in _read_blocks(path))


def list_runners(path: Path, line: int) -> dict[str, int]:
    """The tests that run a line, and how many blocks each runs: those of its innermost block.

    A line outside functions is run by whoever runs any block of its file.
    """
    names, _, blocks = read_record()
    around = [(last - first, number) for first, last, number in _read_blocks(path) if first <= line <= last]
    numbers = [min(around)[1]] if around else [number for *_, number in _read_blocks(path)]
    tests = {test for number in numbers for test in blocks.get(number, ())}
    counts = _count_blocks()
    return {names[test]: counts[test] for test in tests}


@cache
def _count_blocks() -> dict[int, int]:
    counts = defaultdict[int, int](int)
    for tests in read_record()[2].values():
        for test in tests:
            counts[test] += 1
    return counts


def record(choice: list[str]) -> None:
    """Run tests in a copy that notes what they run, and keep that."""
    with tempfile.TemporaryDirectory() as folder:
        tree, notes, hook = (Path(folder, name) for name in ("tree", "notes", "tree-path"))
        notes.mkdir()
        copy_tree(tree)
        for cached in [*tree.rglob("__pycache__")]:
            for file in cached.iterdir():
                file.unlink()
        run_in_tree(tree, "-c", "")  # writes what Python runs first
        starts, left_out = tuple(f"{tree / name}/" for name in NOTED), str(tree / LEFT_OUT)
        text = _HOOK.format(tests=str(tree / "tests"), folder=notes, starts=starts, left_out=left_out, tree=str(tree))
        with (hook / "sitecustomize.py").open("a") as file:
            file.write(text)
        (hook / "noting_plugin.py").write_text(_PLUGIN)
        words = ["-m", "pytest", "-q", "-p", "noting_plugin", "-p", "no:cacheprovider", "--tb=line", "-n", "2"]
        env = {**os.environ, "PYTHONPATH": str(hook)}
        subprocess.run([sys.executable, *words, "--dist=loadfile", *choice], cwd=tree, env=env, check=False)
        _keep(notes)


def _keep(notes: Path) -> None:
    reached, seconds = defaultdict[str, set[int]](set), defaultdict[str, float](float)
    for file in notes.iterdir():
        test = ""
        for line in file.read_text("utf-8").splitlines():
            if line.startswith("T"):
                test = line[1:].partition("[")[0]
            elif line.startswith("S"):
                seconds[test] += float(line[1:])
            elif test:
                reached[test].add(int(line))
    old, spent, blocks = read_record()
    for block, tests in blocks.items():
        for test in tests:
            if old[test] not in seconds:
                reached[old[test]].add(block)
    seconds = {**spent, **seconds}
    names = sorted(reached)
    pairs = [(block, at) for at, name in enumerate(names) for block in reached[name]]
    RECORD.parent.mkdir(parents=True, exist_ok=True)
    costs = np.array([seconds.get(name, 0.0) for name in names], np.float32)
    np.savez_compressed(RECORD, names=np.array(names), seconds=costs, pairs=np.array(pairs, np.int64).reshape(-1, 2))


if __name__ == "__main__":
    record(sys.argv[1:] or ["--fast", "tests"])
