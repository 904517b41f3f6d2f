"""What the inspector shows of files: headers and small pictures, read in a thread."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from halation.color.management import get_default_color_manager
from halation.editor.inspector.layers import Layers, describe_layer, small_picture
from halation.media import ImageInfo, read_info, write_picture
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED


@pytest.fixture
def layers():
    made = Layers(sandbox=UNRESTRICTED)
    yield made
    made.close()


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    path = tmp_path / "picture.exr"
    depth = np.linspace(5.0, 25.0, 40 * 200, dtype=np.float32).reshape(40, 200, 1)
    depth[0, 0] = np.inf
    color = np.full((40, 200, 4), 1.0, np.float32)
    write_picture(
        path, {"beauty": color, "depth": depth}, kinds={"beauty": Kind.IMAGE, "depth": Kind.FIELD}, sandbox=UNRESTRICTED
    )
    return path


def waited(ask):
    end = time.monotonic() + 120.0
    while (found := ask()) is None and time.monotonic() < end:
        time.sleep(0.01)
    return found


def test_headers_and_pictures_come_later(layers, picture):
    assert layers.header(picture) is None
    header = waited(lambda: layers.header(picture))
    assert isinstance(header, ImageInfo) and [layer.name for layer in header.layers] == ["beauty", "depth"]
    color = waited(lambda: layers.picture(picture, "beauty"))
    assert color.shape == (14, 67, 3) and color.dtype == np.uint8 and (color == 255).all()
    assert not layers.busy


def test_data_is_shown_from_its_lowest_to_its_highest(picture):
    small = small_picture(str(picture), "depth", read_info(picture, sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    assert small[0, 1].max() < 5 and small[-1, -1].min() > 245
    seen = np.linspace(5.0, 25.0, 40 * 200).reshape(40, 200)[::3, ::3]
    low, high = seen.ravel()[1], seen[-1, -1]
    np.testing.assert_allclose(small[1:, :, 0], 255.0 * (seen[1:] - low) / (high - low), atol=0.51)
    assert (small[0, 0] == 255).all()


def test_a_missing_file_is_a_sentence(layers, tmp_path):
    found = layers.header(tmp_path / "gone.exr")
    assert isinstance(found, str) and "there is no such file" in found
    assert layers.picture(tmp_path / "gone.exr", "beauty") is None


def test_a_damaged_file_is_a_sentence(layers, tmp_path):
    path = tmp_path / "broken.exr"
    path.write_bytes(b"no picture at all")
    assert isinstance(waited(lambda: layers.header(path)), str)


def test_another_file_under_the_same_name_is_read_again(layers, picture, monkeypatch):
    monkeypatch.setattr("halation.watch.versions.LOOK_AGAIN", 0.0)
    before = waited(lambda: layers.header(picture))
    write_picture(picture, {"new": np.zeros((2, 3, 4), np.float32)}, kinds={"new": Kind.IMAGE}, sandbox=UNRESTRICTED)
    after = waited(lambda: layers.header(picture))
    assert (before.size, after.size) == ((200, 40), (3, 2))


def test_the_line_about_a_file(picture):
    header = read_info(picture, sandbox=UNRESTRICTED)
    assert describe_layer(header, "") == "200 x 40, RGBA, float16, color"
    assert describe_layer(header, "depth") == "200 x 40, Z, float32, data"
    assert describe_layer(header, "Deep").startswith("has no layer 'Deep'")


def test_a_space_that_is_not_known_yet_is_no_error(layers, picture, monkeypatch):
    manager = get_default_color_manager()
    assert layers.space(picture, "beauty", manager, "auto") == ("", False)
    for spaces, expected in (("no such space", ("no such space", True)), ({}, ("", False))):
        monkeypatch.setattr(layers._spaces, "get", lambda key, spaces=spaces: spaces)
        waited(lambda: layers.header(picture))
        assert layers.space(picture, "beauty", manager, "auto") == expected
        assert layers.space(picture, "nowhere", manager, "auto") == expected
