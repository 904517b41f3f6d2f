"""The command line inside this process: one device for all, and a small scene with exact numbers."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import Cli, make_cli
from exr_files import write_exr
from halation import renderer
from halation.compiler import Form
from halation.resources.sandbox import UNRESTRICTED

WIDTH, HEIGHT = 48, 32
RED = np.linspace(0.0, 1.0, WIDTH, dtype=np.float32).astype(np.float16).astype(np.float32)

Graphs = Callable[..., Path]


@cache
def device(form: Form | None, memory: int) -> renderer.Device:
    return REAL_DEVICE(form, memory, sandbox=UNRESTRICTED)


REAL_DEVICE = renderer.open_device


@pytest.fixture
def cli(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Cli:
    """`cli("render", path, "-o", file)` runs a command; a thousand devices would be slow, so there is one per form."""
    monkeypatch.setattr(renderer, "open_device", lambda form=None, memory=0, *, sandbox: device(form, memory))

    return make_cli(capfd)


@pytest.fixture
def shot(tmp_path: Path) -> Path:
    """Combined: red rises from 0 to 1, green 0.25, blue 0.5. Cool: the same with blue 2. Depth: 1 .. 32 downward."""
    combined = np.empty((HEIGHT, WIDTH, 4), np.float32)
    combined[...] = (0.0, 0.25, 0.5, 1.0)
    combined[..., 0] = RED
    cool = combined.copy()
    cool[..., 2] = 2.0
    depth = np.repeat(np.arange(1, HEIGHT + 1, dtype=np.float32)[:, None, None], WIDTH, axis=1)
    formats = {"Combined": "half", "Cool": "half", "Depth": "float"}
    return write_exr(tmp_path / "shot.exr", {"Combined": combined, "Cool": cool, "Depth": depth}, formats)


@pytest.fixture
def graphs(tmp_path: Path, shot: Path) -> Graphs:
    """`graphs(nodes=..., links=...)` writes a graph file beside the shot: beauty -> light (exposure) -> image."""

    def made(name: str = "graph.json", **parts: Any) -> Path:
        tree: dict[str, Any] = {
            "halation": 1,
            "inputs": {"beauty": {"type": "Image", "file": shot.name, "layer": "Combined"}},
            "outputs": {"image": {"type": "Image"}},
            "nodes": {"light": {"type": "exposure", "values": {"stops": 1.0}}},
            "links": {"light.image": "inputs.beauty", "outputs.image": "light.out"},
        }
        for section, entries in parts.items():
            tree[section] = {**tree.get(section, {}), **entries}
        path = tmp_path / name
        path.write_text(json.dumps(tree))
        return path

    return made


@pytest.fixture
def fails(cli, tmp_path):
    """`fails(code, *words)` runs a command that must fail and returns its sentence; an old output stays as it was."""

    def failing(code, *words, out="out.exr"):
        old = tmp_path / out
        fresh = not old.exists()
        if fresh:
            old.write_bytes(b"precious")
        before = old.read_bytes()
        said = cli(*words, *(("-o", old) if words[0] == "render" and "-o" not in words else ()))
        lines = [line for line in said.err.splitlines() if line.startswith("halation: ")]
        assert (said.code, said.out, len(lines)) == (code, "", 1), said
        assert "Traceback" not in said.err and "bug" not in said.err and said.err.splitlines()[-1] == lines[0]
        assert old.read_bytes() == before
        assert not list(tmp_path.glob(".halation-*")) and not list(tmp_path.glob("*.tmp"))
        same = cli(*words, *(("-o", old) if words[0] == "render" and "-o" not in words else ()), "--json")
        sentence = lines[0].removeprefix("halation: ")
        assert same.json["error"]["message"] == sentence and same.json["error"]["exit_code"] == same.code == code
        if fresh:
            old.unlink()
        return sentence

    return failing
