"""Typed values from plain data: alike on all threads, whichever comes first."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest
from halation.resources.typed_data import convert_data, decode_data

RACE = """
import json, sys, threading
import msgspec
from halation.resources.typed_data import convert_data, decode_data

sys.setswitchinterval(1e-6)
data = {"f0": 1, "inner": {"f1": {"a": [2]}}}

def convert(kind, start, values):
    start.wait()
    values += [convert_data(data, kind), decode_data(json.dumps(data), kind)]

for _ in range(30):
    inner = msgspec.defstruct("Inner", [(f"f{k}", "dict[str, list[int | str]] | None", None) for k in range(30)])
    fields = [(f"f{k}", "int | str | None", None) for k in range(40)]
    kind = msgspec.defstruct("Outer", [*fields, ("inner", inner, None)])
    start, values = threading.Barrier(4), []
    threads = [threading.Thread(target=convert, args=(kind, start, values)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(values) == 8 and all(value == kind(f0=1, inner=inner(f1={"a": [2]})) for value in values)
"""


def test_threads_meet_a_class_at_the_same_time() -> None:
    """By msgspec itself this ends the process within a few rounds."""
    ended = subprocess.run([sys.executable, "-c", RACE], capture_output=True, text=True, timeout=200)
    assert ended.returncode == 0, ended.stderr


def test_hooks_may_convert() -> None:
    class Inner(msgspec.Struct):
        path: Path

    def read(kind: type, raw: object) -> object:
        return kind(raw) if kind is Path else convert_data(raw, Inner, hook=read)

    assert convert_data({"path": "a/b"}, Inner, hook=read) == Inner(Path("a/b"))
    assert convert_data("3", int, strict=False) == 3
    with pytest.raises(msgspec.ValidationError, match="Expected `int`, got `str`"):
        convert_data("3", int)
    with pytest.raises(msgspec.DecodeError):
        decode_data("{", dict)


def test_nothing_else_converts() -> None:
    package = Path(__file__).parents[2] / "app"
    found = []
    for path in package.rglob("*.py"):
        if path.name == "typed_data.py":
            continue
        for item in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(item, ast.ImportFrom) and item.module in ("msgspec", "msgspec.json"):
                found += [
                    f"{path}: {name.name}" for name in item.names if name.name in ("convert", "decode", "Decoder")
                ]
            if isinstance(item, ast.Call) and ast.unparse(item.func) in ("msgspec.convert", "msgspec.json.Decoder"):
                found.append(f"{path}:{item.lineno}")
            if isinstance(item, ast.Call) and ast.unparse(item.func) == "msgspec.json.decode" and item.keywords:
                found.append(f"{path}:{item.lineno}")
    assert not found
