"""Files whose names are no UTF-8: read, written, named in messages, in JSON and in headers."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from halation.media import read_layer
from halation.media.meshes.load import load_mesh
from halation.nodes import Kind, SceneFile
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import write_picture

pytestmark = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="names of files are bytes on Linux only")
ODD = os.fsdecode(b"\xff\xfe-caf\xe9")
GRAPH = {
    "halation": 1,
    "inputs": {"beauty": {"type": "Image", "file": "plain.exr"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"n": {"type": "exposure"}},
    "links": {"outputs.image": "n.out", "n.image": "inputs.beauty"},
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    odd = tmp_path / f"folder{ODD}"
    odd.mkdir()
    for ending in ("exr", "png", "tif"):
        write_picture(tmp_path / f"plain.{ending}", np.full((8, 8, 4), 0.5, np.float32))
        (odd / f"in{ODD}.{ending}").write_bytes((tmp_path / f"plain.{ending}").read_bytes())
    (odd / "plain.exr").write_bytes((tmp_path / "plain.exr").read_bytes())
    (odd / f"g{ODD}.json").write_text(json.dumps(GRAPH))
    return odd


def test_pictures_are_read(folder):
    for ending in ("exr", "png", "tif"):
        assert read_layer(folder / f"in{ODD}.{ending}", "", Kind.IMAGE, sandbox=UNRESTRICTED).array.shape == (8, 8, 4)


@pytest.mark.parametrize("ending", ["exr", "png", "jpg", "tif", "webp", "hdr", "dpx"])
def test_rendering(cli, folder, ending):
    graph, picture, out = folder / f"g{ODD}.json", folder / f"in{ODD}.exr", folder / f"out{ODD}.{ending}"
    ended = cli("render", graph, "-i", f"beauty={picture}", "-o", out, "--json")
    assert ended.code == 0 and out.stat().st_size > 0
    assert cli("info", out, "--json").json["format"]
    if ending == "exr":
        ended = cli("reproduce", out)
        assert ended.code == 3 and "not valid Unicode" in ended.err  # no graph can name such a file


def test_every_command(cli, folder):
    graph, picture = folder / f"g{ODD}.json", folder / f"in{ODD}.exr"
    (folder / f"shot{ODD}.0001.exr").write_bytes(picture.read_bytes())
    for words in (
        ("info", picture),
        ("info", picture, "--json"),
        ("info", folder / f"shot{ODD}.####.exr"),
        ("check", graph),
        ("check", graph, "--json"),
        ("check", folder),
        ("explain", graph),
        ("diff", graph, graph),
        ("fmt", graph),
    ):
        ended = cli(*words)
        assert ended.code == 0, (words, ended.err)


def test_a_process_prints_them(folder):
    """The streams of a process take UTF-8 only, unless they are told otherwise."""
    for words, code in (
        (("info", folder / f"in{ODD}.exr"), 0),
        (("check", folder), 0),
        (("info", folder / f"missing{ODD}.exr"), 4),
    ):
        command = [sys.executable, "-P", "-m", "halation.cli", *map(str, words)]
        ended = subprocess.run(command, capture_output=True, timeout=60, check=False)
        assert ended.returncode == code, ended.stderr
        assert b"\\udcff" in ended.stdout + ended.stderr and b"bug in Halation" not in ended.stderr


@pytest.mark.parametrize("words", [("info",), ("check",), ("render", "-o", "x.exr"), ("fmt",), ("explain",)])
@pytest.mark.parametrize("ending", ["exr", "json"])
def test_what_is_missing_or_damaged_is_named(cli, tmp_path, words, ending):
    missing = tmp_path / f"missing{ODD}.{ending}"
    ended = cli(words[0], missing, *words[1:], "--json")
    assert ended.code in (2, 3, 4) and "bug" not in ended.err
    missing.write_bytes(b"rubbish" * 50)
    ended = cli(words[0], missing, *words[1:])
    assert ended.code in (2, 3, 4) and "bug" not in ended.err


def test_large_pictures_by_rows(cli, folder):
    out = folder / f"rows{ODD}.exr"
    graph = GRAPH | {"settings": {"size": [400, 300]}}
    (folder / "large.json").write_text(json.dumps(graph))
    ended = cli("render", folder / "large.json", "-o", out, "--size", "400x300", "--memory", "1M")
    assert ended.code == 0 and out.stat().st_size > 0


def test_meshes_and_tables(folder, cli):
    mesh = folder / f"mesh{ODD}.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert len(load_mesh(SceneFile(str(mesh)), sandbox=UNRESTRICTED).indices) == 3
    table = "LUT_3D_SIZE 2\n" + "".join(f"{r} {g} {b}\n" for b in (0, 1) for g in (0, 1) for r in (0, 1))
    for name, content in (
        ("lut.cube", table.encode()),
        ("latin.cube", b"# caf\xe9\n" + table.encode()),
        ("bad.cube", table.encode() + b"caf\xe9 1 2\n"),
    ):
        (folder / name).write_bytes(content)
        nodes = {"n": {"type": "lut_file", "values": {"file": name}}, "s": {"type": "noise"}}
        graph = GRAPH | {"inputs": {}, "nodes": nodes, "links": {"outputs.image": "n.out", "n.image": "s.out"}}
        (folder / "lut.json").write_text(json.dumps(graph | {"settings": {"size": [8, 8]}}))
        ended = cli("render", folder / "lut.json", "-o", folder / "lut.exr")
        assert ended.code == (4 if name == "bad.cube" else 0), ended.err
