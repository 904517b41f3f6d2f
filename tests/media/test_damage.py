"""What cannot be read is said in one sentence that names the file."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from halation.errors import InputError
from halation.media import read_info, read_layer, read_metadata
from halation.nodes import Kind
from halation.resources.input_files import content_hash, fingerprint
from halation.resources.sandbox import UNRESTRICTED

Make = Callable[..., Path]


def said(path: Path) -> str:
    """The sentence about a file that cannot be read."""
    with pytest.raises(InputError) as caught:
        read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    text = str(caught.value)
    assert str(path) in text and "\n" not in text
    return text


def test_missing(tmp_path: Path) -> None:
    (tmp_path / "shot.0012.exr").touch()
    assert "there is no such file, only shot.0012.exr" in said(tmp_path / "shot.0013.exr")
    assert "its folder is missing too" in said(tmp_path / "none/shot.exr")
    for function in (read_info, fingerprint, content_hash, read_metadata):
        with pytest.raises(InputError, match="none"):
            function(tmp_path / "none.exr", sandbox=UNRESTRICTED)


def test_folder(tmp_path: Path) -> None:
    assert "is a folder" in said(tmp_path)


def test_empty(tmp_path: Path) -> None:
    (tmp_path / "a.exr").touch()
    assert "is empty (0 bytes)" in said(tmp_path / "a.exr")


def test_text_in_disguise(tmp_path: Path) -> None:
    (tmp_path / "a.exr").write_text("this is no picture " * 50)
    assert "is not an EXR file" in said(tmp_path / "a.exr")
    (tmp_path / "a.png").write_text("this is no picture " * 50)
    assert "is no picture that can be read" in said(tmp_path / "a.png")
    (tmp_path / "notes.txt").write_text("neither is this")
    assert "is no picture that can be read" in said(tmp_path / "notes.txt")


@pytest.mark.parametrize("share", [0.02, 0.3, 0.6, 0.99])
def test_cut_short(make: Make, rng: np.random.Generator, share: float) -> None:
    path = make("a.exr", rng.random((64, 64, 4), np.float32))
    whole = path.read_bytes()
    path.write_bytes(whole[: int(len(whole) * share)])
    assert "is cut short or damaged" in said(path)


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.webp", "a.hdr"])
def test_cut_short_in_other_formats(make: Make, rng: np.random.Generator, name: str) -> None:
    path = make(name, rng.random((64, 64, 3), np.float32), format="float" if name == "a.hdr" else "uint8")
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    said(path)


def test_more_pixels_than_anyone_has(make: Make) -> None:
    path = make("a.exr", np.ones((2, 2, 3), np.float32), display=(0, 0, 100_000, 100_000))
    assert "claims to be 100000x100000 pixels" in said(path)


def test_flipped_bytes_never_crash(make: Make, rng: np.random.Generator) -> None:
    smooth = np.linspace(0, 1, 24 * 24 * 4, dtype=np.float32).reshape(24, 24, 4)
    path = make("a.exr", smooth, attributes={"compression": "zip"})
    whole = np.frombuffer(path.read_bytes(), np.uint8)
    refused = 0
    for _ in range(60):
        broken = whole.copy()
        broken[rng.integers(8, broken.size, 6)] = rng.integers(0, 256, 6)
        path.write_bytes(broken.tobytes())
        try:
            read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
        except InputError:
            refused += 1
    assert refused > 10


def subsampled(path: Path) -> Path:
    """The smallest EXR header with luminance at full and chroma at half resolution (OpenEXR file layout)."""

    def attribute(name: str, kind: str, data: bytes) -> bytes:
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    def channel(name: str, step: int) -> bytes:
        return name.encode() + b"\0" + struct.pack("<iB3xii", 1, 0, step, step)

    box = struct.pack("<4i", 0, 0, 3, 3)
    path.write_bytes(
        struct.pack("<ii", 20000630, 2)
        + attribute("channels", "chlist", channel("BY", 2) + channel("RY", 2) + channel("Y", 1) + b"\0")
        + attribute("compression", "compression", b"\0")
        + attribute("dataWindow", "box2i", box)
        + attribute("displayWindow", "box2i", box)
        + attribute("lineOrder", "lineOrder", b"\0")
        + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
        + attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
        + attribute("screenWindowWidth", "float", struct.pack("<f", 1))
        + b"\0"
        + bytes(400)
    )
    return path


def test_subsampled_color(tmp_path: Path) -> None:
    assert "stores color at a lower resolution than brightness" in said(subsampled(tmp_path / "yc.exr"))


def test_fingerprint_follows_the_file(make: Make, rng: np.random.Generator) -> None:
    path = make("a.exr", rng.random((4, 4, 4), np.float32))
    before, content = fingerprint(path, sandbox=UNRESTRICTED), content_hash(path, sandbox=UNRESTRICTED)
    assert before == fingerprint(path, sandbox=UNRESTRICTED) == read_info(path, sandbox=UNRESTRICTED).fingerprint
    path.write_bytes(path.read_bytes() + b"x")
    assert fingerprint(path, sandbox=UNRESTRICTED) != before and content_hash(path, sandbox=UNRESTRICTED) != content


def test_content_hash_is_sha256(tmp_path: Path) -> None:
    (tmp_path / "abc").write_bytes(b"abc")
    assert (
        content_hash(tmp_path / "abc", sandbox=UNRESTRICTED)
        == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    )
