"""Thumbnails of files, in memory and on disk."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from halation.editor.toolkit.thumbnails import FileThumbnails
from halation.errors import InputError
from halation.media import write_picture
from halation.media.pictures.file_endings import list_readable_endings
from halation.media.pictures.thumbnail import load_thumbnail, read_thumbnail, save_thumbnail
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED


def picture(path: Path, value: float, width: int = 400, height: int = 100) -> Path:
    array = np.full((height, width, 4), value, np.float32)
    array[..., 3] = 1.0
    write_picture(path, {"image": array}, kinds={"image": Kind.IMAGE}, view="none", sandbox=UNRESTRICTED)
    return path


def ready(pictures: FileThumbnails, path: Path, at: float = 1.0):
    end = time.monotonic() + 120
    while (found := pictures.get(path, at)) is None:
        assert time.monotonic() < end
        time.sleep(0.005)
    return found


def test_a_thumbnail_keeps_the_shape_and_the_color(tmp_path: Path) -> None:
    small = read_thumbnail(picture(tmp_path / "a.png", 0.2140), 64, 64, sandbox=UNRESTRICTED)
    assert small.shape == (16, 64, 3)
    assert np.abs(small.astype(int) - 128).max() <= 1


def test_small_pictures_are_not_enlarged(tmp_path: Path) -> None:
    assert read_thumbnail(picture(tmp_path / "a.png", 0.5, 8, 4), 64, 64, sandbox=UNRESTRICTED).shape == (4, 8, 3)


def test_light_is_seen_through_the_view(tmp_path: Path) -> None:
    """Light eight times as bright as white is still told from white."""
    bright, white = (
        read_thumbnail(picture(tmp_path / f"{at}.exr", at), 64, 64, sandbox=UNRESTRICTED) for at in (8.0, 1.0)
    )
    assert bright.mean() > white.mean() + 10
    assert white.mean() < 254


def test_saved_and_loaded(tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).integers(0, 255, (5, 7, 3)).astype(np.uint8)
    save_thumbnail(tmp_path / "a.png", pixels, sandbox=UNRESTRICTED)
    assert np.array_equal(load_thumbnail(tmp_path / "a.png", sandbox=UNRESTRICTED), pixels)
    (tmp_path / "b.png").write_bytes(b"no")
    for name, reason in (("b.png", "not a picture of 8 bits"), ("c.png", "there is no such file")):
        with pytest.raises(InputError, match=reason):
            load_thumbnail(tmp_path / name, sandbox=UNRESTRICTED)


def test_what_was_decoded_is_kept_for_the_next_time(tmp_path: Path) -> None:
    file, kept = picture(tmp_path / "a.exr", 0.5), tmp_path / "kept"
    first = FileThumbnails(kept, sandbox=UNRESTRICTED)
    made = ready(first, file)
    first.close()
    assert len(list(kept.iterdir())) == 1
    file.unlink()
    again = FileThumbnails(kept, sandbox=UNRESTRICTED)
    assert np.array_equal(ready(again, file), made)
    assert isinstance(ready(again, file, 2.0), str)
    again.close()


def test_what_is_no_picture_has_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"this is text")
    pictures = FileThumbnails(tmp_path / "kept", sandbox=UNRESTRICTED)
    found = ready(pictures, tmp_path / "a.png")
    pictures.close()
    assert isinstance(found, str)
    assert "a.png" in found
    assert not (tmp_path / "kept").exists()


def test_only_what_was_asked_for_last_waits(tmp_path: Path) -> None:
    pictures = FileThumbnails(tmp_path, sandbox=UNRESTRICTED)
    for index in range(500):
        pictures.get(tmp_path / f"missing{index}.png", 0.0)
    assert isinstance(ready(pictures, tmp_path / "missing499.png", 0.0), str)
    pictures.forget()
    assert not pictures.busy
    pictures.close()


def test_pictures_are_told_by_their_endings() -> None:
    assert {".exr", ".png", ".jpg", ".tif", ".hdr", ".webp"} <= list_readable_endings()
    assert not {".json", ".null", ".py", ""} & list_readable_endings()
