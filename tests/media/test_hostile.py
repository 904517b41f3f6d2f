"""Files that are damaged or meant to do harm: pixels or one sentence, and never more than there is room for."""

from __future__ import annotations

import os
import struct
import subprocess
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from halation import media
from halation.errors import InputError, OutputError
from halation.nodes import Kind
from halation.render_layers.analysis import analyze_render
from halation.resources.input_files import content_hash, fingerprint
from halation.resources.sandbox import UNRESTRICTED

Make = Callable[..., Path]

FUZZER = Path(__file__).with_name("fuzzed.py")
COPIES = 25
FORMATS = {
    "zip.exr": ("half", {"compression": "zip"}),
    "piz.exr": ("half", {"compression": "piz"}),
    "b44.exr": ("half", {"compression": "b44"}),
    "dwaa.exr": ("half", {"compression": "dwaa"}),
    "a.tif": ("uint8", {"compression": "lzw"}),
    "f.tif": ("float", {"compression": "zip"}),
    "a.png": ("uint8", {}),
    "a16.png": ("uint16", {}),
    "a.jpg": ("uint8", {}),
    "a.hdr": ("float", {}),
    "a.dpx": ("uint16", {}),
    "a.webp": ("uint8", {}),
    "a.tga": ("uint8", {}),
    "a.bmp": ("uint8", {}),
}


def test_damaged_pictures_are_read_or_refused(make: Make, tmp_path: Path) -> None:
    """In a process of their own, which a crash in a library would end."""
    smooth = np.linspace(0.0, 1.0, 20 * 24 * 3, dtype=np.float32).reshape(20, 24, 3)
    files = [make(name, smooth, format=kind, attributes=more) for name, (kind, more) in FORMATS.items()]
    words = [sys.executable, str(FUZZER), str(COPIES), *map(str, files)]
    result = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, f"{result.stdout[-300:]}\n{result.stderr[-2000:]}"
    assert COPIES < int(result.stdout.split()[-1]) < 4 * COPIES * len(FORMATS)  # some are still whole, some are not


