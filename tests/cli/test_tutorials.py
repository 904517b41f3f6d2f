"""Tutorials and pages of commands work as they are written: every file, every command and its output, in order."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_BLOCK = re.compile(r"(?P<before>[^\n]*\n)?\n?```(?P<language>\w+)\n(?P<text>.*?)```", re.DOTALL)
_EXIT_CODE = re.compile(r"# exit code (\d+)$")
_NAME = re.compile(r"`([\w/.-]+\.(?:json|toml|glsl))`")


def halation(words: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    return subprocess.run(
        words,
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        env={**os.environ, "PATH": path},
    )


@pytest.mark.parametrize(("page", "plate"), [("pipeline", "plates/shot.exr"), ("programmer", "")])
@pytest.mark.skipif(not shutil.which("git"), reason="git is not installed")
def test_a_tutorial(page: str, plate: str, tmp_path: Path) -> None:
    if plate:
        (tmp_path / plate).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / "presets" / "samples" / "neon.exr", tmp_path / plate)
    follow_page(f"tutorial-{page}.md", tmp_path)
    if page == "pipeline":
        text = (ROOT / "docs" / "tutorial-pipeline.md").read_text(encoding="utf-8")
        ((before, after),) = re.findall(r"`intensity` from ([\d.]+) to ([\d.]+), the build fails", text)
        look = tmp_path / "looks" / "warm.json"
        graph = look.read_text("utf-8")
        assert f'"intensity": {before}' in graph
        look.write_text(graph.replace(f'"intensity": {before}', f'"intensity": {after}'), encoding="utf-8")
        assert halation(["halation", "test"], tmp_path).returncode == 1


@pytest.mark.nightly  # its commands have tests of their own, which pages repeat: 19 s of processor time
def test_each_job_of_the_page_how_to(tmp_path: Path) -> None:
    follow_page("how-to.md", tmp_path)
    for name in ("relit.exr", "comp.png", "film.jpg", "toon.png", "loop.0019.png", "planet.jpg", "lens.jpg"):
        assert (tmp_path / name).stat().st_size > 1000, name
    assert len(list((tmp_path / "graded").iterdir())) == 4


@pytest.mark.nightly  # fifteen commands: 12 s of processor time
def test_a_whole_shot(tmp_path: Path) -> None:
    follow_page("tutorial-shot.md", tmp_path)
    for name in ("matte.png", "look.png", "second.png", "master/slate.png", "dailies/shot.0003.jpg"):
        assert (tmp_path / name).stat().st_size > 1000, name


@pytest.mark.nightly  # twenty-four commands: 15 s of processor time
@pytest.mark.skipif(sys.platform != "linux", reason="other systems bring OpenGL")
def test_each_symptom_of_the_page_troubleshooting(tmp_path: Path) -> None:
    follow_page("troubleshooting.md", tmp_path)
    assert (tmp_path / "passes.html").stat().st_size > 1000


def follow_page(page: str, tmp_path: Path) -> None:
    """Write each file that a page shows, and run each command, in order.

    A command ends with the exit code that a comment behind it says, else with 0. A block of text is what the command
    before it prints, or a part of that, with `...` for what may differ.
    """
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    ran = 0
    printed = ""
    for block in _BLOCK.finditer(text):
        language, body = block["language"], block["text"]
        named = _NAME.findall(text[: block.start() + len(block["before"] or "")].rstrip().rpartition("\n\n")[2])
        if language in ("json", "toml", "glsl"):
            assert named, body
            target = tmp_path / named[0]
            target.parent.mkdir(exist_ok=True)
            target.write_text(body, encoding="utf-8")
        elif language == "python":
            ended = halation([sys.executable, "-c", body], tmp_path)
            assert ended.returncode == 0, ended.stderr
            printed = ended.stdout
        elif language == "text":
            wanted = ".*?".join(re.escape(" ".join(part.split())) for part in body.split("..."))
            assert re.search(wanted, " ".join(printed.split())), (body, printed)
        else:
            for line in body.splitlines():
                # A `#` within a word is a place for the number of a frame.
                command, _, into = line.partition(" #")[0].partition(" > ")
                ended = halation(shlex.split(command), tmp_path)
                code = _EXIT_CODE.search(line)
                assert ended.returncode == (int(code[1]) if code else 0), (line, ended.stdout, ended.stderr)
                assert " check " not in line or "warning" not in ended.stdout, (line, ended.stdout)
                printed = ended.stdout + ended.stderr
                if into:
                    (tmp_path / into).write_text(ended.stdout, encoding="utf-8")
                ran += 1
    assert ran >= 8
