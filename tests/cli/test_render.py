"""Every flag of `halation render` does what it says, in pixels."""

from __future__ import annotations

import hashlib
import json
import re

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import header, read
from halation.resources.sandbox import UNRESTRICTED

RED = np.linspace(0.0, 1.0, 48, dtype=np.float32).astype(np.float16).astype(np.float32)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out.exr"


DEPTH = {
    "inputs": {"depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"}},
    "outputs": {"image": {"type": "Image"}, "far": {"type": "Field"}},
    "links": {"outputs.far": "inputs.depth"},
}


def test_a_graph_becomes_a_picture_and_the_device_is_named_once(cli, graphs, out):
    result = cli("render", graphs(), "-o", out)
    assert (result.code, result.out) == (0, "")
    np.testing.assert_allclose(read(out)[7, :, 0], 2.0 * RED, rtol=1e-3)
    np.testing.assert_allclose(read(out)[0, 0], (0.0, 0.5, 1.0, 1.0))
    renderer = header(out)["halation:renderer"]
    assert result.err.count(renderer) == 1
    told = rf"{re.escape(str(out))}  \d+\.\d\d s, 1 pass, .* of textures at the peak"
    assert re.fullmatch(told, result.err.splitlines()[1])


def test_input_with_a_name_a_layer_or_neither(cli, graphs, shot, out, tmp_path):
    blue = []
    for text in (f"beauty={shot}:Cool", f"beauty={shot}", shot, f"{shot}:Cool"):
        assert cli("render", graphs(), "-i", text, "-o", out).code == 0
        blue.append(float(read(out)[0, 0, 2]))
    assert blue == [4.0, 1.0, 1.0, 4.0]
    assert "shot.exr:Cool sha256:" in header(out)["halation:input:inputs.beauty"]


def test_input_as_another_file(cli, graphs, out, tmp_path):
    flat = oiio.ImageBuf(np.full((6, 9, 3), 0.125, np.float32))
    assert flat.write(str(tmp_path / "flat.exr"))
    assert cli("render", graphs(), "--input", f"beauty={tmp_path / 'flat.exr'}", "-o", out).code == 0
    assert read(out).shape == (6, 9, 4) and read(out)[3, 3].tolist() == [0.25, 0.25, 0.25, 1.0]


def test_several_files_in_one_go(cli, graphs, out, tmp_path):
    files = [out, tmp_path / "out.png", tmp_path / "out.jpg", tmp_path / "second.exr"]
    result = cli("render", graphs(), *(word for file in files for word in ("-o", file)))
    assert result.code == 0 and all(file.stat().st_size > 500 for file in files)
    np.testing.assert_array_equal(read(out), read(files[3]))


def test_an_exr_holds_all_outputs_as_layers(cli, graphs, out):
    assert cli("render", graphs(**DEPTH), "-o", out).code == 0
    assert header(out, 0).channelnames == ("image.R", "image.G", "image.B", "image.A")
    assert str(header(out, 0).format) == "half" and str(header(out, 1).format) == "float"
    assert read(out, 1)[..., 0].tolist() == [[row + 1.0] * 48 for row in range(32)]


def test_outputs_by_name(cli, graphs, out, tmp_path):
    far, both = tmp_path / "far.exr", tmp_path / "both.exr"
    words = ("-o", f"far={far}", "-o", f"image={tmp_path / 'image.png'}", "-o", f"far={both}", "-o", f"image={both}")
    assert cli("render", graphs(**DEPTH), *words).code == 0
    assert header(far).channelnames == ("Y",) and read(far)[31, 0] == 32.0
    assert header(both, 0).channelnames == ("far.Y",) and header(both, 1).channelnames[0] == "image.R"
    assert header(tmp_path / "image.png").nchannels == 3


def test_an_output_says_its_layer(cli, graphs, out):
    parts = {**DEPTH, "outputs": {"image": {"layer": "beauty"}, "far": {"type": "Field", "layer": "Depth"}}}
    assert cli("render", graphs(**parts), "-o", out).code == 0
    assert header(out, 0).channelnames[0] == "beauty.R" and header(out, 1).channelnames == ("Depth.Z",)


@pytest.mark.parametrize(
    ("text", "factor"), [("light.stops=2", 4.0), ("light.stops=-1.5e0", 2.0**-1.5), ("glow=3", 8.0)]
)
def test_set_a_number_or_a_control(cli, graphs, out, text, factor):
    path = graphs(controls={"glow": {"target": "light.stops"}})
    assert cli("render", path, "--set", text, "-o", out).code == 0
    np.testing.assert_allclose(read(out)[0, :, 0], factor * RED, rtol=2e-3)


