"""What is made for a screen comes back as it was; light of a scene is brought to the screen by the config's view."""

from __future__ import annotations

import json
from pathlib import Path

import av
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.color.display import to_display

SIZE = (64, 48)
CODES = np.random.default_rng(18).integers(0, 256, (SIZE[1], SIZE[0], 3), np.uint8)


@pytest.fixture(autouse=True)
def no_environment(monkeypatch):
    monkeypatch.delenv("OCIO", raising=False)


@pytest.fixture
def graph(tmp_path: Path) -> Path:
    """A graph that changes nothing."""
    path = tmp_path / "nothing.json"
    path.write_text(
        '{"halation": 1, "inputs": {"beauty": {"type": "Image"}}, "outputs": {"image": {}}, '
        '"links": {"outputs.image": "inputs.beauty"}}'
    )
    return path


@pytest.fixture
def merge(tmp_path: Path) -> Path:
    """A graph that adds two pictures."""
    path = tmp_path / "merge.json"
    path.write_text(
        '{"halation": 1, "inputs": {"a": {"type": "Image"}, "b": {"type": "Image"}}, "outputs": {"image": {}}, '
        '"nodes": {"mix": {"type": "mix_images", "values": {"factor": 0.0}}}, '
        '"links": {"outputs.image": "mix.out", "mix.a": "inputs.a", "mix.b": "inputs.b"}}'
    )
    return path


def store(path: Path, array: np.ndarray, format: str) -> Path:
    spec = oiio.ImageSpec(array.shape[1], array.shape[0], array.shape[2], format)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(array) and output.close()
    return path


def load(path: Path, format: str = "uint8") -> np.ndarray:
    picture = oiio.ImageInput.open(str(path))
    return picture.read_image(0, 0, 0, 3, format).astype(int)


@pytest.mark.parametrize("ending", ["png", "tif", "jpg", "bmp"])
@pytest.mark.parametrize("target", ["png", "tif"])
def test_a_picture_for_a_screen_comes_back(cli, graph, tmp_path, ending, target):
    source, out = (
        store(tmp_path / f"in.{ending}", CODES, "uint8"),
        tmp_path / f"out.{target}",
    )
    result = cli("render", graph, "-i", f"beauty={source}", "-o", out)
    assert result.code == 0 and "'image' is encoded without a view" in result.err
    assert np.abs(load(out) - load(source)).max() <= 1


def test_sixteen_bits_and_alpha_come_back(cli, graph, tmp_path):
    codes = np.concatenate([CODES, np.full_like(CODES[..., :1], 128)], axis=2).astype(np.uint16) * 257
    source, out = store(tmp_path / "in.png", codes, "uint16"), tmp_path / "out.png"
    assert cli("render", graph, "-i", f"beauty={source}", "-o", out, "--precision", "float").code == 0
    assert np.abs(load(out) - load(source)).max() <= 1


def test_light_of_a_scene_has_the_view_of_the_config(cli, graph, merge, tmp_path):
    light = np.random.default_rng(2).random((SIZE[1], SIZE[0], 3), np.float32) * 2.0
    scene, photo = store(tmp_path / "in.exr", light, "float"), store(tmp_path / "in.png", CODES, "uint8")
    wanted = to_display(light).astype(int)
    for number, words in enumerate(
        [
            (graph, "-i", f"beauty={scene}"),
            (merge, "-i", f"a={scene}", "-i", f"b={photo}"),
        ]
    ):
        out = tmp_path / f"out{number}.png"
        result = cli("render", *words, "-o", out, "--precision", "float")
        assert result.code == 0 and "without a view" not in result.err
        assert np.abs(load(out) - wanted).max() <= 1


def test_who_names_a_view_gets_it(cli, graph, tmp_path):
    source, out = store(tmp_path / "in.png", CODES, "uint8"), tmp_path / "out.png"
    result = cli("render", graph, "-i", f"beauty={source}", "-o", out, "--view", "ACES")
    assert result.code == 0 and "without a view" not in result.err
    assert np.abs(load(out) - CODES).mean() > 10


