"""Words are spelled right, in code, shaders and pages. Tests misspell on purpose."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
TREES = ("README.md", "app", "dev", "docs", "nodes", "presets", "shaders")


def run_codespell(folder: Path, *words: str) -> str:
    command = [sys.executable, "-m", "codespell_lib", "--toml", ROOT / "pyproject.toml", *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True).stdout


def test_no_word_is_misspelled() -> None:
    assert run_codespell(ROOT, *TREES) == ""


def test_a_misspelled_word_is_found(tmp_path: Path) -> None:
    (tmp_path / "page.md").write_text("One line.\nA sampel of a pictuer.\n")
    assert "page.md:2" in run_codespell(tmp_path, "page.md")