def png(path: Path, width: int, height: int) -> Path:
    """A black picture that is as small as its size allows."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    squeeze = zlib.compressobj(9)
    rows = b"".join(squeeze.compress(bytes(1 + 4 * width)) for _ in range(min(height, 4000))) + squeeze.flush()
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b""))
    return path


def test_a_header_may_claim_anything(tmp_path: Path) -> None:
    path = png(tmp_path / "a.png", 1_000_000, 1)
    path.write_bytes(path.read_bytes().replace(struct.pack(">II", 1_000_000, 1), struct.pack(">II", 10**6, 10**6)))
    with pytest.raises(InputError) as caught:
        media.read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    assert "claims to be 1000000x1000000" in str(caught.value) or "no picture" in str(caught.value)


def test_a_small_file_that_is_a_large_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = png(tmp_path / "a.png", 3000, 2000)
    assert path.stat().st_size < 50_000
    monkeypatch.setenv("HALATION_MAX_PIXELS", "5999999")
    with pytest.raises(InputError, match=r"3000x2000 pixels, more than .*: if that is right, set HALATION_MAX_PIXELS"):
        media.read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    monkeypatch.setenv("HALATION_MAX_PIXELS", "6000000")
    assert media.read_layer(path, "", Kind.FIELD, sandbox=UNRESTRICTED).array.shape == (2000, 3000, 1)
    monkeypatch.setenv("HALATION_MAX_PIXELS", "many")
    assert media.read_info(path, sandbox=UNRESTRICTED).size == (3000, 2000)


@pytest.mark.skipif(not hasattr(os, "sysconf"), reason="nobody knows how much memory there is")
def test_more_than_the_machine_holds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = png(tmp_path / "a.png", 3000, 2000)
    there = {"SC_PHYS_PAGES": 1 << 15, "SC_PAGE_SIZE": 4096}  # 128 MiB
    monkeypatch.setattr(os, "sysconf", there.__getitem__)
    with pytest.raises(InputError, match=r"3000x2000 pixels of 4 channels take 0 GiB, and this machine has 0"):
        media.read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)


@pytest.mark.parametrize(
    "name",
    [
        "two words.png",
        'it\'s "quoted".png',
        "new\nline.png",
        "tab\t.png",
        "🎬 фильм 電影.png",
        "-rf.png",
        "%s%n.png",
        "$HOME.png",
        "a:b.png",
        "#.png",
        "x" * 200 + ".png",
        "\u202egnp.png",
        "é.png",
        "e\u0301.png",
        ".png.png",
    ],
)
def test_odd_names(tmp_path: Path, name: str) -> None:
    picture = np.full((4, 6, 4), 0.5, np.float32)
    path = tmp_path / name
    media.write_picture(path, {"image": picture}, kinds={"image": Kind.IMAGE}, sandbox=UNRESTRICTED)
    assert media.read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array.shape == (4, 6, 4)
    assert media.find_frame_file(str(path), 7, sandbox=UNRESTRICTED).path == str(path)
    media.write_picture(path.with_suffix(".exr"), {"image": picture}, kinds={"image": Kind.IMAGE}, sandbox=UNRESTRICTED)
    assert media.read_info(path.with_suffix(".exr"), sandbox=UNRESTRICTED).size == (6, 4)


@pytest.mark.parametrize("name", ["x" * 300 + ".png", "a\x00b.png", "/dev/zero", "/dev/stdin", "/proc/self/mem"])
def test_names_of_no_pictures(tmp_path: Path, name: str) -> None:
    for act in (
        media.read_info,
        lambda path, sandbox: media.read_layer(path, "", Kind.IMAGE, sandbox=sandbox),
        fingerprint,
    ):
        try:
            act(tmp_path / name, sandbox=UNRESTRICTED)
        except InputError as fault:
            assert "\x00" not in str(fault)
        else:
            assert act is fingerprint


def test_a_pipe_is_no_picture(tmp_path: Path) -> None:
    if not hasattr(os, "mkfifo"):
        pytest.skip("this system has no such pipes")
    os.mkfifo(tmp_path / "a.exr")
    with pytest.raises(InputError, match="is a FIFO"):
        media.read_layer(tmp_path / "a.exr", "", Kind.IMAGE, sandbox=UNRESTRICTED)


def test_a_playlist_is_no_video(tmp_path: Path) -> None:
    """It would lead to other files, and to the network."""
    pytest.importorskip("av", reason="PyAV is not installed: pip install halation[video]")
    from videos import write_numbers

    video = write_numbers(tmp_path / "a.mkv", "ffv1", "bgr0", 2)
    for name, text in (
        ("a.mp4", f"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n{video}\n#EXT-X-ENDLIST\n"),
        ("b.mp4", f"ffconcat version 1.0\nfile '{video.name}'\n"),
        ("c.mp4", "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 5004 RTP/AVP 96\n"),
    ):
        (tmp_path / name).write_text(text)
        with pytest.raises(InputError, match=r"is no video|cannot be read as a video"):
            media.read_info(tmp_path / name, sandbox=UNRESTRICTED)


def test_nothing_is_read_or_written_outside_of_a_fence(tmp_path: Path, make: Make) -> None:
    inside = tmp_path / "in"
    inside.mkdir()
    picture = np.ones((4, 6, 3), np.float32)
    out = make("out.0001.exr", picture)
    (inside / "link.exr").symlink_to(out)
    (inside / "shot.0001.exr").symlink_to(out)
    sandbox = UNRESTRICTED.narrow(inside)
    for path in (out, inside / ".." / out.name, inside / "link.exr", inside / "shot.0001.exr"):
        for act in (media.read_info, media.read_metadata, analyze_render, fingerprint, content_hash):
            with pytest.raises(InputError, match="lies outside of"):
                act(path, sandbox=sandbox)
        with pytest.raises(InputError, match="lies outside of"):
            media.read_layer(path, "", Kind.IMAGE, sandbox=sandbox)
    with pytest.raises(InputError, match="lies outside of"):
        media.find_sequence(str(tmp_path / "out.####.exr"), sandbox=sandbox)
    with pytest.raises(InputError, match="lies outside of"):
        media.read_layer(
            media.find_frame_file(str(inside / "shot.####.exr"), 1, sandbox=sandbox).path,
            "",
            Kind.IMAGE,
            sandbox=sandbox,
        )
    for path in (tmp_path / "new.exr", inside / "../new.exr", inside / "link.exr"):
        with pytest.raises(OutputError, match="lies outside of"):
            media.write_picture(path, {"image": picture}, kinds={"image": Kind.IMAGE}, sandbox=sandbox)
    media.write_picture(inside / "new.exr", {"image": picture}, kinds={"image": Kind.IMAGE}, sandbox=sandbox)
    assert media.read_info(inside / "new.exr", sandbox=sandbox).size == (6, 4)
