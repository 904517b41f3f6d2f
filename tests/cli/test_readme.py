"""The command lines of the README run as they are printed, on the README's own graph and the sample frame."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from halation import document, presets
from halation.resources.sandbox import UNRESTRICTED

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
GRAPH = re.findall(r"```json\n(.*?)```", README, re.S)[0]
LINES = [line.partition(" #")[0].strip() for line in re.findall(r"^halation .*", README, re.M)]
ELSEWHERE = ("edit", "serve", "watch", "gallery", "test")
"""Commands that open a window, wait, do not end, take minutes or need a suite; tests of their own run them."""
RUN = [line for line in LINES if shlex.split(line)[1] not in ELSEWHERE and "--cluster" not in line]


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A repository with the graph of the README, twice, and two frames."""
    folder = tmp_path_factory.mktemp("readme")
    shutil.copy(presets.sample(), folder / "shot.exr")
    (folder / "shots").mkdir()
    shutil.copy(presets.sample(), folder / "shots" / "first.exr")
    (folder / "graph.json").write_text(GRAPH, encoding="utf-8")
    (folder / "look.json").write_text(GRAPH, encoding="utf-8")
    who = ("-c", "user.name=A", "-c", "user.email=a@example.org")
    for words in (("init", "-q"), ("add", "."), (*who, "commit", "-q", "-m", "graphs")):
        subprocess.run(["git", *words], cwd=folder, check=True)
    return folder


@pytest.mark.skipif(not shutil.which("git"), reason="git is not installed")
@pytest.mark.parametrize("line", RUN)
def test_a_line_runs(cli, repository, monkeypatch, line):
    """In their order, since a later line may use the picture of an earlier one."""
    monkeypatch.chdir(repository)
    words = shlex.split(re.sub(r"\[(\w+)\]", r"\1", line))[1:]
    if words[0] == "reproduce" and not Path(words[1]).exists():
        assert cli("render", "graph.json", "-o", words[1]).code == 0
    if words[0] == "fit":
        reference = words[words.index("--to") + 1]
        assert cli("render", "graph.json", "--set", "grade.stops=1", "-o", reference).code == 0
    result = cli(*words)
    assert result.code == 0, result
    assert words[0] != "check" or "warning" not in result.out


def test_most_lines_run():
    assert len(RUN) >= 12


def test_the_graph_is_printed_as_fmt_writes_it():
    assert document.dumps(document.loads(GRAPH, sandbox=UNRESTRICTED)) == GRAPH


@pytest.mark.parametrize("page", ["tutorial-programmer", "tutorial-pipeline"])
def test_graphs_of_tutorials_are_printed_as_fmt_writes_them(page, tmp_path):
    text = (Path(__file__).parents[2] / "docs" / f"{page}.md").read_text(encoding="utf-8")
    for language, body in re.findall(r"```(json|glsl)\n(.*?)```", text, re.S):
        if language == "glsl":
            (tmp_path / "scan.glsl").write_text(body, encoding="utf-8")
        else:
            assert document.dumps(document.loads(body, "graph.json", str(tmp_path), sandbox=UNRESTRICTED)) == body
