"""Lists of frames and names with a frame in them, against Python's own ranges and % formatting."""

from __future__ import annotations

import ntpath
import os
from itertools import chain, combinations, pairwise
from types import SimpleNamespace

import pytest
from halation.errors import UsageError
from halation.graph import frames as module
from halation.graph.frames import (
    MOST_FRAMES,
    Pattern,
    add_frame_number,
    check_frame,
    check_numbered,
    format_frames,
    list_range,
    parse_frames,
)
from hypothesis import given, settings
from hypothesis import strategies as st

NUMBERS = st.integers(-(10**9) + 1, 10**9 - 1)
LISTS = st.lists(st.integers(-30, 130), max_size=40, unique=True)


@pytest.mark.parametrize(
    ("text", "frames"),
    [
        ("5", [5]),
        ("-5", [-5]),
        ("0", [0]),
        ("-0", [0]),
        ("1-24", range(1, 25)),
        ("1-24x2", range(1, 25, 2)),
        ("1-24x2,40", [*range(1, 25, 2), 40]),
        ("-5--1", range(-5, 0)),
        ("-2-2", range(-2, 3)),
        ("10-1", range(10, 0, -1)),
        ("10-1x3", [10, 7, 4, 1]),
        ("2--3x2", [2, 0, -2]),
        ("1-10x100", [1]),
        ("3-3", [3]),
        ("1-3,2-5", [1, 2, 3, 4, 5]),
        ("5,1-6", [5, 1, 2, 3, 4, 6]),
        ("0012-0014", [12, 13, 14]),
        (" 1 - 5 x 2 ,\t9 ", [1, 3, 5, 9]),
        ("1-5X2", [1, 3, 5]),
    ],
)
def test_a_list_of_frames(text, frames):
    assert parse_frames(text) == tuple(frames)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no frames are given"),
        (" \n", "no frames are given"),
        ("1,,2", "before or after a comma"),
        ("1-5,", "before or after a comma"),
        ("all", "'all' is not a frame or a range"),
        ("1-", "'1-' is not a frame"),
        ("1.5", "is not a frame or a range"),
        ("1-5x", "is not a frame or a range"),
        ("5x2", "is not a frame or a range"),
        ("1-5x-2", "is not a frame or a range"),
        ("1-5-9", "is not a frame or a range"),
        ("1-24x0", "the step cannot be 0: write 1-24x2"),
        ("1-9999999999", "'9999999999' has more than 9 digits"),
        ("1-1000001", "more than 1,000,000 frames"),
        ("1-999999999", "more than 1,000,000 frames"),
        ("1-600000,1-600000", "more than 1,000,000 frames"),
        ("9" * 5000, "more than 9 digits"),
        ("\u0661", "is not a frame or a range"),
    ],
)
def test_what_is_no_list_is_told_in_a_sentence(text, said):
    with pytest.raises(UsageError) as caught:
        parse_frames(text)
    sentence = str(caught.value)
    assert said in sentence and "1-24x2" in sentence and "\n" not in sentence and len(sentence) < 200


def test_a_million_frames_are_allowed():
    assert parse_frames(f"1-{MOST_FRAMES}") == tuple(range(1, MOST_FRAMES + 1))
    assert format_frames(range(1, MOST_FRAMES + 1)) == f"1-{MOST_FRAMES}"


@given(NUMBERS, st.integers(-300, 300), st.integers(1, 40))
def test_a_range_is_pythons(first, across, step):
    last = max(min(first + across, 10**9 - 1), 1 - 10**9)
    expected = range(first, last + 1, step) if first <= last else range(first, last - 1, -step)
    assert parse_frames(f"{first}-{last}x{step}") == tuple(expected)


@pytest.mark.parametrize(
    ("frames", "text"),
    [
        ([], ""),
        ([7], "7"),
        ([1, 2], "1-2"),
        ([1, 3], "1,3"),
        (range(1, 25), "1-24"),
        ([3, 2, 1], "3-1"),
        ([*range(1, 25, 2), 40], "1-23x2,40"),
        ([*range(1, 13), *range(14, 25)], "1-12,14-24"),
        (range(-5, 0), "-5--1"),
        ([1, 2, 3, 13, 23], "1-3,13,23"),
        ([1, 11, 21, 22, 23], "1,11,21-23"),
        ([1, 1, 2, 2, 3], "1-3"),
    ],
)
def test_frames_are_written_as_people_write_them(frames, text):
    assert format_frames(frames) == text


