"""Color on the command line: flags, configs, and sentences about what there is not."""

from __future__ import annotations

import json

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import header, read
from halation.color.management import get_color_manager
from halation.media import read_layer as read_pixels
from halation.nodes import ColorSettings, Kind
from halation.resources.sandbox import UNRESTRICTED
from house_config import AP1_TO_REC709, HOUSE, write_house


@pytest.fixture(autouse=True)
def no_environment(monkeypatch):
    monkeypatch.delenv("OCIO", raising=False)


@pytest.fixture
def house(tmp_path):
    return write_house(tmp_path)


def wide(graphs, name="wide.json", **color):
    return graphs(name, settings={"color": color or {"working": "ACEScg"}})


def test_rendering_into_a_space(cli, graphs, tmp_path):
    plain, log, dpx = (tmp_path / name for name in ("plain.exr", "log.exr", "log.dpx"))
    assert cli("render", graphs(), "-o", plain, "--precision", "float").code == 0
    assert cli("render", graphs(), "-o", log, "--colorspace", "ARRI LogC4", "--precision", "float").code == 0
    assert cli("render", graphs(), "-o", dpx, "--colorspace", "arri logc4").code == 0
    assert header(log).get_string_attribute("colorInteropID") == "ocio:arrilogc4_awg4_scene"
    back = read_pixels(log, "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(back, read(plain), atol=1e-4)
    assert np.abs(read(log) - read(plain)).max() > 0.1
    assert header(dpx).get_int_attribute("oiio:BitsPerSample") == 10
    np.testing.assert_allclose(read(dpx), read(log)[..., :3], atol=2e-3)
    assert '"colorspace": "ARRI LogC4"' in header(log).get_string_attribute("halation:job")


def test_a_graph_in_acescg_shows_the_same_picture(cli, graphs, tmp_path):
    plain, other = tmp_path / "a.png", tmp_path / "b.png"
    assert cli("render", graphs(), "-o", plain, "--view", "none", "-i", "beauty=" + str(tagged(tmp_path))).code == 0
    assert cli("render", wide(graphs), "-o", other, "--view", "none", "-i", f"beauty={tagged(tmp_path)}").code == 0
    assert np.abs(read(plain) - read(other)).max() <= 1.01 / 255
    exr = tmp_path / "c.exr"
    assert cli("render", wide(graphs), "-o", exr, "-i", f"beauty={tagged(tmp_path)}", "--precision", "float").code == 0
    assert header(exr).get_string_attribute("colorInteropID") == "lin_ap1_scene"
    pixels = read(tagged(tmp_path))[..., :3]
    np.testing.assert_allclose(read(exr)[..., :3] @ AP1_TO_REC709.T, 2.0 * pixels, rtol=1e-4, atol=1e-5)


def tagged(folder):
    """An EXR that says that it is linear Rec.709."""
    path = folder / "tagged.exr"
    if not path.exists():
        spec = oiio.ImageSpec(16, 12, 3, "float")
        spec.attribute("oiio:ColorSpace", "lin_rec709_scene")
        made = oiio.ImageOutput.create(str(path))
        assert made.open(str(path), spec)
        made.write_image(np.random.default_rng(1).random((12, 16, 3)).astype(np.float32) * 0.4)
        made.close()
    return path


def test_views_displays_and_looks_of_a_house(cli, graphs, tmp_path, house):
    graph = wide(graphs, config="house.ocio", working="scene_linear")
    found = {}
    for name, flags in {
        "plain": (),
        "warm": ("--view", "warm"),
        "same": ("--view", "Plain", "--look", "warm"),
        "dim": ("--display", "Projector"),
        "cold": ("--view", "warm", "--look", "none"),
    }.items():
        path = tmp_path / f"{name}.png"
        result = cli("render", graph, "-o", path, *flags)
        assert result.code == 0, result
        found[name] = read(path)
    np.testing.assert_array_equal(found["warm"], found["same"])
    np.testing.assert_array_equal(found["plain"], found["cold"])
    assert np.abs(found["warm"] - found["plain"]).max() > 0.02 and np.abs(found["dim"] - found["plain"]).max() > 0.02


def test_the_view_of_an_output_comes_from_the_config(cli, graphs, tmp_path, house):
    graph = graphs(settings={"color": {"config": "house.ocio"}}, outputs={"image": {"type": "Image", "view": "Warm"}})
    other = tmp_path / "b.png"
    assert cli("render", graph, "-o", tmp_path / "a.png").code == 0
    assert cli("render", graph, "-o", other, "--view", "warm").code == 0
    np.testing.assert_array_equal(read(tmp_path / "a.png"), read(other))
    assert cli("check", graph).code == 0


def test_processes_get_the_same_flags(cli, graphs, tmp_path):
    graph = graphs(settings={"frames": [1, 2]})
    said = cli("render", graph, "-o", tmp_path / "a.##.exr", "--colorspace", "ACEScg", "-j", "2")
    assert said.code == 0, said
    for frame in ("01", "02"):
        assert header(tmp_path / f"a.{frame}.exr").get_string_attribute("colorInteropID") == "lin_ap1_scene"


def test_resuming_sees_a_config_that_changed(cli, graphs, tmp_path, house):
    graph, out = graphs(settings={"color": {"config": "house.ocio"}}), tmp_path / "a.png"
    kept = [cli("render", graph, "-o", out, "--resume", "--json").json["kept"] for _ in range(2)]
    house.write_text(HOUSE.replace("offset: 0.055", "offset: 0.06"))
    kept.append(cli("render", graph, "-o", out, "--resume", "--json").json["kept"])
    house.write_text(HOUSE.replace("offset: 0.055", "offset: 0.06"))
    house.touch()
    kept.append(cli("render", graph, "-o", out, "--resume", "--json").json["kept"])
    assert kept == [[], [1], [], [1]]


@pytest.mark.parametrize(
    ("color", "said"),
    [
        ({"config": "hause.ocio"}, "hause.ocio: there is no such color config; did you mean 'house.ocio'?"),
        ({"working": "ACESgc"}, "settings.color.working: 'ACESgc' is unknown: did you mean 'ACEScg'?"),
        ({"config": "ocio://nothing"}, "settings.color.config: ocio://nothing: there is no such built-in config"),
    ],
)
def test_a_graph_at_fault(cli, fails, graphs, house, color, said):
    graph = wide(graphs, **color)
    checked = cli("check", graph)
    assert checked.code == 3 and said in checked.out and "Traceback" not in checked.err
    assert said in fails(3, "render", graph, out="out.png")


def test_an_environment_at_fault(cli, fails, graphs, monkeypatch, tmp_path):
    monkeypatch.setenv("OCIO", str(tmp_path / "gone.ocio"))
    assert fails(2, "render", graphs(), out="a.png").startswith(f"$OCIO: {tmp_path}/gone.ocio: there is no such")
    checked = cli("check", graphs())
    assert checked.code == 2 and "$OCIO" in checked.out
    shown = cli("info", tagged(tmp_path))
    assert shown.code == 0 and "$OCIO" in shown.out
    assert cli("render", graphs(settings={"color": {"config": "ocio://default"}}), "-o", tmp_path / "b.png").code == 0
    assert cli("nodes", "color_space").code == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--colorspace", "ARRI LogC5"), "there is no color space 'ARRI LogC5': did you mean 'ARRI LogC4'"),
        (("--look", "x"), "there is no look 'x'"),
        (("--display", "x"), "there is no display 'x'"),
        (("--view", "none", "--colorspace", "ACEScg"), "give one of them"),
    ],
)
def test_flags_that_make_no_sense(fails, graphs, words, said):
    assert said in fails(2, "render", graphs(), *words)


