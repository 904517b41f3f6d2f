"""Numbered pictures that are watched and dropped, against lists that are counted by hand, and versions of files."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from halation.resources.sandbox import UNRESTRICTED, Sandbox
from halation.watch import versions
from halation.watch.sequence_files import list_sequence_files, representative_file, suggest_patterns
from halation.watch.versions import FileVersions


def make_files(folder: Path, *names: str) -> None:
    folder.mkdir(exist_ok=True)
    for name in names:
        (folder / name).touch()


def list_numbers(files: tuple[Path, ...], start: str = "s.") -> list[int]:
    """The numbers of files such as `s.0012.exr`, all in four digits."""
    assert all(file.name == f"{start}{file.name[-8:-4]}.exr" for file in files)
    return [int(file.name[-8:-4]) for file in files]


def test_all_frames_of_a_sequence_its_gaps_and_a_second_more_are_watched(tmp_path: Path) -> None:
    make_files(tmp_path, "s.0003.exr", "s.0005.exr")
    pattern, other = tmp_path / "s.####.exr", tmp_path / "one.exr"
    files = list_sequence_files([other, pattern, pattern, other], sandbox=UNRESTRICTED)
    assert files[0] == other and list_numbers(files[1:]) == [*range(3, 5 + 24 + 1)]
    assert {file.parent for file in files} == {tmp_path}


def test_of_a_long_sequence_the_last_four_hundred_files_are_watched(tmp_path: Path) -> None:
    make_files(tmp_path, *(f"s.{frame:04d}.exr" for frame in range(1, 502)))
    files = list_sequence_files([tmp_path / "s.####.exr"], sandbox=UNRESTRICTED)
    assert list_numbers(files) == [*range(501 + 24 - 400 + 1, 501 + 24 + 1)]


def test_a_negative_frame_is_watched_as_it_is_spelled(tmp_path: Path) -> None:
    """Blender writes -0002 where printf writes -002, which is waited for where nothing is."""
    make_files(tmp_path, "s.-0002.exr", "s.0000.exr")
    names = [file.name for file in list_sequence_files([tmp_path / "s.####.exr"], sandbox=UNRESTRICTED)]
    assert names[:4] == ["s.-0002.exr", "s.-001.exr", "s.0000.exr", "s.0001.exr"]


def test_a_sequence_without_files_and_a_folder_that_may_not_be_read_are_watched_as_they_are(tmp_path: Path) -> None:
    make_files(tmp_path / "in")
    make_files(tmp_path / "out", "s.0001.exr")
    paths = (tmp_path / "in" / "s.####.exr", tmp_path / "out" / "s.####.exr")
    assert list_sequence_files(paths, sandbox=Sandbox(str(tmp_path / "in"))) == paths


@pytest.mark.parametrize(
    ("frame", "name"), [(0, "s.0002.exr"), (2, "s.0002.exr"), (4, "s.0002.exr"), (5, "s.0006.exr")]
)
def test_the_nearest_picture_stands_for_a_sequence(tmp_path: Path, frame: int, name: str) -> None:
    make_files(tmp_path, "s.0002.exr", "s.0006.exr")
    assert representative_file(tmp_path / "s.####.exr", frame, sandbox=UNRESTRICTED) == tmp_path / name


def test_the_first_frame_stands_for_a_sequence_where_nobody_says_which(tmp_path: Path) -> None:
    make_files(tmp_path, "s.0001.exr", "s.0002.exr")
    assert representative_file(tmp_path / "s.####.exr", sandbox=UNRESTRICTED) == tmp_path / "s.0001.exr"
    for name in ("one.exr", "lost.####.exr"):
        assert representative_file(tmp_path / name, sandbox=UNRESTRICTED) == tmp_path / name


def test_dropped_pictures_of_one_sequence_are_one_and_a_single_one_says_what_it_is_a_frame_of(tmp_path: Path) -> None:
    make_files(tmp_path, "a.01.exr", "a.02.exr", "a.03.exr", "b.01.exr", "b.02.exr", "alone.exr")
    pair, single, alone = (
        [tmp_path / f"a.0{frame}.exr" for frame in (3, 1)],
        tmp_path / "b.02.exr",
        tmp_path / "alone.exr",
    )
    pattern = tmp_path / "a.##.exr"
    chosen, sequences = suggest_patterns([pair[0], alone, single, pair[1]], sandbox=UNRESTRICTED)
    assert chosen == (pattern, alone, single)
    assert sequences == {single: tmp_path / "b.##.exr"}
    assert suggest_patterns(pair[:1], sandbox=UNRESTRICTED) == ((pair[0],), {pair[0]: pattern})
    assert suggest_patterns([], sandbox=UNRESTRICTED) == ((), {})


def test_a_version_is_that_of_the_file_and_is_looked_up_once_a_second(tmp_path: Path, monkeypatch) -> None:
    clock = SimpleNamespace(now=0.0)
    monkeypatch.setattr(versions, "monotonic", lambda: clock.now)
    looks, read = list[Path](), versions.fingerprint

    def look(path: Path, sandbox: Sandbox) -> str:
        looks.append(path)
        return read(path, sandbox=sandbox)

    monkeypatch.setattr(versions, "fingerprint", look)
    known, file, other = FileVersions(UNRESTRICTED), tmp_path / "a.cube", tmp_path / "b.cube"
    file.write_text("1")
    first = known.of(file)
    assert first[0] and first[1] == "" and known.of(file) == first and looks == [file]
    assert known.of(other)[0] == "" and str(other) in known.of(other)[1], "a fault is kept for a second too"
    assert looks == [file, other]
    file.write_text("another")
    clock.now = 0.99
    assert known.of(file) == first and len(looks) == 2
    clock.now = 1.0
    second = known.of(file)
    assert second[0] not in ("", first[0]) and second[1] == "" and len(looks) == 3
    file.unlink()
    clock.now = 1.99
    assert known.of(file) == second
    clock.now = 2.0
    assert known.of(file)[0] == "" and known.of(file)[1]
    file.write_text("1")
    clock.now = 3.5
    assert known.of(file)[0] and known.of(file)[1] == ""
