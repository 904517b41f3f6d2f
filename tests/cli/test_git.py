"""Git with the drivers of `git-setup`: a real repository, a real merge."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")

Git = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def repository(tmp_path, monkeypatch, graphs) -> Path:
    """A repository with a graph in a folder with a space, and with other JSON beside it."""
    home = tmp_path / "home"
    home.mkdir()
    for name in [name for name in os.environ if name.startswith("GIT_")]:
        monkeypatch.delenv(name)
    for name, text in {
        "HOME": str(home),
        "XDG_CONFIG_HOME": str(home),
        "GIT_CONFIG_NOSYSTEM": "1",
        "GIT_CEILING_DIRECTORIES": str(tmp_path),
        "NO_COLOR": "1",
        "LC_ALL": "C.UTF-8",
    }.items():
        monkeypatch.setenv(name, text)
    (home / ".gitconfig").write_text("[user]\n name = n\n email = e@f\n[init]\n defaultBranch = main\n")
    root = tmp_path / "a repository"
    (root / "my graphs").mkdir(parents=True)
    graphs("seed.json").rename(root / "my graphs" / "shot.json")
    (root / "my graphs" / "package.json").write_text('{\n"name": "x",\n"a": 1,\n"b": 2,\n"c": 3,\n"d": 4\n}\n')
    monkeypatch.chdir(root)
    return root


@pytest.fixture
def git(repository) -> Git:
    def run(*words: str, code: int = 0) -> subprocess.CompletedProcess[str]:
        done = subprocess.run(["git", *words], cwd=repository, capture_output=True, text=True, check=False)
        assert done.returncode == code, (words, done.stdout, done.stderr)
        return done

    run("init", "-q")
    return run


@pytest.fixture
def branches(cli, git, repository) -> Callable[..., None]:
    """`branches(ours=..., theirs=...)` commits two versions of the node `light`, one on each branch."""
    assert cli("git-setup").code == 0
    git("add", "-A")
    git("commit", "-qm", "begin")

    def made(ours: dict[str, object], theirs: dict[str, object]) -> None:
        for branch, nodes in (("theirs", theirs), ("main", ours)):
            git("checkout", "-q", *(("-b",) if branch == "theirs" else ()), branch)
            edit(repository, nodes)
            git("commit", "-qam", branch)

    return made


def edit(repository: Path, nodes: dict[str, object]) -> None:
    """Nodes put in, or in place of others, by hand."""
    path = repository / "my graphs" / "shot.json"
    tree = json.loads(path.read_text())
    tree["nodes"].update(nodes)
    path.write_text(json.dumps(tree))


def light(stops: float) -> dict[str, object]:
    return {"light": {"type": "exposure", "values": {"stops": stops}}}


def test_setting_up_says_what_it_changed_and_does_it_once(cli, git, repository):
    before = (repository / ".git" / "config").read_text()
    (repository / ".gitattributes").write_text("*.exr binary\n")
    said = cli("git-setup", "--json").json["changed"]
    assert len(said) == 5 and all(
        " -m halation.cli git-driver " in one for one in said if ".name" not in one and "git config" in one
    )
    lines = (repository / ".gitattributes").read_text().splitlines()
    assert lines == ["*.exr binary", '"/my graphs/*.json" diff=halation merge=halation']
    assert git("check-attr", "merge", "my graphs/shot.json").stdout.endswith(": merge: halation\n")
    assert cli("git-setup").out == "nothing needs to change\n"
    assert len(cli("git-setup", "--remove", "--json").json["changed"]) == 5
    assert (repository / ".gitattributes").read_text() == "*.exr binary\n"
    assert (repository / ".git" / "config").read_text().split() == before.split()
    assert cli("git-setup", "--remove").out == "nothing needs to change\n"


def test_patterns_and_the_configuration_of_a_person(cli, git, repository, tmp_path, monkeypatch):
    assert cli("git-setup", "*.graph.json", "shots/**/*.json", "--global").code == 0
    assert (repository / ".gitattributes").read_text().splitlines() == [
        "*.graph.json diff=halation merge=halation",
        "shots/**/*.json diff=halation merge=halation",
    ]
    assert "halation" in (tmp_path / "home" / ".gitconfig").read_text()
    assert "halation" not in (repository / ".git" / "config").read_text()
    assert cli("git-setup", "--remove", "*.graph.json").code == 0
    assert (repository / ".gitattributes").read_text() == "shots/**/*.json diff=halation merge=halation\n"
    monkeypatch.chdir(tmp_path)
    assert cli("git-setup").code == cli("git-setup", "--global", "*.json").code == 2
    assert cli("git-setup", "--global", "--remove").code == 0
    assert "halation" not in (tmp_path / "home" / ".gitconfig").read_text()


def test_two_people_change_one_graph(cli, git, branches, repository):
    branches({"more": {"type": "saturation"}}, light(2.5))
    git("merge", "-q", "-m", "both", "theirs")
    tree = json.loads((repository / "my graphs" / "shot.json").read_text())
    assert tree["nodes"]["light"]["values"] == {"stops": 2.5} and tree["nodes"]["more"]["type"] == "saturation"
    assert git("status", "--porcelain").stdout == ""
    assert cli("fmt", "--check", "my graphs/shot.json").code == 0


def test_a_conflict_is_one_for_git_and_valid_json(cli, git, branches, repository):
    branches(light(2.0), light(3.0))
    found = git("merge", "theirs", code=1)
    assert "CONFLICT" in found.stdout and "nodes.light.values.stops was changed by both sides" in found.stderr
    assert git("status", "--porcelain").stdout == 'UU "my graphs/shot.json"\n'
    path = repository / "my graphs" / "shot.json"
    tree = json.loads(path.read_text())
    assert tree["nodes"]["light"]["values"] == {"stops": 2.0} and tree["conflicts"][0]["theirs"] == 3.0
    assert cli("check", path).code == 3
    assert cli("merge", "--resolve", "theirs", path).code == 0
    git("commit", "-qam", "decided")
    assert cli("diff", "theirs:my graphs/shot.json", path).code == 0


def test_git_shows_what_changed(cli, git, branches, repository):
    branches({"more": {"type": "saturation"}}, light(2.5))
    edit(repository, light(-1.0))
    assert git("diff").stdout == "graph my graphs/shot.json\n~ light.stops: 1 EV -> -1 EV\n"
    for words in (("show", "theirs"), ("log", "-p", "-1", "theirs")):
        lines = git(*words).stdout.splitlines()
        assert [line for line in lines if line.startswith(("+", "-")) and line[:3] not in ("+++", "---")] == [
            "-light.stops: 1 EV",
            "+light.stops: 2.5 EV",
        ]
    git("checkout", "-q", "my graphs")
    git("mv", "my graphs/shot.json", "my graphs/moved.json")
    git("rm", "-q", "--cached", "my graphs/package.json")
    said = git("diff", "-M", "HEAD").stdout
    assert "graph my graphs/shot.json -> my graphs/moved.json\n" in said


def test_layout_and_new_and_deleted_graphs(cli, git, branches, repository):
    path = repository / "my graphs" / "shot.json"
    tree = json.loads(path.read_text())
    path.write_text(json.dumps({**tree, "ui": {"nodes": {"light": {"x": 1, "y": 2}}}}))
    assert git("diff").stdout.splitlines() == [
        "graph my graphs/shot.json",
        "  only the layout or the formatting of the file",
    ]
    path.rename(path.with_name("other.json"))
    git("add", "-A")
    said = git("diff", "--no-renames", "HEAD").stdout.splitlines()
    assert said[0] == "graph my graphs/other.json, new" and "graph my graphs/shot.json, deleted" in said
    assert {line.partition(":")[0] for line in said} >= {"- node light", "+ node light"}


def test_other_json_stays_text(cli, git, branches, repository):
    path = repository / "my graphs" / "package.json"
    git("checkout", "-qb", "theirs")
    path.write_text(path.read_text().replace('"a": 1', '"a": 9'))
    assert '-"a": 1,\n+"a": 9,' in git("diff").stdout
    git("commit", "-qam", "theirs")
    git("checkout", "-q", "main")
    path.write_text(path.read_text().replace('"d": 4', '"d": 8'))
    git("commit", "-qam", "ours")
    git("merge", "-q", "-m", "both", "theirs")
    assert json.loads(path.read_text()) == {"name": "x", "a": 9, "b": 2, "c": 3, "d": 8}


def test_a_conflict_of_other_json_is_that_of_git(cli, git, branches, repository):
    """Both sides are in the file, as without Halation, and nothing but git's own words is said."""
    path = repository / "my graphs" / "package.json"
    git("checkout", "-qb", "theirs")
    path.write_text(path.read_text().replace('"a": 1', '"a": 9'))
    git("commit", "-qam", "theirs")
    git("checkout", "-q", "main")
    path.write_text(path.read_text().replace('"a": 1', '"a": 7'))
    git("commit", "-qam", "ours")
    found = git("merge", "theirs", code=1)
    assert "CONFLICT" in found.stdout and not found.stderr
    assert '<<<<<<< ours\n"a": 7,\n=======\n"a": 9,\n>>>>>>> theirs\n' in path.read_text()