def test_names_in_a_graph_that_nobody_knows(cli, graphs):
    inputs = {"beauty": {"type": "Image", "file": "shot.exr", "layer": "Combined", "color_space": "ACESgc"}}
    checked = cli("check", graphs(inputs=inputs))
    assert checked.code == 3 and "input 'beauty': color_space 'ACESgc' is unknown: did you mean 'ACEScg'" in checked.out
    viewed = cli("check", graphs(outputs={"image": {"type": "Image", "view": "Untonemapped"}}))
    assert viewed.code == 2 and "output 'image': there is no view 'Untonemapped'" in viewed.out
    node = graphs(nodes={"light": {"type": "color_space", "version": 1, "values": {"target_name": "nope"}}})
    assert cli("check", node).code == 2


def test_info_says_the_color_space_and_why(cli, tmp_path, shot, house, monkeypatch):
    assert "lin_rec709_scene  the working space, for nothing says otherwise" in cli("info", shot).out
    assert "lin_rec709_scene  its header says so" in cli("info", tagged(tmp_path)).out
    monkeypatch.setenv("OCIO", str(house))
    plates = tmp_path / "plates_a.exr"
    plates.write_bytes(shot.read_bytes())
    assert "house log  the file rule 'plates'" in cli("info", plates).out
    spaces = cli("info", plates, "--json").json["color_spaces"]
    assert spaces == [["house log", "the file rule 'plates'"]]


def test_an_input_in_another_space_by_flag(cli, graphs, tmp_path, shot):
    inputs = {"beauty": {"type": "Image", "file": "shot.exr", "layer": "Combined", "color_space": "ACEScg"}}
    out = tmp_path / "a.exr"
    assert cli("render", graphs(inputs=inputs), "-o", out, "--precision", "float").code == 0
    expected = read_pixels(shot, "Combined", Kind.IMAGE, space="ACEScg", sandbox=UNRESTRICTED).array[..., :3] * 2.0
    np.testing.assert_allclose(read(out)[..., :3], expected, rtol=1e-5, atol=1e-6)
    same = read_pixels(
        shot,
        "Combined",
        Kind.IMAGE,
        manager=get_color_manager(ColorSettings("", "ACEScg"), UNRESTRICTED),
        sandbox=UNRESTRICTED,
    ).array
    np.testing.assert_allclose(expected, 2.0 * same[..., :3] @ AP1_TO_REC709.T, rtol=1e-4, atol=1e-4)
    assert json.loads(graphs(inputs=inputs).read_text())["inputs"]["beauty"]["color_space"] == "ACEScg"
