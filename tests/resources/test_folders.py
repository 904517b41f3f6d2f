"""Patterns of files: what `glob` of Python finds, without its circles and without what lies outside of the sandbox."""

from __future__ import annotations

import glob
import sys
from pathlib import Path

import pytest
from halation.errors import InputError
from halation.resources.folders import find_matches
from halation.resources.sandbox import UNRESTRICTED, Sandbox

links = pytest.mark.skipif(sys.platform == "win32", reason="POSIX links")


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in (
        "a.json",
        "b.exr",
        "[x].exr",
        ".hidden.exr",
        "one/c.exr",
        "one/two/d.exr",
        "one/.h/e.exr",
        "three/f.txt",
    ):
        path = tmp_path / "in" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    monkeypatch.chdir(tmp_path / "in")
    return tmp_path / "in"


@pytest.mark.parametrize(
    "pattern",
    ["*", "*.exr", "**/*.exr", "**/*", "**", "one/**", "o*/*", "*/*/*.exr", "[[]x].exr", "?.json", ".*", "**/two/*",
     "***.exr", "*/../*.json", "one/../*.json", "**/**/*.exr", "**/*/**/*.exr", "nothing*", "no/such/*"],
)  # fmt: skip
@pytest.mark.parametrize("whole", [False, True])
def test_matches_are_those_of_glob(tree: Path, pattern: str, whole: bool) -> None:
    pattern = f"{tree.as_posix()}/{pattern}" if whole else pattern
    expected = {str(Path(path)) for path in glob.glob(pattern, recursive=True) if path}  # noqa: PTH207
    assert find_matches(pattern, UNRESTRICTED) == sorted(expected)


@links
def test_links_do_not_lead_in_circles(tree: Path) -> None:
    """With one link to the folder itself `glob` finds a file forty times; with three it walks through 3^40 folders."""
    (tree / "x").symlink_to(tree)
    assert find_matches("**/*.json", UNRESTRICTED) == ["a.json"]
    assert find_matches("*/*.json", UNRESTRICTED) == ["x/a.json"]


def test_what_matches_in_many_ways_is_found_once(tree: Path) -> None:
    """Thirty folders inside each other match this pattern in 10^8 ways."""
    (tree / "/".join(["d"] * 30)).mkdir(parents=True)
    assert find_matches("/".join(["**", "*"] * 15) + "/x", UNRESTRICTED) == []


@links
def test_nothing_outside_of_the_sandbox_matches(tree: Path) -> None:
    """Names of files outside are not told either."""
    (tree.parent / "secret").mkdir()
    (tree.parent / "secret" / "s.json").touch()
    (tree / "link").symlink_to(tree.parent / "secret")
    sandbox = Sandbox(str(tree))
    for pattern in ("../secret/*.json", "link/*.json", f"{tree.parent}/*/*.json", "../*"):
        with pytest.raises(InputError, match="lies outside of"):
            find_matches(pattern, sandbox)
    assert find_matches("*/*.json", sandbox) == [] and find_matches("*/../../secret/*", sandbox) == []
