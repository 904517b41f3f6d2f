"""What lies outside of the folder of `--root` is neither read nor written, whatever its path looks like."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from halation.errors import UsageError
from halation.resources.sandbox import ROOT, fenced, outside
from hypothesis import given
from hypothesis import strategies as st

PARTS = (
    "..",
    ".",
    "",
    "in",
    "out",
    "deep",
    "file",
    "up",
    "away",
    "back",
    "loop",
    "gone",
    "chain",
    "a b",
    "ü",
    "...",
    "~",
    "in\x00",
    "x" * 300,
)


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """top/in is the fence, top/out is not, and links lead from one to the other."""
    top = tmp_path_factory.mktemp("tree")
    (top / "in" / "deep").mkdir(parents=True)
    (top / "out").mkdir()
    (top / "inside").mkdir()  # its name begins like the fence's
    for folder, text in (("in", "inside"), ("in/deep", "inside"), ("out", "outside"), ("inside", "outside")):
        (top / folder / "file").write_text(text)
    for link, target in (
        ("in/up", ".."),
        ("in/away", "../out"),
        ("in/deep/back", "../../in"),
        ("out/in", "../in"),
        ("in/loop", "loop"),
        ("in/chain", "deep/back/away/file"),
        ("in/gone", "../out/gone"),
        ("out/back", "../in/deep"),
    ):
        (top / link).symlink_to(target)
    return top


@given(st.lists(st.sampled_from(PARTS), max_size=8), st.booleans())
def test_what_may_be_read_lies_inside(tree: Path, parts: list[str], absolute: bool) -> None:
    here = os.getcwd()  # noqa: PTH109 - to go back to
    os.chdir(tree / "in")
    try:
        path = "/".join([str(tree), *parts] if absolute else parts)
        with fenced(tree / "in"):
            refused = outside(path)
        try:
            truth = Path(path).resolve().is_relative_to((tree / "in").resolve())
        except (OSError, RuntimeError, ValueError):
            truth = False
        assert bool(refused) == (not truth)
        try:
            text = Path(path).read_text()
        except (OSError, ValueError):
            return
        assert refused or text == "inside"
    finally:
        os.chdir(here)


def test_without_a_fence_all_may_be_read(tree: Path) -> None:
    assert outside(tree / "out" / "file") == "" and outside("/") == ""


def test_a_fence_holds_for_processes_and_ends(tree: Path) -> None:
    assert ROOT not in os.environ
    with fenced(tree / "in" / "deep" / "back"):
        assert os.environ[ROOT] == str((tree / "in").resolve())
        with fenced(tree / "in" / "deep"):
            assert outside(tree / "in" / "file")
        assert not outside(tree / "in" / "file")
        with pytest.raises(UsageError, match="lies outside"), fenced(tree / "out"):
            pass
    assert ROOT not in os.environ
    with pytest.raises(UsageError, match="there is no such folder"), fenced(tree / "nowhere"):
        pass