@pytest.mark.parametrize("space", ["ARRI LogC4", "Linear Rec.709 (sRGB)", "ACEScct", "Rec.2100-PQ - Display"])
def test_spaces_of_scenes_in_integers_are_light(cli, graph, tmp_path, space):
    document = json.loads(graph.read_text())
    document["inputs"]["beauty"]["color_space"] = space
    graph.write_text(json.dumps(document))
    source, out = store(tmp_path / "in.png", CODES, "uint8"), tmp_path / "out.png"
    result = cli("render", graph, "-i", f"beauty={source}", "-o", out, "--json")
    assert result.code == 0 and json.loads(result.out)["views"] == {}


@pytest.mark.parametrize("space", ["sRGB Encoded Rec.709 (sRGB)", "Gamma 2.2 Encoded Rec.709", "sRGB Encoded P3-D65"])
def test_spaces_of_screens_are_only_encoded(cli, graph, tmp_path, space):
    document = json.loads(graph.read_text())
    document["inputs"]["beauty"]["color_space"] = space
    graph.write_text(json.dumps(document))
    source, out = store(tmp_path / "in.png", CODES, "uint8"), tmp_path / "out.png"
    result = cli("render", graph, "-i", f"beauty={source}", "-o", out, "--json")
    assert result.code == 0 and json.loads(result.out)["views"] == {"image": "none"}


def test_each_output_is_judged_by_what_it_reads(cli, tmp_path):
    path = tmp_path / "two.json"
    path.write_text(
        '{"halation": 1, "inputs": {"a": {"type": "Image"}, "b": {"type": "Image"}}, '
        '"outputs": {"left": {}, "right": {}}, "links": {"outputs.left": "inputs.a", "outputs.right": "inputs.b"}}'
    )
    scene = store(tmp_path / "in.exr", np.full((48, 64, 3), 0.5, np.float32), "float")
    photo = store(tmp_path / "in.png", CODES, "uint8")
    left, right = tmp_path / "left.png", tmp_path / "right.png"
    words = ("-i", f"a={photo}", "-i", f"b={scene}", "-o", f"left={left}", "-o", f"right={right}", "--json")
    result = cli("render", path, *words)
    assert result.code == 0 and json.loads(result.out)["views"] == {"left": "none"}
    assert np.abs(load(left) - CODES).max() <= 1
    assert np.abs(load(right) - to_display(np.full((1, 1, 3), 0.5, np.float32)).astype(int)).max() <= 1


def test_data_and_formats_of_light_have_no_view(cli, graph, tmp_path):
    source, matte = store(tmp_path / "in.png", CODES, "uint8"), tmp_path / "matte.json"
    matte.write_text(
        '{"halation": 1, "inputs": {"beauty": {"type": "Image"}}, "outputs": {"image": {"type": "Field"}}, '
        '"nodes": {"luma": {"type": "luminance"}}, '
        '"links": {"outputs.image": "luma.out", "luma.image": "inputs.beauty"}}'
    )
    for path, name in ((matte, "matte.png"), (graph, "light.hdr")):
        result = cli("render", path, "-i", f"beauty={source}", "-o", tmp_path / name, "--json")
        assert result.code == 0 and json.loads(result.out)["views"] == {}


def test_a_video_comes_back(cli, graph, tmp_path):
    source, out = tmp_path / "in.mov", tmp_path / "out.png"
    with av.open(str(source), "w") as container:
        stream = container.add_stream("png", rate=24)
        stream.width, stream.height, stream.pix_fmt = *SIZE, "rgb24"
        container.mux(stream.encode(av.VideoFrame.from_ndarray(CODES, format="rgb24")))
        container.mux(stream.encode(None))
    result = cli("render", graph, "-i", f"beauty={source}", "-o", out, "--frame", "1")
    assert result.code == 0 and "without a view" in result.err
    assert np.abs(load(out) - CODES).max() <= 1


def test_explain_says_the_view_and_why(cli, graph, tmp_path):
    photo = store(tmp_path / "in.png", CODES, "uint8")
    scene = store(tmp_path / "in.exr", np.ones((48, 64, 3), np.float32), "float")
    assert "view: none, since its pictures are made for a screen" in cli("explain", graph, "-i", f"beauty={photo}").out
    assert "view: that of the config" in cli("explain", graph, "-i", f"beauty={scene}").out
