"""Tokens in texts that are drawn."""

from __future__ import annotations

import numpy as np
import pytest
from halation.compiler.lowering.text_tokens import TokenSources, expand_tokens, write_timecode
from halation.errors import GraphError
from halation.resources.today import read_date
from msgspec import Struct


class Clock(Struct):
    """A time."""

    frame: int = 90061
    rate: float = 25.0
    start: int = 1
    size: tuple[int, int] = (1920, 1080)


SOURCES = TokenSources(
    lambda: "shots/a.0001.exr", lambda path: {"Make": f"maker of {path}"}, lambda: pytest.fail("nobody asked")
)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("plain", "plain"),
        ("{frame}", "90061"),
        ("{frame:8}", "00090061"),
        ("{ timecode }", "01:00:02:11"),
        ("{seconds} at {rate}", "3602.40 at 25"),
        ("{size}", "1920x1080"),
        ("{file} in {path}", "a.0001.exr in shots/a.0001.exr"),
        ("{meta:make}|{meta:Model}", "maker of shots/a.0001.exr|"),
        ("{=frame / 2}, {=floor(time)}", "45030.5, 3602"),
        ("{{frame}}", "{frame}"),
    ],
)
def test_tokens(text, expected):
    assert expand_tokens(text, Clock(), SOURCES) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{frames}", "token '{frames}', which is unknown"),
        ("{frame:x}", "token '{frame:x}', which is unknown"),
        ("{frame:99}", "is unknown"),
        ("{=1 +}", "1 \\+"),
        ("{=glow.size}", "uses 'glow.size', which it cannot"),
        ("100} off", "a single '}': write }} for"),
    ],
)
def test_faults(text, words):
    with pytest.raises(GraphError, match=words.replace("{", r"\{").replace("}", r"\}")):
        expand_tokens(text, Clock(), SOURCES)


def test_without_a_file_names_are_empty():
    nothing = TokenSources(lambda: "", lambda path: pytest.fail(path), lambda: "")
    assert expand_tokens("[{file}{path}{meta:Make}]", Clock(), nothing) == "[]"


def test_timecode_counts_whole_frames():
    assert [write_timecode(*pair) for pair in ((0, 24.0), (23, 24.0), (24, 24.0), (-1, 25.0))] == [
        "00:00:00:00", "00:00:00:23", "00:00:01:00", "-00:00:00:01",
    ]  # fmt: skip
    assert write_timecode(30, 29.97) == "00:00:01:00"


def test_the_date_is_that_of_the_build(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert read_date() == "1970-01-02"


def test_a_text_knows_its_picture_and_frame(tmp_path, cli):
    """`{file}` and `{meta}` are those of the file that the input comes from, through other nodes."""
    import json

    import OpenImageIO as oiio

    picture = tmp_path / "plate.0007.exr"
    spec = oiio.ImageSpec(64, 32, 4, "half")
    spec.attribute("Make", "Lens & Co")
    buffer = oiio.ImageBuf(spec)
    buffer.write(str(picture))
    graph = {
        "halation": 1,
        "nodes": {
            "read": {"type": "read_image", "values": {"path": "plate.####.exr"}},
            "soft": {"type": "gaussian_blur"},
            "title": {"type": "text", "values": {"text": "{file} {meta:Make} {frame:4}", "size": 0.2}},
            "plain": {"type": "text", "values": {"text": "plate.0007.exr Lens & Co 0007", "size": 0.2}},
        },
        "links": {
            "soft.image": "read.out", "title.image": "soft.out", "plain.image": "soft.out",
            "outputs.a": "title.out", "outputs.b": "plain.out",
        },
        "outputs": {"a": {"type": "Image"}, "b": {"type": "Image"}},
    }  # fmt: skip
    (tmp_path / "g.json").write_text(json.dumps(graph))
    pixels = []
    for name in "ab":
        done = cli("render", tmp_path / "g.json", "--output-name", name, "-o", tmp_path / f"{name}.exr", "--frame", 7)
        assert done.code == 0, done.err
        pixels.append(oiio.ImageBuf(str(tmp_path / f"{name}.exr")).get_pixels())
    np.testing.assert_array_equal(*pixels)
    assert pixels[0][..., 3].sum() > 10.0
