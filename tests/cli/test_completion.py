"""Completion in shells: what the shell asks for, and its own check of the script."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CODE = "import sys; sys.argv[0] = 'halation'; from halation.cli import main; main()"


def ask(*words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run halation as the script of a shell does."""
    environment = {**os.environ, **variables}
    return subprocess.run([sys.executable, "-c", CODE, *words], env=environment, capture_output=True, text=True)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("halation re", {"render", "reproduce"}),
        ("halation render --pre", {"--precision"}),
        ("halation git-s", {"git-setup"}),
        ("halation wor", set()),
    ],
)
def test_commands_and_options_are_completed(line: str, words: set[str]) -> None:
    place = str(len(line.split()) - 1)
    answer = ask(COMP_WORDS=line, COMP_CWORD=place, _HALATION_COMPLETE="complete_bash")
    assert (answer.returncode, answer.stderr) == (0, "")
    assert set(answer.stdout.split()) == words


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_scripts_name_the_program(shell: str) -> None:
    script = ask(_HALATION_COMPLETE=f"source_{shell}")
    assert script.returncode == 0 and "halation" in script.stdout and "_HALATION_COMPLETE" in script.stdout


def test_bash_completes_with_the_script(tmp_path: Path) -> None:
    """Bash itself runs the script and fills COMPREPLY."""
    (tmp_path / "script").write_text(ask(_HALATION_COMPLETE="source_bash").stdout)
    (tmp_path / "halation").write_text(f"#!/bin/sh\nexec '{sys.executable}' -c \"{CODE}\"\n")
    (tmp_path / "halation").chmod(0o755)
    lines = f"source {tmp_path}/script; COMP_WORDS=(halation swe); COMP_CWORD=1"
    lines += f"; _halation_completion {tmp_path}/halation; echo ${{COMPREPLY[*]}}"
    answer = subprocess.run([shutil.which("bash") or "bash", "-c", lines], capture_output=True, text=True)
    assert answer.stdout.split() == ["sweep"]