def test_set_a_color(cli, graphs, out):
    path = graphs(nodes={"fill": {"type": "constant"}}, links={"light.image": "fill.out"})
    for text in ("0.5,0.25,0.125,1", "[0.5, 0.25, 0.125, 1.0]"):
        assert cli("render", path, "--set", f"fill.color={text}", "-o", out).code == 0
        assert read(out)[0, 0].tolist() == [1.0, 0.5, 0.25, 1.0]


def test_set_a_choice_and_a_boolean(cli, graphs, out):
    path = graphs(
        nodes={"tone": {"type": "tone_map", "values": {"exposure": 6.0}}},
        links={"tone.image": "light.out", "outputs.image": "tone.out"},
    )
    seen = []
    choice = ("--set", "tone.operator=reinhard")
    for words in ((), choice, (*choice, "--set", "tone.clip=false")):
        assert cli("render", path, *words, "-o", out).code == 0
        seen.append(read(out))
    assert not np.allclose(seen[0], seen[1], atol=0.01)
    assert seen[1].max() == 1.0 < seen[2].max()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("lihgt.stops=1", "--set lihgt.stops=1: there is no node 'lihgt'; did you mean 'light'?"),
        ("light.stosp=1", "--set light.stosp=1: node 'light' has no value 'stosp'; did you mean 'stops'?"),
        ("light.stops=red", "--set light.stops=red: 'red' does not fit: it takes a number"),
        ("light.stops=1,2", "--set light.stops=1,2: [1, 2] does not fit: it takes a number"),
        ("light.stops=NaN", "--set: NaN is not a valid value; write a finite number"),
        ("light.stops=1e999", "--set light.stops=1e999: inf is not a finite number"),
        ("merge.amount=1.5", "--set merge.amount=1.5: 1.5 is outside the range 0 to 1"),
        ("merge.mode=ovr", "--set merge.mode=ovr: 'ovr' is not a choice"),
        ("tone.clip=1", "--set tone.clip=1: 1 does not fit: it takes true or false"),
        ("gloww=1", "--set gloww=1: the graph has no control 'gloww'; did you mean 'glow'?"),
        ("light.stops", "--set light.stops: write --set NAME=VALUE"),
        ("light.a.b=1", "--set light.a.b=1: 'light.a.b' looks inside 'light', which is not a group"),
    ],
)
def test_set_refuses_what_makes_no_sense(cli, graphs, out, text, sentence):
    nodes = {"merge": {"type": "merge"}, "tone": {"type": "tone_map"}}
    path = graphs(nodes=nodes, controls={"glow": {"target": "light.stops"}})
    result = cli("render", path, "--set", text, "-o", out)
    assert (result.code, result.out, out.exists()) == (2, "", False)
    assert result.err.startswith(f"halation: {sentence}") and result.err.count("\n") == 1


def test_set_twice_is_refused(cli, graphs, out):
    result = cli("render", graphs(), "--set", "light.stops=1", "--set", "light.stops=2", "-o", out)
    assert result.code == 2 and "'light.stops' is given twice" in result.err


def test_node_renders_a_node_or_one_of_its_outputs(cli, graphs, out):
    nodes = {"split": {"type": "separate"}, "fill": {"type": "constant"}}
    path = graphs(nodes=nodes, links={"split.image": "light.out"})
    assert cli("render", path, "--node", "fill", "-o", out).code == 0
    np.testing.assert_allclose(read(out)[0, 0], (0.18, 0.18, 0.18, 1.0), rtol=1e-3)
    assert cli("render", path, "--node", "split.blue", "-o", out).code == 0
    assert read(out).tolist() == [[[1.0]] * 48] * 32
    for wrong, sentence in (("lihgt", "did you mean 'light'?"), ("split.q", "node 'split' has no output 'q'")):
        result = cli("render", path, "--node", wrong, "-o", out)
        assert result.code == 2 and sentence in result.err


def test_size(cli, graphs, out):
    assert cli("render", graphs(), "--size", "20x10", "-o", out).code == 0
    assert read(out).shape == (10, 20, 4)
    for wrong in ("20", "0x10", "axb", "-3x4", "3x4x5", "1" * 5000 + "x1"):
        result = cli("render", graphs(), f"--size={wrong}", "-o", out)
        assert result.code == 2 and "write WIDTHxHEIGHT" in result.err


