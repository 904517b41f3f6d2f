"""export-isf, and nodes of a file of code."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from exr_files import read
from isf_files import IMAGE, isf

BLUR = {
    "nodes": {"blur": {"type": "gaussian_blur", "values": {"sigma": 1.5}}},
    "links": {"blur.image": "light.out", "outputs.image": "blur.out"},
    "controls": {"gain": {"target": "light.stops", "label": "Gain"}, "soft": {"target": "blur.sigma"}},
}


def test_a_shader_renders_as_its_graph_does(cli, graphs, tmp_path: Path) -> None:
    graph = graphs(**BLUR)
    result = cli("export-isf", graph, "-o", tmp_path / "blur.fs")
    assert (result.code, result.out) == (0, "") and "control 'soft' keeps its value" in result.err
    again = graphs(
        "again.json",
        nodes={"light": {"type": "isf", "file": "blur.fs", "values": {"gain": 1.0}}},
        links={"light.inputImage": "inputs.beauty", "outputs.image": "light.out"},
    )
    tree = json.loads(again.read_text())
    del tree["links"]["light.image"]
    again.write_text(json.dumps(tree))
    pixels = []
    for path in (graph, again):
        out = tmp_path / f"{path.stem}.exr"
        assert cli("render", path, "-o", out, "--precision", "float").code == 0
        pixels.append(read(out))
    assert pixels[0].shape == pixels[1].shape and np.abs(pixels[0] - pixels[1]).max() < 2e-3


def test_to_standard_output_and_for_machines(cli, graphs, tmp_path: Path) -> None:
    graph = graphs()
    shader = cli("export-isf", graph).out
    assert shader.startswith("/*{") and "void main()" in shader
    found = cli("export-isf", graph, "-o", tmp_path / "a.fs", "--json")
    assert found.json == {"file": str(tmp_path / "a.fs"), "notes": []} and (tmp_path / "a.fs").read_text() == shader


def test_a_selection(cli, graphs) -> None:
    graph = graphs(**BLUR)
    result = cli("export-isf", graph, "--select", "blur")
    assert result.code == 0 and '"inputImage"' in result.out and "gain" not in result.out
    assert '"PASSES"' in result.out
    assert '"PASSES"' not in cli("export-isf", graph, "--node", "light").out


def test_reasons_name_nodes(cli, graphs, tmp_path: Path) -> None:
    nodes = {"back": {"type": "feedback"}, "cut": {"type": "depth_slice"}, "held": {"type": "merge"}}
    links = {"back.image": "light.out", "outputs.image": "back.out"}
    graph = graphs(nodes={"back": nodes["back"]}, links=links)
    result = cli("export-isf", graph, "-o", tmp_path / "no.fs")
    assert result.code == 3 and "node 'back' remembers the frame before" in result.err
    assert not (tmp_path / "no.fs").exists()


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["--json"], 2, "both go to standard output"),
        (["--select", "nobody"], 2, "there is no node 'nobody'"),
        (["--node", "nobody"], 2, "nobody"),
        (["--size", "0x3"], 2, "size"),
        (["-o", "none/a.fs"], 1, "none"),
    ],
)
def test_mistakes(cli, graphs, words: list[str], code: int, said: str) -> None:
    result = cli("export-isf", graphs(), *words)
    assert (result.code, "Traceback" in result.err) == (code, False) and said in result.err


def test_nodes_of_a_file(cli, tmp_path: Path) -> None:
    path = tmp_path / "Glow.fs"
    path.write_text(
        isf(
            "gl_FragColor = IMG_THIS_PIXEL(inputImage) * amount;",
            IMAGE,
            {"NAME": "amount", "TYPE": "float", "DEFAULT": 0.5, "MAX": 4},
            DESCRIPTION="Shines.",
        )
    )
    found = cli("nodes", path)
    assert found.code == 0 and "Shines." in found.out and "inputImage" in found.out and "Glow.fs" in found.out
    assert cli("nodes", path, "--json").json["values"]["amount"]["default"] == 0.5
    path.write_text("/*{*/")
    result = cli("nodes", path)
    assert result.code == 2 and "line 1: the head is no JSON" in result.err