def test_a_side_that_cannot_be_read_loses_nothing(cli, git, branches, repository):
    path = repository / "my graphs" / "shot.json"
    branches(light(2.0), {"light": 3})
    found = git("merge", "theirs", code=1)
    assert "it cannot be merged, and our side stays as it is" in found.stderr
    assert json.loads(path.read_text())["nodes"]["light"]["values"] == {"stops": 2.0}
    assert git("status", "--porcelain").stdout == 'UU "my graphs/shot.json"\n'


def test_versions_in_git(cli, git, branches, repository, monkeypatch):
    branches(light(2.0), light(3.0))
    found = cli("diff", "theirs:my graphs/shot.json", "my graphs/shot.json")
    assert (found.code, found.out) == (1, "~ light.stops: 3 EV -> 2 EV\n")
    monkeypatch.chdir(repository / "my graphs")
    assert cli("diff", "theirs:shot.json", "HEAD~1:my graphs/shot.json").out == "~ light.stops: 3 EV -> 1 EV\n"
    found = cli("merge", "main~1:shot.json", "main:shot.json", "theirs:shot.json")
    assert found.code == 1 and json.loads(found.out)["conflicts"]
    for wrong in ("nobody:shot.json", "main:none.json", "main:", ":"):
        found = cli("diff", wrong, "shot.json")
        assert found.code == 3 and wrong in found.err, found
    monkeypatch.chdir(repository.parent)
    found = cli("diff", "main:shot.json", "a repository/my graphs/shot.json")
    assert found.code == 3 and "main:shot.json: there is no such file (not a git repository" in found.err
