"""The repository that users are told to copy is right, small, and fails when a look changes by a percent."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest

SAMPLE = Path(__file__).parents[2] / "docs/sample"
LINES = [
    line.strip().removeprefix("- ").removeprefix("run: ")
    for name in (".github/workflows/pictures.yml", ".gitlab-ci.yml")
    for line in (SAMPLE / name).read_text().splitlines()
]


@pytest.fixture
def sample(tmp_path: Path) -> Path:
    shutil.copytree(SAMPLE, tmp_path, dirs_exist_ok=True)
    return tmp_path


def test_it_passes_and_notices_one_percent(cli, sample: Path) -> None:
    assert cli().code == 0
    graph = sample / "graphs/glow.json"
    tree = json.loads(graph.read_text())
    tree["nodes"]["bloom"]["values"]["intensity"] *= 1.01
    graph.write_text(json.dumps(tree))
    result = cli("--json")
    assert result.code == 1
    assert [case["name"] for case in result.json["cases"] if case["status"] == "failed"] == ["glow"]


def test_it_is_small_and_names_no_place(sample: Path) -> None:
    files = [path for path in sample.rglob("*") if path.is_file()]
    assert sum(path.stat().st_size for path in files) < 300_000
    assert not [path for path in files if re.search(rb"[\s\"'=]/(home|root|tmp|work|Users)/", path.read_bytes())]


def test_servers_run_the_commands_that_there_are(cli, sample: Path) -> None:
    commands = [line for line in LINES if line.startswith("halation ")]
    assert len(commands) == 4
    for line in sorted(set(commands)):
        words = [word for word in line.split()[1:] if word != "graphs/*.json"]
        if words[0] == "test":
            assert cli(*words[1:]).code == 0
    assert (sample / "report.html").is_file() and (sample / "junit.xml").is_file()
