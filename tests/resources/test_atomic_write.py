"""A file is replaced whole or not at all."""

from __future__ import annotations

import errno
import os
import shutil
import sys
from collections import namedtuple
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from halation.errors import OutputError
from halation.media import read_layer, write_picture
from halation.nodes import Kind
from halation.resources.atomic_write import write_atomically
from halation.resources.sandbox import UNRESTRICTED

NAMES = ["a.exr", "a.png", "a.jpg", "a.webp", "a.tif", "a.hdr"]
PICTURE = {"image": np.random.default_rng(3).random((40, 50, 4), np.float32)}
KINDS = {"image": Kind.IMAGE}


def failed(path: Path) -> str:
    """The sentence of a write that fails, after which nothing else has changed."""
    before = {item.name: item.read_bytes() for item in path.parent.iterdir()} if path.parent.is_dir() else {}
    with pytest.raises(OutputError) as caught:
        write_picture(path, PICTURE, kinds=KINDS, sandbox=UNRESTRICTED)
    if path.parent.is_dir():
        assert {item.name: item.read_bytes() for item in path.parent.iterdir()} == before
    assert str(path) in str(caught.value) and "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("name", NAMES)
def test_a_full_disk_is_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    (tmp_path / name).write_bytes(b"old")

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(shutil, "copyfileobj", full)
    monkeypatch.setattr(os, "posix_fallocate", full, raising=False)
    monkeypatch.setattr(os, "fsync", full)
    assert "the disk is full" in failed(tmp_path / name)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("name", NAMES)
def test_a_device_without_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """The bytes really go to a full device: only the name of the temporary file is bent."""
    plain = Path.open

    def bent(self: Path, mode: str = "r", *rest: Any, **named: Any) -> Any:
        return plain(Path("/dev/full") if mode == "r+b" else self, mode, *rest, **named)

    monkeypatch.setattr(Path, "open", bent)
    (tmp_path / name).write_bytes(b"old")
    with pytest.raises(OutputError, match="the disk is full"):
        write_picture(tmp_path / name, PICTURE, kinds=KINDS, sandbox=UNRESTRICTED)
    monkeypatch.undo()
    assert [item.name for item in tmp_path.iterdir()] == [name] and (tmp_path / name).read_bytes() == b"old"


@pytest.mark.parametrize("name", NAMES)
def test_systems_without_memory_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.delattr(os, "memfd_create", raising=False)
    write_picture(tmp_path / name, PICTURE, kinds=KINDS, sandbox=UNRESTRICTED)
    assert read_layer(tmp_path / name, "", Kind.IMAGE, sandbox=UNRESTRICTED).array.shape == (40, 50, 4)
    assert [item.name for item in tmp_path.iterdir()] == [name]
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage(10**9, 10**9, 1000))
    assert "the disk is full" in failed(tmp_path / name)


def test_an_encoder_that_gives_up(tmp_path: Path) -> None:
    (tmp_path / "a.exr").write_bytes(b"old")

    def encode(file: str) -> None:
        Path(file).write_bytes(b"half of it")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_atomically(tmp_path / "a.exr", encode, 100, sandbox=UNRESTRICTED)
    assert [(item.name, item.read_bytes()) for item in tmp_path.iterdir()] == [("a.exr", b"old")]


def test_an_encoder_that_writes_nothing(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="the disk is full"):
        write_atomically(tmp_path / "a.exr", lambda file: None, 100, sandbox=UNRESTRICTED)
    assert not [*tmp_path.iterdir()]


def test_what_an_encoder_refuses(tmp_path: Path) -> None:
    wide = {"image": np.zeros((1, 20000, 3), np.float32)}
    with pytest.raises(OutputError, match=r"a\.webp: cannot be written: "):
        write_picture(tmp_path / "a.webp", wide, kinds=KINDS, sandbox=UNRESTRICTED)
    assert not [*tmp_path.iterdir()]


def test_missing_folder(tmp_path: Path) -> None:
    assert "there is no such folder: create it first" in failed(tmp_path / "none/a.exr")


def test_a_file_in_the_way(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert "part of the path is a file" in failed(tmp_path / "file/a.exr")
    (tmp_path / "folder.exr").mkdir()
    with pytest.raises(OutputError, match="is a folder"):
        write_picture(tmp_path / "folder.exr", PICTURE, kinds=KINDS, sandbox=UNRESTRICTED)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the super-user may write anywhere")
def test_a_folder_that_may_not_be_written(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        assert "may not be written" in failed(tmp_path / "a.exr")
    finally:
        tmp_path.chmod(0o700)


@pytest.mark.parametrize(("code", "sentence"), [(errno.EACCES, "may not be written"), (errno.EROFS, "is read-only")])
def test_a_folder_that_refuses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int, sentence: str) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(OutputError, match=sentence):
        write_picture(tmp_path / "a.exr", PICTURE, kinds=KINDS, sandbox=UNRESTRICTED)
    monkeypatch.undo()
    assert not [*tmp_path.iterdir()]


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_link_keeps_pointing(tmp_path: Path) -> None:
    (tmp_path / "shelf").mkdir()
    (tmp_path / "shelf/a.exr").write_bytes(b"old")
    (tmp_path / "a.exr").symlink_to(tmp_path / "shelf/a.exr")
    write_picture(tmp_path / "a.exr", PICTURE, kinds=KINDS, sandbox=UNRESTRICTED)
    assert (tmp_path / "a.exr").is_symlink()
    assert read_layer(tmp_path / "shelf/a.exr", "", Kind.IMAGE, sandbox=UNRESTRICTED).array.shape == (40, 50, 4)


@pytest.mark.skipif(sys.platform == "win32", reason="rights are not modes there")
def test_rights_are_those_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "other").touch()
    write_picture(tmp_path / "a.png", PICTURE, kinds=KINDS, sandbox=UNRESTRICTED)
    assert (tmp_path / "a.png").stat().st_mode == (tmp_path / "other").stat().st_mode
