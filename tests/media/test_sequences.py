"""Numbered pictures in folders: which frames there are, and what stands for those that are not."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from halation.errors import InputError
from halation.media import find_frame_file, find_sequence, sequences, suggest_pattern
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st

SHOT = [f"shot.{frame:04d}.exr" for frame in (*range(1, 13), *range(14, 25))]

Fill = Callable[..., Path]


@pytest.fixture
def fill(tmp_path: Path) -> Fill:
    """`fill("a.0001.exr", ...)` makes empty files in a folder that has been as it is for long."""

    def filled(*names: str, age: int = 100) -> Path:
        for name in names:
            (tmp_path / name).touch()
        then = (tmp_path.stat().st_mtime_ns) - age * 10**9
        os.utime(tmp_path, ns=(then, then))
        return tmp_path

    return filled


@pytest.fixture
def listings(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The folders that were listed, in order."""
    found: list[str] = []
    listed = os.scandir
    monkeypatch.setattr(sequences.os, "scandir", lambda path: (found.append(str(path)), listed(path))[1])
    return found


def test_the_frames_of_a_pattern(fill):
    folder = fill(*SHOT, "shot.0030.exr.tmp", "shot.13.exr", "other.0013.exr", "shot.0013.png")
    (folder / "shot.0013.exr").mkdir()
    for text in ("shot.####.exr", "shot.%04d.exr", "shot.$F4.exr"):
        found = find_sequence(f"{folder}/{text}", sandbox=UNRESTRICTED)
        assert found is not None and found.frames == (*range(1, 13), *range(14, 25))
        assert (found.gaps, found.missing, found.frames_text, found.gaps_text) == (((13, 13),), 1, "1-12,14-24", "13")
        assert found.path(7) == f"{folder}/shot.0007.exr"


def test_an_empty_sequence_and_a_gap_without_end(fill):
    found = find_sequence(f"{fill('x.exr')}/shot.#.exr", sandbox=UNRESTRICTED)
    assert found is not None and (found.frames, found.gaps, found.missing, found.frames_text) == ((), (), 0, "")
    found = find_sequence(f"{fill('shot.1.exr', 'shot.999999999.exr')}/shot.#.exr", sandbox=UNRESTRICTED)
    assert found is not None and found.gaps == ((2, 999999998),) and found.gaps_text == "2-999999998"


def test_long_lists_are_cut(fill):
    found = find_sequence(f"{fill(*(f'x.{frame * frame}.exr' for frame in range(40)))}/x.#.exr", sandbox=UNRESTRICTED)
    assert found is not None
    assert found.frames_text.endswith(",...") and found.gaps_text.endswith(",...") and len(found.frames_text) < 70


def test_one_picture_is_no_sequence(fill):
    folder = fill("shot.exr", "take #1.exr", "shot.%04d.exr", "shot.0001.exr")
    for name in ("shot.exr", "take #1.exr", "shot.%04d.exr", "shot.0001.exr", "gone.exr"):
        assert find_sequence(f"{folder}/{name}", sandbox=UNRESTRICTED) is None
        frame = find_frame_file(f"{folder}/{name}", 5, sandbox=UNRESTRICTED)
        assert (frame.path, frame.black) == (f"{folder}/{name}", False)


def test_negative_frames_by_printf_and_by_blender(fill):
    folder = fill("a.-005.exr", "a.-0004.exr", "a.-0003.exr", "a.-003.exr", "a.0000.exr", "a.-000.exr")
    found = find_sequence(f"{folder}/a.####.exr", sandbox=UNRESTRICTED)
    assert found is not None and list(found.names.items()) == [
        (-5, "a.-005.exr"),
        (-4, "a.-0004.exr"),
        (-3, "a.-003.exr"),
        (0, "a.0000.exr"),
    ]
    assert find_frame_file(f"{folder}/a.####.exr", -4, sandbox=UNRESTRICTED).path == f"{folder}/a.-0004.exr"


