"""What a file is in, by which rule, and that its numbers become those of OpenColorIO's CPU path."""

from __future__ import annotations

import json
import os
from pathlib import Path

import halation as hal
import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import write_exr
from halation import document
from halation.color.gpu_programs import write_color_change
from halation.color.management import get_color_manager
from halation.errors import GraphError, InputError
from halation.media import read_layer
from halation.media.color_spaces import find_layer_spaces
from halation.nodes import ColorSettings, Kind, LookupFile
from halation.resources.sandbox import UNRESTRICTED
from house_config import AP1_TO_REC709, studio, through

Array = np.ndarray
REC709 = ColorSettings()
ACESCG = ColorSettings("", "ACEScg")
CHROMATICITIES = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)


def made(path: Path, array: Array, format: str = "float", **attributes: object) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    spec = oiio.ImageSpec(array.shape[1], array.shape[0], array.shape[2], format)
    for name, value in attributes.items():
        if isinstance(value, tuple):
            spec.attribute(name, oiio.TypeDesc(f"float[{len(value)}]"), value)
        else:
            spec.attribute(name.replace("__", ":"), value)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(np.ascontiguousarray(array)) and output.close()
    return path


def codes() -> Array:
    return np.random.default_rng(3).integers(0, 256, (6, 9, 3), np.uint8)


def rgb(path: Path, color: ColorSettings, space: str = "") -> Array:
    return read_layer(
        path, "", Kind.IMAGE, space=space, manager=get_color_manager(color, UNRESTRICTED), sandbox=UNRESTRICTED
    ).array[..., :3]


RULES = [
    ("plates/shot.exr", "house log", "the file rule 'plates'"),
    ("shot_map.exr", "numbers", "the file rule 'maps'"),
    ("tex/wood.png", "house texture", "the file rule 'textures'"),
    ("shot.exr", "house linear", "the working space, for nothing says otherwise"),
    ("wood.png", "srgb_rec709_scene", "integers are sRGB unless someone says otherwise"),
]


@pytest.mark.parametrize(("name", "space", "reason"), RULES)
def test_rules_of_the_config(tmp_path, color, reference, light, name, space, reason):
    if name.endswith(".png"):
        array = codes()
        path, numbers = made(tmp_path / name, array, "uint8"), (array / 255.0).astype(np.float32)
    else:
        array = light / 64.0
        path, numbers = made(tmp_path / name, array), array
    (found,) = find_layer_spaces(path, get_color_manager(color, UNRESTRICTED), sandbox=UNRESTRICTED).values()
    assert (found.name, found.reason) == (space, reason)
    if space == "numbers":
        expected = numbers
    elif space == "srgb_rec709_scene":  # the same matrix, the same curve
        expected = through(reference, numbers, "house texture", "house linear")
    else:
        expected = through(reference, numbers, space, "house linear")
    np.testing.assert_allclose(rgb(path, color), expected, rtol=2e-5, atol=2e-6)


@pytest.mark.parametrize(
    ("attributes", "reason"),
    [
        ({"colorInteropID": "lin_ap1_scene"}, "its header says so"),
        ({"chromaticities": CHROMATICITIES}, "its chromaticities"),
    ],
)
def test_a_header_is_stronger_than_a_rule(tmp_path, color, light, attributes, reason):
    path = made(tmp_path / "plates" / "a.exr", light, **attributes)
    (found,) = find_layer_spaces(path, get_color_manager(color, UNRESTRICTED), sandbox=UNRESTRICTED).values()
    assert found.reason == reason and found.space is not None and found.space.name == "house linear"
    np.testing.assert_array_equal(rgb(path, color), light)
    np.testing.assert_allclose(rgb(path, REC709), light @ AP1_TO_REC709.T, rtol=1e-5, atol=1e-4)


def test_what_is_said_of_an_input_is_stronger_than_all(tmp_path, color, reference, light):
    path = made(tmp_path / "plates" / "a.exr", light / 64.0, colorInteropID="lin_ap1_scene")
    np.testing.assert_allclose(
        rgb(path, color, "house dim"), through(reference, light / 64.0, "house dim", "house linear"), rtol=2e-5
    )
    (found,) = find_layer_spaces(
        path, get_color_manager(color, UNRESTRICTED), "HOUSE LOG", sandbox=UNRESTRICTED
    ).values()
    assert found.reason == "as color_space says"
    np.testing.assert_array_equal(rgb(path, color, "data"), light / np.float32(64.0))
    np.testing.assert_array_equal(rgb(path, color, "auto"), rgb(path, color))


def test_the_last_rule_says_nothing(tmp_path, light):
    """The built-in config takes every EXR for ACES2065-1, and whatever it does not know for sRGB."""
    path = made(tmp_path / "a.exr", light)
    np.testing.assert_array_equal(rgb(path, REC709), light)
    (found,) = find_layer_spaces(
        path, get_color_manager(ColorSettings("ocio://default"), UNRESTRICTED), sandbox=UNRESTRICTED
    ).values()
    assert (found.name, found.reason) == ("ACES2065-1", "the file rule 'EXR'")


@pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.tif", "a.hdr", "a.webp"])
def test_another_working_space_is_another_matrix(tmp_path, name):
    array = np.random.default_rng(1).random((16, 16, 3)).astype(np.float32) if name == "a.hdr" else codes()
    path = made(tmp_path / name, array, "float" if name == "a.hdr" else "uint8")
    plain, wide = rgb(path, REC709), rgb(path, ACESCG)
    np.testing.assert_allclose(wide @ AP1_TO_REC709.T, plain, atol=3e-6)
    assert np.abs(wide - plain).max() > 0.01


