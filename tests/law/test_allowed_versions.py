"""Halation works with the lowest and the newest versions of its packages that pyproject.toml allows."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from source_trees import copy_tree

UV = Path(sys.executable).with_name("uv")
EXTRAS = ("video", "denoise", "cluster", "fit", "wgsl")
TOOLS = ("pytest", "pytest-timeout", "pytest-xdist", "hypothesis", "scipy", "opencv-python-headless", "jsonschema")
TOOLS += ("markdown-it-py", "freetype-py")
PARTS = (
    "tests/color/test_views.py",
    "tests/document",
    "tests/cli/test_completion.py",
    "tests/editor/panels/test_offers.py",
    "tests/gui/test_keymaps.py",
    "tests/media/test_video.py",
    "tests/nodes/test_text.py",
)
"""Tests that each of the packages with an interface of its own takes part in."""

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.timeout(1800),
    pytest.mark.skipif(not UV.exists(), reason="uv is not installed"),
]


def run(*words: str | Path, folder: Path) -> str:
    """What a program prints; the test fails with all of it if the program does."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV"))}
    ended = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    assert ended.returncode == 0, f"{words}\n{ended.stdout[-6000:]}\n{ended.stderr[-6000:]}"
    return ended.stdout


@pytest.fixture(scope="module", params=["lowest-direct", "highest"])
def python(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The Python of an environment with such versions, in which a copy of the tree is installed for editing."""
    folder = tmp_path_factory.mktemp(request.param)
    tree = copy_tree(folder / "tree")
    extras = [word for extra in EXTRAS for word in ("--extra", extra)]
    versions = folder / "versions.txt"
    wanted = ("--resolution", request.param, "--python", sys.executable, "--quiet", "-o", versions)
    run(UV, "pip", "compile", *wanted, *extras, "pyproject.toml", folder=tree)
    run(UV, "venv", "--quiet", "--python", sys.executable, folder / "venv", folder=tree)
    python = folder / "venv/bin/python"
    pip = (UV, "pip", "install", "--quiet", "--python", python)
    run(*pip, "-r", versions, folder=tree)
    run(*pip, "--constraint", versions, *TOOLS, folder=tree)
    run(*pip, "--no-deps", "--editable", ".", folder=tree)
    return python


def test_a_picture_is_rendered_fitted_and_exported(python: Path, tmp_path: Path) -> None:
    run(python, "-m", "halation.cli", "doctor", folder=tmp_path)
    run(python, "-m", "halation.cli", "render", "soft_bloom", "-o", "out.png", folder=tmp_path)
    assert (tmp_path / "out.png").stat().st_size > 10_000
    values = ("--to", "out.png", "--values", "contrast", "--budget", "5s", "-o", "fitted.json")
    run(python, "-m", "halation.cli", "fit", "cinematic_grade", *values, folder=tmp_path)
    run(python, "-m", "halation.cli", "export", "soft_bloom", "--to", "wgsl", "-o", "passes", folder=tmp_path)
    assert (tmp_path / "fitted.json").is_file() and list((tmp_path / "passes/wgsl").glob("*.wgsl"))


def test_a_part_of_the_suite_passes(python: Path) -> None:
    tree = python.parents[2] / "tree"
    printed = run(python, "-m", "pytest", "-q", "-p", "no:xdist", "-p", "no:cacheprovider", *PARTS, folder=tree)
    assert " passed" in printed and " failed" not in printed