@settings(max_examples=300)
@given(st.lists(NUMBERS, min_size=1, max_size=30, unique=True) | LISTS.filter(bool) | LISTS.filter(bool).map(sorted))
def test_what_is_written_is_read_back(frames):
    assert parse_frames(format_frames(frames)) == tuple(frames)


def shortest(frames: tuple[int, ...]) -> int:
    """The least length of all ways to cut the list into frames and ranges."""

    def said(part: tuple[int, ...]) -> str | None:
        steps = {there - here for here, there in pairwise(part)}
        if len(steps) > 1:
            return None
        step = abs(steps.pop()) if steps else 0
        return str(part[0]) if not step else f"{part[0]}-{part[-1]}" + (f"x{step}" if step > 1 else "")

    inner = range(1, len(frames))
    lengths: list[int] = []
    for cuts in chain.from_iterable(combinations(inner, count) for count in range(len(frames))):
        edges = [0, *cuts, len(frames)]
        parts = [said(frames[start:stop]) for start, stop in pairwise(edges)]
        if all(part is not None for part in parts):
            lengths.append(len(",".join(filter(None, parts))))
    return min(lengths)


@settings(max_examples=300)
@given(st.lists(st.integers(-3, 14) | st.integers(-999, 1999), min_size=1, max_size=9, unique=True))
def test_no_other_text_is_shorter(frames):
    assert len(format_frames(frames)) == shortest(tuple(frames))


@given(st.lists(st.sampled_from([1, 2, 10, 99, 1000]), min_size=2, max_size=8), st.integers(-1100, 5))
@settings(max_examples=300)
def test_no_other_text_is_shorter_for_runs(steps, first):
    frames = [first + sum(sorted(steps)[:count]) for count in range(len(steps) + 1)]
    assert len(format_frames(frames)) == shortest(tuple(frames))


@pytest.mark.parametrize(
    ("text", "printf"),
    [
        ("shot.####.exr", "shot.%04d.exr"),
        ("shot.#.exr", "shot.%d.exr"),
        ("shot.%04d.exr", "shot.%04d.exr"),
        ("shot.%d.exr", "shot.%d.exr"),
        ("shot.%01d.exr", "shot.%01d.exr"),
        ("shot.$F4.exr", "shot.%04d.exr"),
        ("shot.$F.exr", "shot.%d.exr"),
        ("shot_$F4_left.exr", "shot_%04d_left.exr"),
        ("######", "%06d"),
        ("renders/#1/shot.###.exr", "renders/#1/shot.%03d.exr"),
        ("a b/%d/x$F2", "a b/%%d/x%02d"),
        ("é#.exr", "é%d.exr"),
    ],
)
@given(frame=NUMBERS | st.integers(-2000, 20000))
def test_a_name_is_that_of_printf(text, printf, frame):
    """printf pads -5 to -005, and so do Nuke and fileseq: the sign takes a digit's place."""
    pattern = Pattern.parse(text)
    name = printf % frame
    assert pattern is not None and pattern.name(frame) == name and pattern.frame(name) == frame


@pytest.mark.parametrize(
    "text",
    [
        "",
        "shot.exr",
        "shot.0012.exr",
        "shot.%4d.exr",
        "shot.%s.exr",
        "shot.%00d.exr",
        "$FPS.exr",
        "shot.$F_.exr",
        "####/shot.exr",
        "%04d/",
        "$HOME.exr",
        "100%.exr",
        "shot.<f>.exr",
        "shot.@@@.exr",
    ],
)
def test_plain_names_are_no_patterns(text):
    assert Pattern.parse(text) is None


