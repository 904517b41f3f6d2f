"""What is said of a file that is not there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from halation.errors import InputError
from halation.resources.input_files import check_file, find_similar_name, read_bytes
from halation.resources.sandbox import UNRESTRICTED

FILES = ("shot.exr", "shot_depth.exr", "plate.0011.exr", "plate.0012.exr", ".hidden.exr")


@pytest.mark.parametrize(
    ("name", "suggestion"),
    [
        ("shto.exr", "shot.exr"),
        ("SHOT.EXR", "shot.exr"),
        ("shot", "shot.exr"),
        ("shot.png", "shot.exr"),
        ("shot_depht.exr", "shot_depth.exr"),
    ],
)
def test_a_similar_file_beside_it_is_suggested(tmp_path: Path, name: str, suggestion: str) -> None:
    for file in FILES:
        (tmp_path / file).write_bytes(b"x")
    for read in (check_file, read_bytes):
        with pytest.raises(InputError) as caught:
            read(tmp_path / name, UNRESTRICTED)
        assert str(caught.value) == f"{tmp_path / name}: there is no such file; did you mean '{suggestion}'?"


@pytest.mark.parametrize("name", ["nope.exr", "a.exr", "beauty.exr", "exr"])
def test_an_ending_alone_is_no_likeness(tmp_path: Path, name: str) -> None:
    for file in FILES:
        (tmp_path / file).write_bytes(b"x")
    with pytest.raises(InputError, match=r"there is no such file: check the name$"):
        check_file(tmp_path / name, UNRESTRICTED)


@pytest.mark.parametrize(
    ("sought", "names", "meant"),
    [
        ("missing.exr", ["missing.log"], ""),
        ("missing.exr", ["missing.log", "missing.json", "missing.exr.txt"], ""),
        ("shot.exr", ["shot.log", "shot.png"], "shot.png"),
        ("look.jsn", ["look.log", "look.json"], "look.json"),
        ("look.json", ["look.exr", "lok.json"], "lok.json"),
        ("gain.glsl", ["gain.json", "gain.frag"], "gain.frag"),
        ("film.cube", ["film.mov", "film.3dl"], "film.3dl"),
        ("shot", ["shot.exr"], "shot.exr"),
        ("shot.EXR", ["SHOT.exr"], "SHOT.exr"),
    ],
)
def test_a_suggestion_is_of_the_same_kind(sought: str, names: list[str], meant: str) -> None:
    assert find_similar_name(sought, names) == meant


@pytest.mark.parametrize(
    ("name", "names", "sentence"),
    [
        ("shot.0003.exr", ["shot.0001.exr", "shot.0010.exr", "shot.0002.exr"], ", only shot.0001.exr to shot.0010.exr"),
        ("take2.exr", ["take9.exr", "take10.exr", "take.exr"], ", only take9.exr to take10.exr"),
        ("look_v3.exr", ["look_v2.exr"], ", only look_v2.exr"),
        ("shto.0003.exr", ["shot.0003.exr"], "; did you mean 'shot.0003.exr'?"),
        ("Shot.exr", ["shot.exr"], "; did you mean 'shot.exr'?"),
    ],
)
def test_a_missing_frame_names_those_that_are_there(name: str, names: list[str], sentence: str, tmp_path: Path) -> None:
    for file in names:
        (tmp_path / file).touch()
    with pytest.raises(InputError, match=re.escape(f"there is no such file{sentence}") + "$"):
        check_file(tmp_path / name, UNRESTRICTED)
