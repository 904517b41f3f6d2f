"""Tokens in texts that are drawn."""

from __future__ import annotations

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
