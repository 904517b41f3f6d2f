"""The linter finds nothing in the product and its tests, and all code has the one format."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def ruff(*words: str) -> None:
    result = subprocess.run(
        [sys.executable, "-m", "ruff", *words, "--no-cache", "."],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_linter_finds_nothing() -> None:
    ruff("check", "--output-format", "concise")


def test_the_format_is_the_one_of_ruff() -> None:
    """`python -m ruff format .` writes it."""
    ruff("format", "--check")