def test_scale_shrinks_lengths_in_pixels_too(cli, graphs, out, tmp_path):
    path = graphs(
        nodes={"tiles": {"type": "checker", "values": {"size": 8.0}}},
        links={"outputs.image": "tiles.out"},
        settings={"size": [64, 32]},
    )
    small = tmp_path / "small.exr"
    assert cli("render", path, "-o", out).code == 0
    assert cli("render", path, "--scale", "0.5", "-o", small).code == 0
    np.testing.assert_array_equal(read(small), read(out)[::2, ::2])
    for wrong in ("0", "1.5", "nan", "-1"):
        result = cli("render", path, f"--scale={wrong}", "-o", out)
        assert result.code == 2 and "above 0 and up to 1" in result.err


def test_frame_reaches_the_shaders(cli, graphs, out, monkeypatch):
    from halation import compiler
    from halation.compiler.library import parse

    code = "vec4 exposure(vec4 image, float stops) { return vec4(vec3(float(frame)), stops); }\n"
    library = compiler.Library({**compiler.load_library().texts, "color/exposure": parse("color/exposure", code)})
    monkeypatch.setattr(compiler.planner, "load_library", lambda: library)
    for words, expected in (((), 1.0), (("--frame", "37"), 37.0)):
        assert cli("render", graphs(), *words, "-o", out).code == 0
        assert read(out)[3, 3, 0] == expected
    assert '"frame": 37' in header(out)["halation:job"]


def test_precision_of_files_and_of_what_lies_between(cli, graphs, out):
    """1 + 2^-12 is lost in half: in the file by default, and between two passes when half is asked for."""
    nodes = {
        "blur": {"type": "gaussian_blur", "values": {"sigma": 1.0}},
        "minus": {"type": "grade", "values": {"offset": [-1.0, -1.0, -1.0, 0.0]}},
    }
    value = 1.0 + 2.0**-12
    path = graphs(
        nodes={**nodes, "fill": {"type": "constant", "values": {"color": [value] * 3 + [1.0]}}},
        links={"blur.image": "fill.out", "minus.image": "blur.out", "outputs.image": "minus.out"},
    )
    found = {}
    for precision in ("half", "float"):
        assert cli("render", path, "--precision", precision, "-o", out).code == 0
        assert str(header(out).format) == precision
        found[precision] = float(read(out)[5, 5, 0])
    assert abs(found["float"] - 2.0**-12) < 1e-6 and abs(found["half"] - 2.0**-12) > 1e-4
    result = cli("render", path, "--precision", "double", "-o", out)
    assert result.code == 2 and "--precision double: choose half or float" in result.err


def test_view(cli, graphs, tmp_path):
    pictures = {}
    for view in ("none", "", "ACES 2.0 - SDR 100 nits (Rec.709)"):
        file = tmp_path / "view.png"
        assert (
            cli("render", graphs(), "--set", "light.stops=0", "--view", view, "--dither", "none", "-o", file).code == 0
        )
        pictures[view] = read(file)
    srgb = 1.055 * RED ** (1.0 / 2.4) - 0.055
    np.testing.assert_allclose(pictures["none"][4, 8:, 0], srgb[8:], atol=0.003)
    assert np.abs(pictures[""] - pictures["none"]).max() > 0.02
    np.testing.assert_array_equal(pictures[""], pictures["ACES 2.0 - SDR 100 nits (Rec.709)"])


def test_an_output_may_ask_for_its_view(cli, graphs, tmp_path):
    plain, asked = tmp_path / "plain.png", tmp_path / "asked.png"
    assert cli("render", graphs(), "--view", "none", "-o", plain).code == 0
    assert cli("render", graphs(outputs={"image": {"type": "Image", "view": "none"}}), "-o", asked).code == 0
    np.testing.assert_array_equal(read(plain), read(asked))


@pytest.mark.parametrize("compression", ["none", "rle", "zip", "piz", "dwaa"])
def test_compression(cli, graphs, out, compression):
    assert cli("render", graphs(), "--compression", compression, "-o", out).code == 0
    assert header(out).get_string_attribute("compression").split(":")[0] == compression


def test_form_of_passes(cli, graphs, out, tmp_path):
    other = tmp_path / "other.exr"
    path = graphs(
        nodes={"blur": {"type": "gaussian_blur", "values": {"sigma": 3.0}}},
        links={"blur.image": "light.out", "outputs.image": "blur.out"},
    )
    for form, file in (("fragment", out), ("compute", other)):
        result = cli("render", path, "--form", form, "--precision", "float", "-o", file)
        assert result.code == 0 and f"{form} passes" in result.err
    np.testing.assert_allclose(read(out), read(other), atol=1e-5)
    assert "--form geometry: choose fragment or compute" in cli("render", path, "--form", "geometry", "-o", out).err


