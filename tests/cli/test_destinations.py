"""Destinations that cannot be are refused before anything is rendered; what cannot be finished leaves no trace."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation import renderer

LONG = "n" * 300 + ".exr"


@pytest.fixture
def no_pass(monkeypatch):
    def refuse(*_):
        raise AssertionError("rendered for nothing")

    monkeypatch.setattr(renderer.Runner, "start_run", refuse)


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (("-o", "{tmp}/no/out.exr"), 1, "{tmp}/no/out.exr: cannot be written: there is no such folder: create it"),
        (
            ("-o", "{tmp}/shot.exr/out.exr"),
            1,
            "{tmp}/shot.exr/out.exr: cannot be written: part of the path is a file, not a folder",
        ),
        (("-o", "{tmp}"), 2, "{tmp}: its name has no ending that says what to write: use one of .exr, "),
        (("-o", f"{{tmp}}/{LONG}"), 1, f"{{tmp}}/{LONG}: cannot be written: the name is too long"),
        (("-o", "{tmp}/out.xyz"), 2, "{tmp}/out.xyz: cannot write '.xyz' files: use one of .exr, .png"),
        (("-o", "{tmp}/out.png", "--view", "filmc"), 2, "there is no view 'filmc'"),
        (
            ("-o", "{tmp}/out.exr", "--compression", "zap"),
            2,
            "{tmp}/out.exr: there is no compression 'zap': did you mean 'zip'?",
        ),
        (("-o", "{tmp}/out.exr", "-o", "{tmp}/./out.exr"), 2, "-o {tmp}/out.exr: this file is given twice"),
        (("-o", "{tmp}/out.exr", "-o", "image={tmp}/out.exr"), 2, "-o {tmp}/out.exr: this file is given twice"),
        (("-o", "imgae={tmp}/out.exr"), 2, "-o imgae={tmp}/out.exr: there is no output 'imgae'; did you mean 'image'?"),
        (("-o", "{tmp}/shot.exr"), 2, "{tmp}/shot.exr: this file is read by 'beauty'; write to another"),
        (("-o", "{tmp}/link.exr"), 2, "{tmp}/link.exr: this file is read by 'beauty'; write to another"),
        (("-o", "image="), 2, "-o image=: write -o FILE or -o NAME=FILE"),
    ],
)
def test_a_destination_that_cannot_be(fails, no_pass, graphs, shot, tmp_path, words, code, sentence):
    (tmp_path / "link.exr").symlink_to(shot)
    before = shot.read_bytes()
    said = fails(code, "render", graphs(), *(word.replace("{tmp}", str(tmp_path)) for word in words))
    assert said.startswith(sentence.replace("{tmp}", str(tmp_path)))
    assert shot.read_bytes() == before


def test_one_picture_for_two_outputs(fails, no_pass, graphs, tmp_path):
    two = {"outputs": {"image": {"type": "Image"}, "raw": {"type": "Image"}}, "links": {"outputs.raw": "inputs.beauty"}}
    said = fails(2, "render", graphs(**two), "-o", tmp_path / "two.png")
    assert said == (
        f"{tmp_path / 'two.png'}: .png holds one picture, but the graph has the outputs image, raw; "
        f"choose one with -o image={tmp_path / 'two.png'}"
    )
    said = fails(2, "render", graphs(**two), "-o", f"raw={tmp_path / 'a.png'}", "-o", f"image={tmp_path / 'a.png'}")
    assert "this file is given twice" in said
    two["outputs"]["raw"]["layer"] = "image"
    assert "have the same layer 'image'" in fails(2, "render", graphs(**two))


def test_vectors_are_no_picture(fails, no_pass, graphs, tmp_path):
    path = graphs(nodes={"noise": {"type": "noise"}})
    said = fails(2, "render", path, "--node", "noise.vector", "-o", tmp_path / "v.png")
    assert said == f"{tmp_path / 'v.png'}: vectors are data, not a picture: write them to an .exr file"


def test_layers_of_several_sizes(fails, no_pass, graphs, tmp_path):
    assert oiio.ImageBuf(np.zeros((5, 7, 3), np.float32)).write(str(tmp_path / "small.exr"))
    path = graphs(
        inputs={"small": {"type": "Image", "file": "small.exr"}},
        outputs={"small": {"type": "Image"}},
        links={"outputs.small": "inputs.small"},
    )
    assert "layers of one size, but there are 'image' 48x32, 'small' 7x5" in fails(2, "render", path)


@pytest.mark.skipif(os.name == "nt", reason="folders have no such mode")
def test_a_folder_that_may_not_be_written(graphs, shot):
    """As another user, where we are root: nothing is locked to root."""
    root = os.getuid() == 0
    python = [*(("setpriv", "--reuid=65534", "--clear-groups") if root else ()), sys.executable]
    if root and (not shutil.which("setpriv") or subprocess.run([*python, "-c", "import halation.cli"]).returncode):
        pytest.skip("another user cannot run this checkout")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file in (shot, graphs()):
            shutil.copy(file, folder)
        old = folder / "out.exr"
        old.write_bytes(b"precious")
        folder.chmod(0o555)
        command = [*python, "-m", "halation.cli", "render", "graph.json", "-o", "out.exr"]
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        folder.chmod(0o755)
        said = "halation: out.exr: cannot be written: the folder may not be written: choose another"
        said = f"{said}; the old file is unchanged"
        assert (result.returncode, result.stderr.splitlines()[-1]) == (1, said)
        assert old.read_bytes() == b"precious" and len(list(folder.iterdir())) == 3


def test_a_full_disk(fails, graphs, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full, raising=False)
    monkeypatch.setattr(shutil, "disk_usage", full)
    said = fails(1, "render", graphs())
    assert "out.exr: cannot be written: the disk is full: make room or write elsewhere" in said


def test_interrupted_while_writing(fails, graphs, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "sendfile", interrupted, raising=False)
    monkeypatch.setattr(shutil, "disk_usage", interrupted)
    assert fails(130, "render", graphs()) == "interrupted; no unfinished file is left"


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() != 0 or not shutil.which("mount"), reason="needs root")
def test_a_disk_that_is_really_full(fails, graphs, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)], capture_output=True).returncode:
        pytest.skip("this machine does not let us mount")
    try:
        old = disk / "old.exr"
        old.write_bytes(b"precious")
        nodes = {"noise": {"type": "noise", "values": {"kind": "white", "size": 1.0}}}
        path = graphs(nodes=nodes, links={"outputs.image": "noise.out"})
        for ending in (".exr", ".png", ".jpg", ".tif", ".webp"):
            target = old if ending == ".exr" else disk / f"new{ending}"
            said = fails(1, "render", path, "--size", "640x480", "-o", target)
            assert said.startswith(f"{target}: cannot be written: the disk is full: make room or write elsewhere")
            assert [item.name for item in disk.iterdir()] == ["old.exr"] and old.read_bytes() == b"precious"
    finally:
        subprocess.run(["umount", str(disk)], check=True)
