"""Graphs in another working space: what is linear shows the same picture, what weighs channels weighs those there."""

from __future__ import annotations

import json

import halation as hal
import numpy as np
import pytest
from halation import document
from halation.color.encoding import Encoding
from halation.color.management import get_color_manager
from halation.media import read_layer, write_picture
from halation.nodes import ColorSettings, Kind
from halation.resources.sandbox import UNRESTRICTED
from house_config import AP1_LUMINANCE, AP1_TO_REC709, studio, through


@pytest.fixture(scope="module")
def shot(tmp_path_factory):
    """A PNG of all kinds of colors, and an EXR that says it is ACEScg."""
    folder = tmp_path_factory.mktemp("shot")
    random = np.random.default_rng(2)
    codes = random.random((48, 64, 3)).astype(np.float32)
    write_picture(
        folder / "a.png", {"": codes}, kinds={"": Kind.IMAGE}, view="none", precision="float", sandbox=UNRESTRICTED
    )
    wide = np.exp2(random.uniform(-8.0, 4.0, (48, 64, 3))).astype(np.float32)
    encoding = Encoding(manager=get_color_manager(ColorSettings("", "ACEScg"), UNRESTRICTED))
    write_picture(
        folder / "b.exr", {"": wide}, kinds={"": Kind.IMAGE}, precision="float", encoding=encoding, sandbox=UNRESTRICTED
    )
    return folder


def rendered(folder, working, nodes, links, file="a.png", **values):
    tree = {
        "halation": 1,
        "settings": {"color": {"working": working}} if working else {},
        "inputs": {"a": {"type": "Image", "file": file}},
        "outputs": {"o": {"type": "Image"}},
        "nodes": nodes,
        "links": links,
    }
    graph = document.loads(json.dumps(tree), folder=str(folder), sandbox=UNRESTRICTED)
    return hal.render(graph, precision="float", values=values)["o"][..., :3]


def one(type, **values):
    return {"n": {"type": type, "values": values}}, {"n.image": "inputs.a", "outputs.o": "n.out"}


LINEAR = [
    ("exposure", {"stops": 1.5}),
    ("gaussian_blur", {"sigma": 4.0}),
    ("white_balance", {"temperature": 3200.0, "tint": 12.0}),
    ("white_balance", {"temperature": 9000.0, "method": "cat16"}),
    ("transform", {"angle": 20.0}),
    ("hue_saturation", {"mode": "perceptual", "hue": 40.0, "saturation": 0.6}),
    ("color_space", {"source": "working", "target": "linear p3"}),
]


@pytest.mark.parametrize("file", ["a.png", "b.exr"])
@pytest.mark.parametrize(("type", "values"), LINEAR, ids=lambda item: item if isinstance(item, str) else "")
def test_the_same_picture(shot, file, type, values):
    plain = rendered(shot, "", *one(type, **values), file=file)
    wide = rendered(shot, "ACEScg", *one(type, **values), file=file)
    if type == "color_space":  # both are linear P3 now
        np.testing.assert_allclose(wide, plain, rtol=1e-4, atol=1e-4)
        return
    np.testing.assert_allclose(wide @ AP1_TO_REC709.T, plain, rtol=1e-4, atol=2e-4)
    assert np.abs(wide - plain).max() > 0.01


@pytest.mark.parametrize("operator", ["agx", "aces"])
def test_a_picture_for_rec709_is_for_rec709(shot, operator):
    """What a tone map makes is the same light, whatever the space it is expressed in."""
    plain = rendered(shot, "", *one("tone_map", operator=operator))
    wide = rendered(shot, "ACEScg", *one("tone_map", operator=operator, clip=False))
    np.testing.assert_allclose((wide @ AP1_TO_REC709.T).clip(0.0, 1.0), plain, atol=1e-3)


def test_luminance_is_that_of_the_primaries(shot):
    wide = read_layer(
        shot / "b.exr",
        "",
        Kind.IMAGE,
        manager=get_color_manager(ColorSettings("", "ACEScg"), UNRESTRICTED),
        sandbox=UNRESTRICTED,
    ).array[..., :3]
    gray = rendered(shot, "ACEScg", *one("saturation", saturation=0.0), file="b.exr")
    np.testing.assert_allclose(gray, (wide @ np.array(AP1_LUMINANCE))[..., None].repeat(3, 2), rtol=1e-5)
    plain = read_layer(shot / "b.exr", "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., :3]
    gray = rendered(shot, "", *one("saturation", saturation=0.0), file="b.exr")
    np.testing.assert_allclose(gray[..., 0], plain @ np.array((0.2126, 0.7152, 0.0722)), rtol=1e-4, atol=1e-5)


def test_the_house_names_its_own_spaces(tmp_path, house, reference):
    random = np.random.default_rng(4).random((16, 16, 3)).astype(np.float32)
    write_picture(
        tmp_path / "a.exr",
        {"": random},
        kinds={"": Kind.IMAGE},
        precision="float",
        encoding=Encoding(manager=get_color_manager(ColorSettings(str(house), "scene_linear"), UNRESTRICTED)),
        sandbox=UNRESTRICTED,
    )
    tree = {
        "halation": 1,
        "settings": {"color": {"config": "house.ocio", "working": "scene_linear"}},
        "inputs": {"a": {"type": "Image", "file": "a.exr"}},
        "outputs": {"o": {"type": "Image"}},
        "nodes": {"n": {"type": "color_space", "values": {"target_name": "color_timing"}}},
        "links": {"n.image": "inputs.a", "outputs.o": "n.out"},
    }
    made = hal.render(document.loads(json.dumps(tree), folder=str(tmp_path), sandbox=UNRESTRICTED), precision="float")[
        "o"
    ][..., :3]
    np.testing.assert_allclose(made, through(reference, random, "house linear", "house log"), atol=2e-5)
    tree["nodes"]["n"]["values"]["target_name"] = "color_timng"
    with pytest.raises(hal.HalationError, match="no color space is called 'color_timng': did you mean 'color_timing'"):
        hal.render(document.loads(json.dumps(tree), folder=str(tmp_path), sandbox=UNRESTRICTED))


def test_a_group_works_in_the_space_of_its_graph(shot, tmp_path):
    inner = {
        "halation": 1,
        "settings": {"color": {"working": "ACES2065-1"}},
        "inputs": {"a": {"type": "Image"}},
        "outputs": {"o": {"type": "Image"}},
        "nodes": {"s": {"type": "saturation", "values": {"saturation": 0.0}}},
        "links": {"s.image": "inputs.a", "outputs.o": "s.out"},
    }
    (tmp_path / "inner.json").write_text(json.dumps(inner))
    tree = {
        "halation": 1,
        "settings": {"color": {"working": "ACEScg"}},
        "inputs": {"a": {"type": "Image", "file": str(shot / "b.exr")}},
        "outputs": {"o": {"type": "Image"}},
        "nodes": {"g": {"type": "group", "path": "inner.json"}},
        "links": {"g.a": "inputs.a", "outputs.o": "g.o"},
    }
    (tmp_path / "outer.json").write_text(json.dumps(tree))
    made = hal.render(hal.load(tmp_path / "outer.json"), precision="float")["o"][..., :3]
    np.testing.assert_allclose(made, rendered(shot, "ACEScg", *one("saturation", saturation=0.0), file="b.exr"))


def test_the_matrices_are_those_of_the_studio_config(light):
    np.testing.assert_allclose(
        through(studio(), light, "ACEScg", "lin_rec709_scene"), light @ AP1_TO_REC709.T, rtol=2e-5, atol=2e-5
    )
