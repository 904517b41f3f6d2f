"""`halation fmt` of folders, patterns and standard input."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest


@pytest.fixture
def piped(monkeypatch):
    """Standard input."""

    def given(data: bytes) -> None:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    return given


def test_standard_input_goes_to_standard_output(cli, graphs, piped):
    path = graphs()
    messy = path.read_bytes()
    piped(messy)
    found = cli("fmt", "-")
    assert (found.code, found.err, path.read_bytes()) == (0, "", messy)
    assert cli("fmt", path).code == 0 and path.read_text() == found.out
    for text, code in ((messy, 1), (path.read_bytes(), 0)):
        piped(text)
        found = cli("fmt", "-", "--check")
        assert (found.code, found.out) == (code, "")


def test_a_broken_text_prints_nothing(cli, piped):
    piped(b"{")
    found = cli("fmt", "-")
    assert (found.code, found.out) == (3, "") and "-: not valid JSON" in found.err
    piped(b"")
    assert cli("fmt", "-").code == 3


def test_the_name_of_standard_input_says_where_paths_start(cli, graphs, piped, tmp_path):
    graphs("inner.json")
    text = b'{"halation": 1, "nodes": {"g": {"type": "group", "path": "inner.json"}}}'
    piped(text)
    assert cli("fmt", "-").code == 3
    piped(text)
    assert cli("fmt", "-", "--stdin-name", tmp_path / "outer.json").code == 0


@pytest.mark.parametrize("words", [("-", "a.json"), ("-", "--json")])
def test_standard_input_stands_alone(cli, words):
    assert cli("fmt", *words).code == 2


def test_folders_and_patterns(cli, graphs, tmp_path):
    for name in ("shots/a.json", "shots/deep/b.json", "shots/.hidden/c.json"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        graphs(name)
    (tmp_path / "shots/package.json").write_text('{"name":1}')
    (tmp_path / "shots/list.json").write_text("[]")
    found = cli("fmt", tmp_path / "shots", "--check", "--json")
    assert found.code == 1
    assert found.json == {
        "changed": [str(tmp_path / "shots/a.json"), str(tmp_path / "shots/deep/b.json")],
        "checked": 2,
        "written": False,
    }
    assert cli("fmt", tmp_path / "shots/**/b.json", tmp_path / "shots/deep", "--json").json["checked"] == 1
    assert cli("fmt", "--check", tmp_path / "shots/deep/*.json").code == 0
    assert cli("fmt", tmp_path / "shots").code == 0 and cli("fmt", tmp_path / "shots", "--check").code == 0
    assert Path(tmp_path / "shots/package.json").read_text() == '{"name":1}'
    assert cli("fmt", tmp_path / "none").code == 3


def test_installed_packages_are_not_the_projects(cli, graphs, tmp_path, monkeypatch):
    """A folder and a pattern leave out virtual environments and packages of others; a folder that is named is meant."""
    for name in ("look.json", "env/share/a.json", "node_modules/b.json", "tools/site-packages/c.json", "conda/d.json"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        graphs(name)
    (tmp_path / "env/pyvenv.cfg").touch()
    (tmp_path / "conda/conda-meta").mkdir()
    foreign = {path: path.read_bytes() for path in tmp_path.rglob("[abcd].json")}
    monkeypatch.chdir(tmp_path)
    assert len(foreign) == 4
    for word in (".", tmp_path, "**/*.json"):
        assert cli("fmt", word, "--json").json["checked"] == 1, word
        assert [Path(report["graph"]).name for report in cli("check", word, "--json").json["graphs"]] == ["look.json"]
    assert foreign == {path: path.read_bytes() for path in foreign}
    for word in ("env", "node_modules/*.json", "tools/site-packages", "conda/d.json"):
        assert cli("fmt", word, "--check", "--json").json["checked"] == 1, word
    monkeypatch.chdir(tmp_path / "env")
    assert cli("fmt", "**/*.json", "--check", "--json").json["checked"] == 1


def test_suites_of_installed_packages_are_not_run(cli, tmp_path):
    (tmp_path / "env").mkdir()
    (tmp_path / "env/pyvenv.cfg").touch()
    for name in ("mine", "env/theirs"):
        (tmp_path / f"{name}.suite.toml").write_text('[cases.a]\ngraph = "group.json"\ngolden = "a.exr"\n')
    cases = cli("test", tmp_path, "--list", "--json").json["cases"]
    assert [Path(case["graph"]).parent for case in cases] == [tmp_path]