@pytest.mark.parametrize(
    ("text", "name", "frame"),
    [
        ("shot.####.exr", "shot.0012.exr", 12),
        ("shot.####.exr", "elsewhere/shot.0012.exr", 12),
        ("shot.####.exr", "shot.12345.exr", 12345),
        ("shot.####.exr", "shot.-005.exr", -5),
        ("shot.####.exr", "shot.-0005.exr", -5),
        ("shot.####.exr", "shot.012.exr", None),
        ("shot.####.exr", "shot.00012.exr", None),
        ("shot.####.exr", "shot.0012.exr.tmp", None),
        ("shot.####.exr", "ashot.0012.exr", None),
        ("shot.####.exr", "shot.-000.exr", None),
        ("shot.####.exr", "shot.-00005.exr", None),
        ("shot.####.exr", "shot.+012.exr", None),
        ("shot.####.exr", "shot.1e10.exr", None),
        ("shot.####.exr", "shot..exr", None),
        ("shot.####.exr", "", None),
        ("shot.####.exr", "shot.1234567890.exr", None),
        ("shot.####.exr", "shot.\u0661\u0662\u0663\u0664.exr", None),
        ("shot.#.exr", "shot.12.exr", 12),
        ("shot.#.exr", "shot.0012.exr", None),
        ("shot.#.exr", "shot.0.exr", 0),
        ("shot.#", "shot." + "9" * 250, None),
        ("a#1.exr", "a121.exr", 12),
        ("##x##", "05x05", 5),
        ("##x##", "05x06", None),
        ("#.####.exr", "12.0012.exr", 12),
        ("s.%d.$F3.exr", "s.-7.-07.exr", -7),
        ("shot.(#).[a].exr", "shot.(3).[a].exr", 3),
        ("shot.#.e.r", "shot.3.exr", None),
        ("shot.####.exr", "SHOT.0012.exr", None),
    ],
)
def test_the_frame_in_a_name(text, name, frame):
    pattern = Pattern.parse(text)
    assert pattern is not None and pattern.frame(name) == frame


def test_many_places_cost_no_time():
    pattern = Pattern.parse("%d" * 60 + "x")
    assert pattern is not None and pattern.frame("1" * 250) is None and pattern.frame("7" * 60 + "x") == 7


@pytest.mark.parametrize("text", ["shot.%0999999d.exr", "#" * 17, "$F99.exr", "%0" + "9" * 6000 + "d"])
def test_absurd_padding_is_refused(text):
    with pytest.raises(UsageError, match="more than 16 digits for a frame") as caught:
        Pattern.parse(text)
    assert len(str(caught.value)) < 150


def test_windows_separators_and_letter_case(monkeypatch):
    monkeypatch.setattr(module, "os", SimpleNamespace(path=ntpath))
    pattern = Pattern.parse("C:\\#1\\renders/Shot.####.exr")
    assert pattern is not None and pattern.folder == "C:\\#1\\renders/"
    assert pattern.name(12) == "C:\\#1\\renders/Shot.0012.exr"
    assert pattern.frame("D:\\x\\SHOT.0012.EXR") == 12
    assert add_frame_number("C:\\a.b\\out.exr") == "C:\\a.b\\out.####.exr"


@pytest.mark.parametrize(
    ("path", "better"),
    [
        ("out.exr", "out.####.exr"),
        ("a.b/out", "a.b/out.####"),
        ("out.tar.exr", "out.tar.####.exr"),
        ("x%4d/out.%4d.exr", "x%4d/out.%04d.exr"),
        (".exr", ".exr.####"),
    ],
)
def test_several_frames_need_a_name_each(path, better):
    with pytest.raises(UsageError) as caught:
        check_numbered(path, (1, 2, 3))
    assert str(caught.value) == f"{path}: 3 frames cannot go into one file: write -o {better}"
    assert Pattern.parse(better)
    check_numbered(path, (7,))
    check_numbered(better, (1, 2, 3))


def test_nothing_is_evaluated_or_listed(monkeypatch):
    for name in ("listdir", "scandir", "stat", "system"):
        monkeypatch.setattr(os, name, lambda *_, **__: pytest.fail("no file is looked at"))
    pattern = Pattern.parse("$HOME/`id`/{frame}.$F4.exr")
    assert pattern is not None and pattern.name(1) == "$HOME/`id`/{frame}.0001.exr"
    assert pattern.frame("{frame}.0001.exr") == 1


def test_a_range_is_listed_up_to_a_million_frames() -> None:
    assert list_range(-2, 1) == (-2, -1, 0, 1) and list_range(5, 1) == ()
    with pytest.raises(UsageError, match="more than 1,000,000"):
        list_range(1, 10**9)


def test_a_frame_has_at_most_nine_digits() -> None:
    assert check_frame(-999_999_999) == -999_999_999
    with pytest.raises(UsageError, match="more than 9 digits"):
        check_frame(10**9)
