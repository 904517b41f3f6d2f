"""What is said of a file that is not there."""

from __future__ import annotations

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
        ("plate.0013.exr", "plate.0012.exr"),
        ("plate.0010.exr", "plate.0011.exr"),
    ],
)
def test_a_similar_file_beside_it_is_suggested(tmp_path: Path, name: str, suggestion: str) -> None:
    for file in FILES:
        (tmp_path / file).write_bytes(b"x")
    for read in (check_file, read_bytes):
        with pytest.raises(InputError) as caught:
            read(tmp_path / name, UNRESTRICTED)
        sentence = "there is no such file; did you mean"
        assert str(caught.value) in [f"{tmp_path / name}: {sentence} '{each}'?" for each in (suggestion, *FILES[2:4])]
        assert suggestion in str(caught.value) or name.startswith("plate")


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
