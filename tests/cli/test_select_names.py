"""Pictures that are chosen by name on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation import document
from halation.graph import Control, Graph, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.input.constant import Constant
from halation.nodes.merge.select import Select
from halation.resources.sandbox import UNRESTRICTED


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A selection of `red` and `blue`, with a control `color`."""
    graph = Graph(settings=Settings((8, 8))).add("pick", Select(names="red, blue", choice="blue"))
    for socket, color in (("a", (1.0, 0.0, 0.0, 1.0)), ("b", (0.0, 0.0, 1.0, 1.0))):
        graph = graph.add(f"fill_{socket}", Constant(color=color))
        graph = graph.connect(Port(f"fill_{socket}", "out"), Port("pick", socket))
    graph = graph.add_output("image", Output(Kind.IMAGE)).connect(Port("pick", "out"), Port("outputs", "image"))
    document.save(
        graph.add_control("color", Control(Port("pick", "choice"))), tmp_path / "g.json", sandbox=UNRESTRICTED
    )
    return tmp_path / "g.json"


def test_a_file_holds_the_name_and_a_control_says_the_names(cli, path):
    assert '"choice": "blue"' in path.read_text()
    assert cli("info", path, "--json").json["controls"]["color"]["range"] == "red, blue"


@pytest.mark.parametrize("setting", ["pick.choice=red", "color=red", "color=1"])
def test_a_name_is_set(cli, path, setting):
    assert "fill_b" in cli("explain", path).out
    explained = cli("explain", path, "--set", setting).out
    assert "fill_a" in explained and "fill_b" not in explained


def test_each_name_is_swept(cli, path, tmp_path):
    run = cli("sweep", path, "-o", tmp_path / "sheet.png", "--set", "color=*")
    assert run.code == 0, run.err


def test_an_unknown_name_is_refused(cli, path):
    sentence = "'rad' is not a choice: it takes one of red, blue, or a number up to 8"
    run = cli("explain", path, "--set", "pick.choice=rad")
    assert run.code != 0 and f"--set pick.choice=rad: {sentence}" in run.err.replace("\n", " ")
    path.write_text(path.read_text().replace('"choice": "blue"', '"choice": "rad"'))
    run = cli("check", path)
    report = " ".join((run.out + run.err).split())
    assert run.code == 3 and "g.json" in report and f"pick.choice: {sentence}" in report
