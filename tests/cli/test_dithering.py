"""Renders are dithered unless the user says no; headers, resumed renders and goldens know which."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from halation.media import read_metadata, write_picture
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

IMAGE = {"": Kind.IMAGE}


def load(path: Path) -> np.ndarray:
    return oiio.ImageInput.open(str(path)).read_image(0, 0, 0, 3, "uint8").astype(float)


def test_a_render_says_how_and_can_be_told_not_to(cli, tmp_path):
    graph = tmp_path / "dark.json"
    graph.write_text(
        '{"halation": 1, "settings": {"size": [256, 64]}, "inputs": {"a": {"type": "Image"}}, '
        '"outputs": {"image": {}}, '
        '"links": {"outputs.image": "inputs.a"}}'
    )
    source = tmp_path / "ramp.exr"
    ramp = np.broadcast_to(np.linspace(0.001, 0.01, 256, dtype=np.float32)[None, :, None], (64, 256, 3))
    write_picture(source, {"": np.ascontiguousarray(ramp)}, kinds=IMAGE, precision="float", sandbox=UNRESTRICTED)
    out = tmp_path / "a.png"
    arguments = ("render", graph, "-i", f"a={source}", "-o", out)
    assert cli(*arguments).code == 0
    dithered = load(out)
    assert json.loads(str(read_metadata(out, sandbox=UNRESTRICTED)["halation:job"]))["dither"] == "blue"
    assert "kept" in cli(*arguments, "--resume").err
    assert cli("reproduce", out).code == 0
    assert "kept" not in cli(*arguments, "--resume", "--dither", "none").err
    plain = load(out)
    assert (np.abs(plain - plain[:1]).max(), np.abs(dithered - plain).max()) == (0, 1)
    assert "dither" not in json.loads(str(read_metadata(out, sandbox=UNRESTRICTED)["halation:job"]))
    assert cli("reproduce", out).code == 0
    wrong = cli(*arguments, "--dither", "bayer")
    assert wrong.code == 2 and "blue" in wrong.err


def test_a_picture_for_a_screen_comes_back_bit_by_bit(cli, tmp_path):
    codes = np.random.default_rng(5).integers(0, 256, (48, 64, 3), np.uint8)
    source, out, graph = tmp_path / "in.png", tmp_path / "out.png", tmp_path / "nothing.json"
    oiio.ImageBuf(codes).write(str(source))
    graph.write_text(
        '{"halation": 1, "inputs": {"a": {"type": "Image"}}, "outputs": {"image": {}}, '
        '"links": {"outputs.image": "inputs.a"}}'
    )
    for precision in ("half", "float"):
        words = () if precision == "half" else ("--precision", "half")
        assert cli("render", graph, "-i", f"a={source}", "-o", out, *words).code == 0
        np.testing.assert_array_equal(load(out), codes)


def test_regression_goldens_are_not_dithered(cli, tmp_path: Path):
    (tmp_path / "case.json").write_text(
        '{"halation": 1, "settings": {"size": [64, 64]}, "outputs": {"image": {}}, '
        '"nodes": {"ramp": {"type": "constant", "values": {"color": [0.0621, 0.0621, 0.0621, 1.0]}}}, '
        '"links": {"outputs.image": "ramp.out"}}'
    )
    (tmp_path / "a.suite.toml").write_text('[cases.dark]\ngraph = "case.json"\ngolden = "golden.png"\n')
    result = cli("test", tmp_path / "a.suite.toml", "--update")
    assert result.code == 0, result.out
    assert np.unique(load(tmp_path / "golden.png")).size == 1
    assert cli("render", tmp_path / "case.json", "-o", tmp_path / "out.png").code == 0
    assert np.unique(load(tmp_path / "out.png")).size == 2