@pytest.mark.parametrize(
    ("names", "pattern"),
    [
        (SHOT, "shot.####.exr"),
        ([*SHOT, *(f"a.{frame}.exr" for frame in range(5))], "shot.####.exr"),
        (["b.0001.exr", "b.0002.exr", "a.0001.exr", "a.0002.exr"], "a.####.exr"),
        (["s.0001.exr", "s.0001.png", "s.0002.exr", "s.0002.png"], "s.####.exr"),
        (["shot_v02.0001.exr"], "shot_v02.####.exr"),
        (["a1.0001.exr", "a1.0002.exr", "a2.0001.exr", "a2.0002.exr"], "a1.####.exr"),
        (["s.0001_half.v2.exr", "s.0002_half.v2.exr"], "s.####_half.v2.exr"),
        ([f"s{frame}.exr" for frame in (8, 9, 10, 11)], "s#.exr"),
        ([f"s{frame}.exr" for frame in (1001, 1002)], "s####.exr"),
        (["s.008.exr", "s.009.exr", "s.1000.exr"], "s.###.exr"),
        (["s-0001.exr", "s-0002.exr"], "s-####.exr"),
        (["s.-001.exr", "s.0000.exr", "s.0001.exr"], "s.####.exr"),
        (["s.1.exr", "s.01.exr", "s.02.exr"], "s.##.exr"),
        (["a.01.txt", "a.02.txt", "a.03.txt", "._b.01.exr", "._b.02.exr", "b.7.exr"], "b.#.exr"),
        (["0001.jp2", "0002.jp2"], "####.jp2"),
        (["#1.0001.exr", "#1.0002.exr", "b.1.exr"], "b.#.exr"),
        (["20240101123456789012.exr", "b.1.exr"], "b.#.exr"),
    ],
)
def test_a_folder_is_the_sequence_with_the_most_frames(fill, names, pattern):
    folder = fill(*names)
    found = find_sequence(str(folder), sandbox=UNRESTRICTED)
    assert found is not None and found.pattern.text == f"{folder}/{pattern}" and found.frames
    assert find_frame_file(str(folder), found.frames[-1], sandbox=UNRESTRICTED).path == found.path(found.frames[-1])


@pytest.mark.parametrize("names", [(), ("a.exr", "notes.01.txt", "b"), ("a.exr",)])
def test_a_folder_without_numbers(fill, names):
    folder = fill(*names)
    with pytest.raises(InputError, match="is a folder without numbered pictures: name a picture inside it"):
        find_sequence(str(folder), sandbox=UNRESTRICTED)


@pytest.mark.parametrize(
    ("missing", "frame", "there", "black"),
    [
        ("hold", 13, 12, False),
        ("hold", 0, 1, False),
        ("hold", 99, 24, False),
        ("hold", 14, 14, False),
        ("nearest", 13, 12, False),
        ("nearest", 0, 1, False),
        ("nearest", 99, 24, False),
        ("nearest", 14, 14, False),
        ("black", 13, 12, True),
        ("black", -7, 1, True),
        ("black", 99, 24, True),
        ("black", 14, 14, False),
        ("error", 14, 14, False),
    ],
)
def test_what_stands_for_a_missing_frame(fill, missing, frame, there, black):
    folder = fill(*SHOT)
    for path in (f"{folder}/shot.####.exr", str(folder)):
        found = find_frame_file(path, frame, missing, sandbox=UNRESTRICTED)
        assert (found.path, found.black) == (f"{folder}/shot.{there:04d}.exr", black)


@settings(max_examples=80)
@given(frames=st.sets(st.integers(-20, 60), min_size=1, max_size=12), frame=st.integers(-25, 70))
def test_hold_and_nearest_by_their_definitions(tmp_path_factory, frames, frame):
    folder = tmp_path_factory.mktemp("frames")
    for there in frames:
        (folder / f"a.{there:03d}.exr").touch()
    before = [there for there in frames if there <= frame]
    hold = max(before) if before else min(frames)
    near = min(sorted(frames), key=lambda there: abs(there - frame))
    assert (
        find_frame_file(f"{folder}/a.###.exr", frame, "hold", sandbox=UNRESTRICTED).path == f"{folder}/a.{hold:03d}.exr"
    )
    assert (
        find_frame_file(f"{folder}/a.###.exr", frame, "nearest", sandbox=UNRESTRICTED).path
        == f"{folder}/a.{near:03d}.exr"
    )


def test_a_missing_frame_is_told_in_a_sentence(fill):
    folder = fill(*SHOT)
    with pytest.raises(InputError) as caught:
        find_frame_file(f"{folder}/shot.####.exr", 13, sandbox=UNRESTRICTED)
    assert str(caught.value) == (
        f"{folder}/shot.0013.exr: there is no such file, only frames 1-12,14-24: render it, or choose hold, nearest or "
        "black for missing frames"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("shto.####.exr", "no file has such a name; did you mean 'shot.####.exr'?"),
        ("shot.###.exr", "no file has such a name; did you mean 'shot.####.exr'?"),
        ("nothing_like_it_#.hdr", "no file has such a name: check it"),
        ("gone/shot.####.exr", "no file has such a name; its folder is missing too"),
        ("shot.0001.exr/shot.####.exr", "no file has such a name; its folder is missing too"),
    ],
)
@pytest.mark.parametrize("missing", ["error", "hold", "nearest", "black"])
def test_no_frame_at_all_is_an_error_whatever_stands_for_missing_ones(fill, text, said, missing):
    folder = fill(*SHOT)
    with pytest.raises(InputError) as caught:
        find_frame_file(f"{folder}/{text}", 3, missing, sandbox=UNRESTRICTED)
    assert str(caught.value) == f"{folder}/{text}: {said}"


