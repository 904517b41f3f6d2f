"""Standard output that is closed, full, or read by a program that has ended: the documented exit code, no traceback."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from oiio_pictures import write_picture
from selection import list_cases

GRAPH = {
    "halation": 1,
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"n": {"type": "read_image", "values": {"path": "a.exr"}}},
    "links": {"outputs.image": "n.out"},
}
PRINTING = (
    ("info", "a.exr", "--json"),
    ("info", "a.exr"),
    ("check", "g.json", "--json"),
    ("check", "--rules"),
    ("nodes",),
    ("explain", "g.json"),
    ("diff", "g.json", "g.json", "--json"),
    ("merge", "g.json", "g.json", "g.json"),
    ("render", "g.json", "-o", "b.exr", "--json"),
    ("reproduce", "b.exr", "--json"),
    ("--help",),
    ("render", "--help"),
    ("--version",),
)
LONG = (("nodes", "--json"), ("schema",))
"""These print much, by what prints the others too."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("streams")
    write_picture(folder / "a.exr", np.full((8, 8, 4), 0.5, np.float32))
    (folder / "g.json").write_text(json.dumps(GRAPH))
    return folder


def run(folder: Path, words: tuple[str, ...], **options: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-P", "-m", "halation.cli", *words]
    options = {"stdin": subprocess.DEVNULL, "stderr": subprocess.PIPE, **options}
    environment = {**os.environ, "LP_NUM_THREADS": "1"}
    return subprocess.run(command, cwd=folder, env=environment, text=True, timeout=120, **options)


def close(*descriptors: int) -> Callable[[], None]:
    return lambda: [os.close(descriptor) for descriptor in descriptors] and None


@pytest.fixture(scope="module")
def written(folder: Path) -> Path:
    assert run(folder, ("render", "g.json", "-o", "b.exr")).returncode == 0
    return folder


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX streams")
@pytest.mark.parametrize("words", list_cases(PRINTING, [(words,) for words in LONG]), ids=" ".join)
def test_every_command_that_prints(written, words):
    ended = run(written, words, preexec_fn=close(1))
    assert ended.returncode == 1 and "standard output is closed" in ended.stderr
    assert run(written, words, preexec_fn=close(0, 1, 2), stderr=None, stdin=None).returncode == 1
    if Path("/dev/full").exists():
        with Path("/dev/full").open("w") as full:
            ended = run(written, words, stdout=full)
        assert ended.returncode == 1 and "standard output" in ended.stderr
    reading, writing = os.pipe()
    os.close(reading)
    try:
        ended = run(written, words, stdout=writing)
    finally:
        os.close(writing)
    assert ended.returncode == 141 and "Traceback" not in ended.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX streams")
def test_a_render_that_prints_nothing_needs_no_output(folder):
    assert run(folder, ("render", "g.json", "-o", "b.exr"), preexec_fn=close(1)).returncode == 0
    assert run(folder, ("render", "g.json", "-o", "c.exr"), preexec_fn=close(0, 1, 2), stderr=None).returncode == 0
    assert (folder / "c.exr").stat().st_size == (folder / "b.exr").stat().st_size


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX streams")
def test_a_graph_from_an_input_that_is_closed(folder):
    ended = run(folder, ("check", "-"), preexec_fn=close(0), stdout=subprocess.PIPE)
    assert ended.returncode == 3 and "Traceback" not in ended.stderr
