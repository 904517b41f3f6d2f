"""`halation diff`: exit codes like diff's, words for people, facts for machines, pictures if asked."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import read


@pytest.fixture
def two(graphs) -> tuple[Path, Path]:
    """The same graph with two stops in place of one."""
    return graphs("a.json"), graphs("b.json", nodes={"light": {"type": "exposure", "values": {"stops": 2.0}}})


def test_same_different_and_trouble(cli, two, tmp_path):
    a, b = two
    assert (cli("diff", a, a).code, cli("diff", a, a).out) == (0, "")
    found = cli("diff", a, b)
    assert (found.code, found.out, found.err) == (1, "~ light.stops: 1 EV -> 2 EV\n", "")
    back = cli("diff", b, a)
    assert back.out == "~ light.stops: 2 EV -> 1 EV\n"
    assert cli("diff", a, tmp_path / "none.json").code == 3
    assert cli("diff", a).code == 2


def test_how_a_file_is_written_makes_no_difference(cli, graphs):
    a, b = graphs("a.json"), graphs("b.json")
    assert cli("fmt", b).code == 0 and a.read_bytes() != b.read_bytes()
    b.write_bytes(b"\xef\xbb\xbf" + b.read_bytes().replace(b"\n", b"\r\n"))
    assert cli("diff", a, b).code == 0


def test_layout_only_if_asked(cli, graphs):
    a, b = graphs("a.json"), graphs("b.json", ui={"nodes": {"light": {"x": 5, "y": 6}}})
    assert cli("diff", a, b).code == 0
    found = cli("diff", a, b, "--layout")
    assert found.code == 1 and "layout ui" in found.out


def test_for_machines(cli, two):
    a, b = two
    found = cli("diff", a, b, "--json")
    assert found.code == 1 and found.json == {
        "a": str(a),
        "b": str(b),
        "same": False,
        "renamed": [],
        "changes": [{"at": ["nodes", "light", "values", "stops"], "before": 1.0, "after": 2.0}],
        "lines": ["~ light.stops: 1 EV -> 2 EV"],
    }
    assert cli("diff", a, a, "--json").json["same"] is True


def test_a_group_in_a_file_needs_not_be_there(cli, graphs):
    """Old versions rarely lie beside all that they name."""
    one, two = ({"nodes": {"g": {"type": "group", "path": path}}} for path in ("gone.json", "gone2.json"))
    found = cli("diff", graphs("a.json", **one), graphs("b.json", **two))
    assert (found.code, found.out) == (1, '~ g.path: "gone.json" -> "gone2.json"\n')


def test_standard_input(cli, two, monkeypatch):
    a, b = two
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b.read_bytes())))
    assert cli("diff", a, "-").out == "~ light.stops: 1 EV -> 2 EV\n"
    assert cli("diff", "-", "-").code == 2


@pytest.mark.parametrize(
    ("words", "colored"),
    [
        ({}, False),
        ({"GIT_PAGER_IN_USE": "true"}, True),
        ({"GIT_PAGER_IN_USE": "true", "NO_COLOR": "1"}, False),
        ({"GIT_PAGER_IN_USE": "true", "TERM": "dumb"}, False),
    ],
)
def test_color(cli, two, monkeypatch, words, colored):
    monkeypatch.setenv("TERM", "xterm")
    for name in ("NO_COLOR", "GIT_PAGER_IN_USE"):
        monkeypatch.delenv(name, raising=False)
    for name, text in words.items():
        monkeypatch.setenv(name, text)
    assert ("\x1b[36m" in cli("diff", *two).out) == colored


def test_nothing_in_a_graph_moves_the_terminal(cli, graphs):
    evil = {"type": "later", "x": "a\x1b]0;title\x07\x9b31m", "code": ["\x1b[2J"]}
    found = cli("diff", graphs("a.json"), graphs("b.json", nodes={"e\u0301vil": evil}))
    assert found.code == 1 and all(letter.isprintable() for letter in found.out.replace("\n", ""))


@pytest.mark.parametrize(
    "words", [("-o", "x.png"), ("--scale", "0.5"), ("--render", "-o", "x.jpg"), ("--render", "--scale", "7")]
)
def test_flags_that_make_no_sense(cli, two, words):
    assert cli("diff", *two, *words).code == 2


def test_pictures(cli, two, tmp_path, shot):
    """The numbers are those of the files that `render` makes of both."""
    a, b = two
    pictures = []
    for path in two:
        assert cli("render", path, "-o", tmp_path / "p.exr", "--precision", "float").code == 0
        pictures.append(read(tmp_path / "p.exr"))
    distance = np.abs(pictures[1].astype(np.float64) - pictures[0])
    found = cli("diff", a, b, "--render", "--json", "-o", tmp_path / "side.png")
    assert found.code == 1
    (told,) = found.json["pictures"]
    assert told["output"] == "image" and told["max_abs"] == pytest.approx(distance.max(), rel=2e-3)
    assert told["rms"] == pytest.approx(np.sqrt(np.mean(distance**2)), rel=2e-3)
    assert 0.0 < told["flip"] < 1.0 and told["psnr"] > 0.0
    sheet = oiio.ImageBuf(str(tmp_path / "side.png"))
    assert sheet.spec().width > 3 * 48 and not sheet.has_error
    same = cli("diff", a, a, "--render")
    assert (same.code, same.out) == (0, "= picture image: the same\n")


def test_pictures_of_graphs_that_differ_in_their_ends(cli, graphs):
    more: dict[str, Any] = {
        "outputs": {"far": {"type": "Field"}},
        "inputs": {"depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"}},
        "links": {"outputs.far": "inputs.depth"},
    }
    a, b = graphs("a.json"), graphs("b.json", **more)
    found = cli("diff", a, b, "--render", "-i", "depth=shot.exr:Depth", "--json")
    assert found.code == 4, "a path on the command line starts at this folder"
    found = cli("diff", a, b, "--render", "--json")
    said = {one["output"]: one for one in found.json["pictures"]}
    assert found.code == 1 and said["image"]["same"] and said["far"]["words"] == f"only {b} has it"
    assert cli("diff", a, b, "--render", "-i", "nothing=shot.exr").code == 2


def test_a_picture_that_cannot_be_written_is_trouble(cli, two, tmp_path):
    found = cli("diff", *two, "--render", "-o", tmp_path / "no" / "x.png", "--json")
    assert found.code == 2 and json.loads(found.out)["error"]["exit_code"] == 2
