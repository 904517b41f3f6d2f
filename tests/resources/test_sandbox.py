"""What lies outside of the folder of `--root` is neither read nor written, whatever its path looks like."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from halation import presets
from halation.errors import UsageError
from halation.resources.sandbox import ROOT_VARIABLE, UNRESTRICTED, Sandbox, make_path_printable, read_process_sandbox
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
        refused = UNRESTRICTED.narrow(tree / "in").find_read_fault(path)
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


def test_without_a_root_all_may_be_read(tree: Path) -> None:
    assert UNRESTRICTED.find_write_fault(tree / "out" / "file") == "" and UNRESTRICTED.find_write_fault("/") == ""


def test_a_sandbox_is_made_smaller_only(tree: Path) -> None:
    sandbox = UNRESTRICTED.narrow(tree / "in" / "deep" / "back")
    assert sandbox == Sandbox(str((tree / "in").resolve()))
    file = tree / "in" / "file"
    assert sandbox.narrow(tree / "in" / "deep").find_write_fault(file) and not sandbox.find_write_fault(file)
    with pytest.raises(UsageError, match="lies outside"):
        sandbox.narrow(tree / "out")
    with pytest.raises(UsageError, match="there is no such folder"):
        UNRESTRICTED.narrow(tree / "nowhere")


def test_presets_of_the_installation_may_be_read_and_not_written(tree: Path) -> None:
    sandbox, folder = UNRESTRICTED.narrow(tree / "in"), Path(presets.__file__).parent
    for path in (presets.paths()[0], presets.sample(), folder / "new.json"):
        assert not sandbox.find_read_fault(path) and sandbox.find_write_fault(path)
    assert sandbox.find_read_fault(folder.parent) and sandbox.find_read_fault(folder / ".." / "README.md")
    (tree / "in" / "linked").symlink_to(presets.sample())
    assert not sandbox.find_read_fault(tree / "in" / "linked") and sandbox.find_write_fault(tree / "in" / "linked")


def test_the_environment_asks_for_one(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(ROOT_VARIABLE, raising=False)
    assert read_process_sandbox() is UNRESTRICTED
    monkeypatch.setenv(ROOT_VARIABLE, str(tree / "in" / "deep" / "back"))
    assert read_process_sandbox() == Sandbox(str((tree / "in").resolve()))


def test_a_path_that_no_file_has_can_be_printed() -> None:
    assert make_path_printable("a\0\ud800\udcff.exr") == "a\\0\\ud800\udcff.exr"
    make_path_printable("\udc7f\udd00").encode("ascii")