def test_json_is_one_object_and_the_device_still_shows(cli, graphs, out):
    result = cli("render", graphs(), "-o", out, "--json")
    assert result.code == 0 and result.json["written"] == [str(out)] and result.json["passes"] == 1
    assert result.json["device"] == result.err.strip()
    assert set(result.json["seconds"]) == {"load", "open", "compile", "render", "write", "total"}
    assert result.json["peak_bytes"] >= 2 * 48 * 32 * 4 * 2


def test_broken_pixels_are_repaired_and_told(cli, graphs, out, tmp_path):
    pixels = np.full((8, 8, 4), 0.5, np.float32)
    pixels[3, 4] = np.nan
    file = tmp_path / "broken.exr"
    assert oiio.ImageBuf(pixels).write(str(file))
    result = cli("render", graphs(), "-i", f"beauty={file}", "-o", out)
    assert result.code == 0 and f"{file}: 1 pixels that are not finite" in result.err
    assert read(out)[3, 4].tolist() == [1.0, 1.0, 1.0, 0.5]


@pytest.mark.parametrize("ending", [".exr", ".png"])
def test_a_picture_says_how_to_make_it_again(cli, graphs, shot, tmp_path, ending):
    from halation import document

    file = tmp_path / f"out{ending}"
    result = cli("render", graphs(), "--set", "light.stops=2.5", "--scale", "0.5", "-o", file)
    assert result.code == 0
    spec = header(file)
    graph = document.loads(spec["halation:graph"], sandbox=UNRESTRICTED)
    assert graph.nodes["light"].stops == 2.5 and list(graph.inputs) == ["beauty"]
    assert spec["halation:renderer"] and spec["halation:renderer"] in result.err
    assert spec["halation:version"] == cli("--version").out.split()[1]
    assert json.loads(spec["halation:job"])["scale"] == 0.5
    digest = hashlib.sha256(shot.read_bytes()).hexdigest()
    assert spec["halation:input:inputs.beauty"] == f"shot.exr:Combined sha256:{digest}"
    assert spec["Camera"] == "Lens 50"


def test_a_file_that_is_read_twice_is_hashed_once(cli, graphs, out, monkeypatch):
    from halation.renderer.jobs import source_files as sources

    seen = []
    real = sources.content_hash
    monkeypatch.setattr(sources, "content_hash", lambda path, sandbox: seen.append(path) or real(path, sandbox))
    assert cli("render", graphs(**DEPTH), "-o", out).code == 0
    assert len(seen) == 1
    said = [header(out)[f"halation:input:inputs.{name}"].split()[1] for name in ("beauty", "depth")]
    assert said[0] == said[1]


def test_a_written_exr_can_be_rendered_again(cli, graphs, out, tmp_path):
    again, third = tmp_path / "again.json", tmp_path / "third.exr"
    assert cli("render", graphs(), "--set", "light.stops=-2", "-o", out).code == 0
    again.write_text(header(out)["halation:graph"])
    assert cli("render", again, "-o", third).code == 0
    np.testing.assert_array_equal(read(out), read(third))
    assert json.loads(again.read_text())["nodes"]["light"]["values"] == {"stops": -2.0}


def test_the_header_holds_the_bodies_of_groups_as_they_were(cli, graphs, out, tmp_path):
    """The file of a group may change, and --set reaches into it: a reference would not say what was rendered."""
    body = {
        "halation": 1,
        "inputs": {"image": {"type": "Image"}},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"more": {"type": "exposure"}},
        "links": {"more.image": "inputs.image", "outputs.image": "more.out"},
    }
    (tmp_path / "body.json").write_text(json.dumps(body))
    path = graphs(
        nodes={"group": {"type": "group", "path": "body.json"}},
        links={"group.image": "light.out", "outputs.image": "group.image"},
    )
    assert cli("render", path, "--set", "group.more.stops=2", "-o", out).code == 0
    np.testing.assert_allclose(read(out)[0, :, 0], 8.0 * RED, rtol=2e-3)
    again, third = tmp_path / "again.json", tmp_path / "third.exr"
    again.write_text(header(out)["halation:graph"])
    (tmp_path / "body.json").unlink()
    assert cli("render", again, "-o", third).code == 0
    np.testing.assert_array_equal(read(out), read(third))