def test_relative_names(fill, monkeypatch):
    monkeypatch.chdir(fill(*SHOT))
    assert find_frame_file("shot.####.exr", 13, "hold", sandbox=UNRESTRICTED).path == "shot.0012.exr"
    assert find_frame_file("./shot.####.exr", 13, "hold", sandbox=UNRESTRICTED).path == "./shot.0012.exr"
    assert suggest_pattern("shot.0001.exr", sandbox=UNRESTRICTED) == "shot.####.exr"
    assert suggest_pattern("./shot.0001.exr", sandbox=UNRESTRICTED) == "./shot.####.exr"
    assert find_sequence(".", sandbox=UNRESTRICTED).frames_text == "1-12,14-24"


def test_a_render_lists_its_folder_once(fill, listings):
    folder = fill(*SHOT)
    for path in (f"{folder}/shot.####.exr", str(folder)):
        for frame in range(1, 1001):
            find_frame_file(path, frame, "hold", sandbox=UNRESTRICTED)
    assert listings == [str(folder)]


def test_frames_that_are_there_need_no_list(fill, listings):
    folder = fill(*SHOT)
    assert [
        find_frame_file(f"{folder}/shot.####.exr", frame, sandbox=UNRESTRICTED).path for frame in range(1, 13)
    ] and not listings


@pytest.mark.parametrize("age", [0, 100])
def test_new_and_removed_files_are_noticed(fill, age):
    folder = fill(*SHOT, age=age)
    path = f"{folder}/shot.####.exr"
    assert find_frame_file(path, 30, "hold", sandbox=UNRESTRICTED).path.endswith("shot.0024.exr")
    (folder / "shot.0028.exr").touch()
    assert find_frame_file(path, 30, "hold", sandbox=UNRESTRICTED).path.endswith("shot.0028.exr")
    (folder / "shot.0028.exr").unlink()
    assert find_frame_file(path, 30, "hold", sandbox=UNRESTRICTED).path.endswith("shot.0024.exr")


def test_only_the_one_folder_is_listed(fill, listings, tmp_path):
    (tmp_path / "shots").mkdir()
    folder = fill("a.1.exr", "shots/b.1.exr", "shots/b.2.exr")
    find_sequence(f"{folder}/a.#.exr", sandbox=UNRESTRICTED)
    find_sequence(str(folder), sandbox=UNRESTRICTED)
    with pytest.raises(InputError):
        find_frame_file(f"{folder}/*/b.#.exr", 1, sandbox=UNRESTRICTED)
    assert listings == [str(folder)]


@pytest.mark.parametrize(
    ("name", "pattern"),
    [
        ("shot.0012.exr", "shot.####.exr"),
        ("v2/beauty.exr", None),
        ("alone.0001.exr", None),
        ("gone.0001.exr", None),
        ("plain.exr", None),
        ("a1.0002.exr", "a1.####.exr"),
        ("left_v1.exr", "left_v#.exr"),
        ("notes.01.txt", None),
        ("s.008.exr", "s.###.exr"),
        ("s.1000.exr", "s.###.exr"),
        ("s.01.exr", "s.##.exr"),
        ("#1.0001.exr", None),
    ],
)
def test_the_pattern_of_one_picture(fill, tmp_path, name, pattern):
    (tmp_path / "v2").mkdir()
    folder = fill(
        *SHOT,
        "v2/beauty.exr",
        "alone.0001.exr",
        "plain.exr",
        "a1.0001.exr",
        "a1.0002.exr",
        "a2.0001.exr",
        "left_v1.exr",
        "left_v2.exr",
        "notes.01.txt",
        "notes.02.txt",
        "s.008.exr",
        "s.009.exr",
        "s.1000.exr",
        "s.01.exr",
        "#1.0001.exr",
        "#1.0002.exr",
    )
    assert suggest_pattern(f"{folder}/{name}", sandbox=UNRESTRICTED) == (pattern and f"{folder}/{pattern}")


def test_a_folder_that_may_not_be_read(fill, monkeypatch):
    def refused(path: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    folder = fill(*SHOT)
    monkeypatch.setattr(sequences.os, "scandir", refused)
    with pytest.raises(InputError, match=f"^{folder}/: the folder cannot be read: Permission denied$"):
        find_frame_file(f"{folder}/shot.####.exr", 13, "hold", sandbox=UNRESTRICTED)
    assert suggest_pattern(f"{folder}/shot.0001.exr", sandbox=UNRESTRICTED) is None
    assert find_frame_file(f"{folder}/shot.####.exr", 12, sandbox=UNRESTRICTED).path == f"{folder}/shot.0012.exr"


def test_names_that_no_system_knows():
    for path in ("a" * 5000, "a\0b.exr", "\0/x.#.exr"):
        assert find_sequence(path, sandbox=UNRESTRICTED) is None or not find_sequence(path, sandbox=UNRESTRICTED).frames