def test_premultiplied_and_straight_color(tmp_path, light):
    """Alpha is applied to light, never to codes."""
    alpha = np.linspace(0.0, 1.0, 32, dtype=np.float32)[None, :, None].repeat(24, axis=0)
    codes = through(studio(), light, "ACEScg", "ARRI LogC4")
    path = made(tmp_path / "a.exr", np.concatenate([codes * alpha, alpha], axis=2), colorInteropID="arri_logc4")
    array = read_layer(
        path, "", Kind.IMAGE, manager=get_color_manager(ACESCG, UNRESTRICTED), sandbox=UNRESTRICTED
    ).array
    expected = np.where(alpha > 0.0, through(studio(), codes, "ARRI LogC4", "ACEScg"), 0.0) * alpha
    seen = alpha[..., 0] > 0.0
    np.testing.assert_allclose(array[..., :3][seen], expected[seen], rtol=1e-4, atol=1e-5)
    np.testing.assert_array_equal(array[..., 3:], alpha)


def test_data_is_never_converted(tmp_path, color, light):
    depth, mask = light[..., :1] * 9.0, light[..., 1:2]
    opaque = np.concatenate([light, np.ones_like(depth)], axis=2)
    layers = {"Combined": opaque, "Depth": depth, "Normal": light, "CryptoObject00": light}
    path = write_exr(tmp_path / "plates_shot.exr", layers, dict.fromkeys(layers, "float"))
    for space in ("", "house log"):
        assert np.abs(rgb(path, color, space) - light).max() > 0.1
        for kind, layer, width, expected in (
            (Kind.FIELD, "Depth", 1, depth),
            (Kind.VECTOR, "Normal", 3, light),
            (Kind.FIELD, "Combined", 1, light[..., :1]),
            (Kind.VECTOR, "CryptoObject00", 3, light),
        ):
            array = read_layer(
                path,
                layer,
                kind,
                width,
                space=space,
                manager=get_color_manager(color, UNRESTRICTED),
                sandbox=UNRESTRICTED,
            ).array
            np.testing.assert_array_equal(array, expected)
        shown = read_layer(
            path,
            "Normal",
            Kind.IMAGE,
            space=space,
            manager=get_color_manager(color, UNRESTRICTED),
            sandbox=UNRESTRICTED,
        ).array[..., :3]
        np.testing.assert_array_equal(shown, light)
    gray = made(tmp_path / "plates" / "m.png", (mask.clip(0, 1) * 255).astype(np.uint8), "uint8")
    field = read_layer(gray, "", Kind.FIELD, manager=get_color_manager(color, UNRESTRICTED), sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(field, (mask.clip(0, 1) * 255).astype(np.uint8) / 255.0, atol=1e-7)
    assert set(find_layer_spaces(path, get_color_manager(color, UNRESTRICTED), sandbox=UNRESTRICTED)) == {"Combined"}


def graph_of(tmp_path: Path, **parts: object):
    tree = {
        "halation": 1,
        "settings": {"color": {"config": "house.ocio", "working": "scene_linear"}},
        "inputs": {"a": {"type": "Image", "file": "tex/wood.png", **parts}},
        "outputs": {"o": {"type": "Image"}},
        "nodes": {"r": {"type": "read_image", "values": {"path": "tex/wood.png", **parts}}},
        "links": {"outputs.o": "inputs.a"},
    }
    return document.loads(json.dumps(tree), folder=str(tmp_path), sandbox=UNRESTRICTED)


@pytest.mark.parametrize("parts", [{}, {"color_space": "house dim"}])
def test_a_graph_reads_so_by_inputs_and_by_nodes(tmp_path, color, parts):
    path = made(tmp_path / "tex" / "wood.png", codes(), "uint8")
    graph, expected = graph_of(tmp_path, **parts), rgb(path, color, str(parts.get("color_space", "")))
    np.testing.assert_array_equal(hal.render(graph, precision="float")["o"][..., :3], expected)
    by_node = hal.render(graph, node="r", precision="float")["r"]
    np.testing.assert_array_equal(by_node[..., :3], expected)
    bound = hal.render(graph, {"a": str(path)}, precision="float")["o"][..., :3]
    np.testing.assert_array_equal(bound, expected)
    again = document.loads(document.dumps(graph), folder=str(tmp_path), sandbox=UNRESTRICTED)
    assert again.inputs == graph.inputs and again.settings == graph.settings


def test_names_that_nobody_knows(tmp_path, house):
    made(tmp_path / "tex" / "wood.png", codes(), "uint8")
    with pytest.raises(GraphError, match=r"color_space 'house lgo' is unknown: did you mean 'house log'\?") as fault:
        hal.render(graph_of(tmp_path, color_space="house lgo"))
    assert fault.value.node == "inputs.a"
    house.write_text(house.read_text().replace("colorspace: house texture, regex", "colorspace: gone, regex"))
    with pytest.raises((InputError, GraphError), match="gone"):
        hal.render(graph_of(tmp_path))


def test_a_program_depends_on_the_content_of_a_table_and_not_on_its_place_or_date(tmp_path):
    """It is part of the key by which a picture is found to be up to date."""
    programs = []
    for place, slope in (("a", 0.5), ("b", 0.5), ("c", 0.75)):
        table = tmp_path / place / "look.cube"
        table.parent.mkdir()
        table.write_text(f"LUT_1D_SIZE 2\n0 0 0\n{slope} {slope} {slope}\n")
        os.utime(table, (1e9 + len(programs), 1e9))
        programs.append(write_color_change(LookupFile(str(table), False), UNRESTRICTED))
    first, second, other = programs
    assert first.function == second.function and first.text.body == second.text.body
    assert other.function != first.function
