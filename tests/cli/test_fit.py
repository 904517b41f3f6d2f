"""`halation fit`: a graph with the values that a reference was made with, and what the command says."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from exr_files import read


@pytest.fixture
def graded(cli, graphs, tmp_path):
    """The shot at 0.4 stops, as PNG and as EXR."""
    for name in ("graded.png", "graded.exr"):
        assert cli("render", graphs(), "--set", "light.stops=0.4", "-o", tmp_path / name).code == 0
    return tmp_path


@pytest.mark.parametrize("name", ["graded.png", "graded.exr"])
def test_the_values_of_a_reference_are_written(cli, graphs, graded, name):
    (graded / "out").mkdir()
    words = ("--to", graded / name, "--values", "light.stops", "-o", graded / "out" / "fitted.json")
    result = cli("fit", graphs(), *words, "--json")
    assert result.code == 0, result.err
    (value,) = result.json["values"]
    assert value["before"] == 1.0 and value["after"] == pytest.approx(0.4, abs=0.01) and value["is_determined"]
    assert result.json["delta_e"][0] > 5.0 > 0.5 > result.json["delta_e"][1]
    again, expected = graded / "again.exr", graded / "expected.exr"
    assert cli("render", graded / "out" / "fitted.json", "-o", again).code == 0, "paths follow to the other folder"
    assert cli("render", graphs(), "--set", f"light.stops={value['after']}", "-o", expected).code == 0
    np.testing.assert_array_equal(read(again), read(expected))


def test_the_page_has_values_and_pictures_and_loads_nothing(cli, graphs, graded):
    words = ("--to", graded / "graded.png", "--values", "light.stops=0..3", "--report", graded / "page.html")
    result = cli("fit", graphs(), *words, "-o", graded / "fitted.json", "--renders", 20)
    assert result.code == 0 and "light.stops" in result.out and "CIEDE2000" in result.out
    page = (graded / "page.html").read_text("utf-8")
    assert "<td>light.stops</td><td>1</td>" in page and "/*" not in page and "<script" not in page
    assert page.count("data:image/png;base64,") == 1 and "http" not in page.replace("http-equiv", "")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--values", "light.stosp"), "--values light.stosp: the graph has no such value; did you mean 'light.stops'?"),
        (("--values", "light.stops=3..1"), "--values light.stops=3..1: write a range as LOW..HIGH"),
        (("--values", "light.stops", "--budget", "soon"), "--budget soon: write how long the search may take"),
        (("--values", "light.stops", "--by", "eye"), "--by eye: write pixels for the same frame, or look"),
        (("--values", "light.stops", "-o", "fitted.exr"), "this is the graph that is written"),
        (("--values", "light.stops", "--to", "none.png"), "none.png: there is no such file"),
    ],
)
def test_what_makes_no_sense_is_refused(cli, graphs, graded, words, sentence):
    given = {"--to": graded / "graded.png", "-o": graded / "fitted.json"}
    given.update({words[at]: words[at + 1] for at in range(2, len(words), 2)})
    result = cli("fit", graphs(), *words[:2], *(word for pair in given.items() for word in pair))
    assert result.code in (2, 4) and sentence in result.err, result
    assert not (graded / "fitted.json").exists()


def test_without_the_extra_it_says_what_to_install(cli, graphs, graded, monkeypatch):
    monkeypatch.setitem(sys.modules, "cma", None)
    words = ("--to", graded / "graded.png", "--values", "light.stops", "-o", graded / "fitted.json")
    assert "run pip install 'halation[fit]'" in cli("fit", graphs(), *words).err
