"""A small repository of graphs, and the command line on it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from commands import Cli, make_cli
from exr_files import write_exr

WIDTH, HEIGHT = 48, 32

Suite = Callable[..., Path]


@pytest.fixture
def cli(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Cli:
    """`cli("-k", "bloom")` runs `halation test` in the folder of the test."""
    monkeypatch.chdir(tmp_path)
    return make_cli(capfd, "test")


@pytest.fixture
def graph(tmp_path: Path) -> Callable[..., Path]:
    """`graph(stops=1.0)` writes graph.json: a picture with lights, exposed, and its depth as another output."""
    red = np.linspace(0.0, 1.0, WIDTH, dtype=np.float32)
    picture = np.full((HEIGHT, WIDTH, 4), (0.0, 0.25, 0.5, 1.0), np.float32)
    picture[..., 0] = red
    picture[4:6, 4:6, :3] = 40.0
    depth = np.repeat(np.arange(1, HEIGHT + 1, dtype=np.float32)[:, None, None], WIDTH, axis=1)
    write_exr(tmp_path / "shot.exr", {"Combined": picture, "Depth": depth}, {"Combined": "half", "Depth": "float"})

    def made(name: str = "graph.json", stops: float = 1.0) -> Path:
        path = tmp_path / name
        path.write_text(
            json.dumps(
                {
                    "halation": 1,
                    "inputs": {
                        "beauty": {"type": "Image", "file": "shot.exr", "layer": "Combined"},
                        "depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"},
                    },
                    "outputs": {"image": {"type": "Image"}, "depth": {"type": "Field"}},
                    "nodes": {"light": {"type": "exposure", "values": {"stops": stops}}},
                    "links": {
                        "light.image": "inputs.beauty",
                        "outputs.image": "light.out",
                        "outputs.depth": "inputs.depth",
                    },
                }
            )
        )
        return path

    made()
    return made


@pytest.fixture
def suite(tmp_path: Path, graph: Callable[..., Path]) -> Suite:
    """`suite("[cases.a] ...")` writes looks.suite.toml beside the graph."""

    def made(text: str, name: str = "looks.suite.toml") -> Path:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return made
