"""Layers are found under the names that people type, whatever the renderer called its channels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.errors import InputError
from halation.media import find_layer, read_info
from halation.media.channels import ChannelPart, group_channels, is_depth
from halation.media.layers import ImageInfo
from halation.resources.sandbox import UNRESTRICTED

ROOT = Path(__file__).parents[2]
NEON = ROOT / "presets/samples/neon.exr"
SINGLE = ROOT / "tests/data/blender45_multilayer.exr"


def header(*parts: ChannelPart) -> ImageInfo:
    return ImageInfo("x.exr", (4, 4), group_channels(parts), "", "openexr")


def one(*channels: str, tag: str = "", name: str = "", index: int = 0) -> ChannelPart:
    return ChannelPart(index, name, channels, ("float32",) * len(channels), tag)


def test_parts_of_blender_5() -> None:
    found = read_info(NEON, sandbox=UNRESTRICTED)
    assert found.size == (480, 270) and found.format == "openexr"
    assert {layer.name: (layer.part, layer.channels, layer.is_half, layer.is_data) for layer in found.layers} == {
        "Combined": (0, tuple("RGBA"), True, False),
        "Depth": (1, ("Z",), False, True),
        "Position": (2, tuple("XYZ"), False, True),
        "Normal": (3, tuple("XYZ"), False, True),
        "Vector": (4, tuple("XYZW"), False, True),
        "Object Index": (5, ("X",), False, True),
        "Diffuse Color": (6, tuple("RGB"), True, False),
        "Emission": (7, tuple("RGB"), True, False),
        "CryptoObject00": (8, tuple("rgba"), False, True),
        "CryptoObject01": (9, tuple("rgba"), False, True),
        "CryptoObject02": (10, tuple("rgba"), False, True),
        "Noisy Image": (11, tuple("RGBA"), True, False),
    }


def test_one_part_of_blender_4() -> None:
    found = read_info(SINGLE, sandbox=UNRESTRICTED)
    layers = {layer.name: layer for layer in found.layers}
    assert [*layers] == [
        "Combined",
        "CryptoObject00",
        "CryptoObject01",
        "CryptoObject02",
        "Depth",
        "DiffCol",
        "Emit",
        "IndexOB",
        "Noisy Image",
        "Normal",
        "Position",
        "Vector",
    ]
    assert {layer.part for layer in found.layers} == {0}
    assert [layer.first for layer in found.layers] == [0, 4, 8, 12, 16, 17, 20, 23, 24, 28, 31, 34]
    assert {name for name, layer in layers.items() if not layer.is_data} == {
        "Combined",
        "DiffCol",
        "Emit",
        "Noisy Image",
    }


@pytest.mark.parametrize("path", [NEON, SINGLE])
@pytest.mark.parametrize(
    ("name", "layer"),
    [
        ("", "Combined"),
        ("Combined", "Combined"),
        ("combined", "Combined"),
        ("ViewLayer.Combined", "Combined"),
        ("Depth", "Depth"),
        ("Depth.Z", "Depth.Z"),
        ("Z", "Depth"),
        ("z", "Depth"),
        ("viewlayer.depth.z", "Depth.Z"),
        ("noisy_image", "Noisy Image"),
        ("Position.Z", "Position.Z"),
        ("crypto-object-01", "CryptoObject01"),
    ],
)
def test_names_that_people_type(path: Path, name: str, layer: str) -> None:
    found = find_layer(read_info(path, sandbox=UNRESTRICTED), name)
    assert found.name == layer
    assert len(found.channels) == (1 if layer[-2:] == ".Z" or layer == "Depth" else 3 + ("o" in found.channels or 1))


def test_a_channel_is_a_layer_of_one() -> None:
    found = find_layer(read_info(SINGLE, sandbox=UNRESTRICTED), "Position.Y")
    assert (found.channels, found.indices, found.is_data) == (("Y",), (32,), True)


def test_a_missing_layer_is_named_with_the_nearest() -> None:
    with pytest.raises(InputError, match=r"neon\.exr: has no layer 'Dpth': did you mean 'Depth'\? It holds Combined, "):
        find_layer(read_info(NEON, sandbox=UNRESTRICTED), "Dpth")
    with pytest.raises(InputError, match=r"has no layer 'qqq': it holds Combined, Depth"):
        find_layer(read_info(NEON, sandbox=UNRESTRICTED), "qqq")


def test_two_view_layers_are_told_apart() -> None:
    two = header(one(*(f"Near.Combined.{letter}" for letter in "RGB"), "Far.Combined.R", "Far.Combined.G", "Far.Z"))
    assert [layer.name for layer in two.layers] == ["Near.Combined", "Far.Combined", "Far"]
    assert find_layer(two, "far.combined").indices == (3, 4)
    with pytest.raises(InputError, match=r"'combined' may mean Near\.Combined or Far\.Combined: write one of them"):
        find_layer(two, "combined")


@pytest.mark.parametrize(
    ("channels", "expected"),
    [
        (("R", "G", "B", "A", "Z"), {"RGBA": (0, 1, 2, 3), "Z": (4,)}),
        (("A", "B", "G", "R", "ID"), {"RGBA": (3, 2, 1, 0), "ID": (4,)}),
        (("Y",), {"Y": (0,)}),
        (("Y", "A"), {"YA": (0, 1)}),
        (("diffuse.blue", "diffuse.green", "diffuse.red"), {"diffuse": (2, 1, 0)}),
        (("UV.A", "UV.U", "UV.V", "N.X", "N.Y", "N.Z"), {"UV": (1, 2, 0), "N": (3, 4, 5)}),
        (("X", "Y", "Z"), {"XYZ": (0, 1, 2)}),
        (("u", "v"), {"uv": (0, 1)}),
    ],
)
def test_channels_in_natural_order(channels: tuple[str, ...], expected: dict[str, tuple[int, ...]]) -> None:
    assert {layer.name: layer.indices for layer in header(one(*channels)).layers} == expected


def test_the_depth_of_a_view_is_a_layer_of_its_own() -> None:
    stereo = header(one(*"ABGRZ", *(f"left.{letter}" for letter in "ABGRZ"), "forward.u", "forward.v", "st.u", "st.w"))
    assert {layer.name: (layer.indices, layer.is_data) for layer in stereo.layers} == {
        "RGBA": ((3, 2, 1, 0), False),
        "Z": ((4,), True),
        "left": ((8, 7, 6, 5), False),
        "left.Z": ((9,), True),
        "forward": ((10, 11), True),
        "st": ((12, 13), True),
    }
    assert find_layer(stereo, "left.z").indices == (9,)


def test_parts_name_channels_that_have_no_prefix() -> None:
    parts = [one(*"RGB", name="left", index=0), one(*"RGBZ", name="right", index=1), one("Z", index=2)]
    assert [(layer.name, layer.part) for layer in group_channels(parts)] == [
        ("left", 0),
        ("right", 1),
        ("right.Z", 1),
        ("Z", 2),
    ]
    same = [one("R", "G", "B", index=0), one("R", "G", "B", index=1)]
    assert [layer.name for layer in group_channels(same)] == ["part0.RGB", "part1.RGB"]


def test_what_is_color_and_what_is_data() -> None:
    normal = one("normal.R", "normal.G", "normal.B", tag="lin_ap1_scene", index=1)
    tagged = header(one("N.R", "N.G", "N.B", tag="data"), normal)
    assert [layer.is_data for layer in tagged.layers] == [True, False]
    names = ("normal", "albedo", "CryptoMaterial00", "P", "diffuse", "motionvector", "valid", "objectID")
    bare = header(one(*(f"{name}.{letter}" for name in names for letter in "RGB")))
    assert [layer.name for layer in bare.layers if not layer.is_data] == ["albedo", "diffuse", "valid"]


def test_the_main_picture() -> None:
    assert find_layer(header(one("Z", "AO.R", "AO.G", "AO.B", "rgba.R", "rgba.G", "rgba.B")), "").name == "rgba"
    assert find_layer(header(one("N.X", "N.Y", "glow.R", "glow.G", "glow.B")), "").name == "glow"
    assert find_layer(header(one("Z")), "").name == "Z"
    with pytest.raises(InputError, match="no channels"):
        find_layer(ImageInfo("x.exr", (1, 1), (), "", ""), "")


def test_depth_by_name() -> None:
    yes = np.array([is_depth(name) for name in ("depth", "Z", "zDepth", "z_depth", "hitPz", "Linear_Depth")])
    no = np.array([is_depth(name) for name in ("mask", "denoise depth", "zebra", "")])
    assert yes.all() and not no.any()
