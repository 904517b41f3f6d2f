"""Color on its way out: views, looks and color spaces against OpenColorIO's CPU path, and headers that say so."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio
import pytest
from device_textures import read_texture, upload_texture
from halation.color.display import to_display
from halation.color.encoding import Encoding
from halation.color.gpu_programs import write_view_program
from halation.color.management import get_color_manager
from halation.errors import GraphError, UsageError
from halation.media import read_layer, write_picture
from halation.nodes import ColorSettings, Kind
from halation.renderer import Display, Look, open_device
from halation.resources.sandbox import UNRESTRICTED
from house_config import AP1_TO_REC709, HOUSE, studio, through, write_house

ACESCG = ColorSettings("", "ACEScg")
AP1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
IMAGE = {"": Kind.IMAGE}


def header(path):
    return oiio.ImageInput.open(str(path)).spec()


def stored(path):
    return np.asarray(oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT))


def seen(reference, light, display, view, look=None):
    """A view, with its own looks or with another one, step by step."""
    if look is None:
        return through(reference, light, ocio.DisplayViewTransform("house linear", display, view))
    group = ocio.GroupTransform()
    group.appendTransform(ocio.LookTransform("house linear", "house linear", look))
    group.appendTransform(ocio.DisplayViewTransform("house linear", display, view, looksBypass=True))
    return through(reference, light, group)


VIEWS = [
    ("", "", "", ("Screen", "Plain")),
    ("warm", "", "", ("Screen", "Warm")),
    ("dim", "projector", "", ("Projector", "Dim")),
    ("Plain", "", "warm", ("Screen", "Plain", "warm")),
    ("Warm", "", "none", ("Screen", "Plain")),
    ("", "Projector", "warm", ("Projector", "Dim", "warm")),
]


@pytest.mark.parametrize(("view", "display", "look", "how"), VIEWS)
def test_views_and_looks(color, reference, light, view, display, look, how):
    expected = seen(reference, light, *how)
    shown = to_display(light, view, bits=32, display=display, look=look, manager=get_color_manager(color, UNRESTRICTED))
    np.testing.assert_allclose(shown, expected, rtol=1e-4, atol=2e-5)


def test_a_look_is_what_its_numbers_say(color, light):
    """Slope 1.2, 1, 0.8 in ACEScg, then sRGB: closed form."""
    lit = np.maximum((light * (1.2, 1.0, 0.8)) @ AP1_TO_REC709.T, 0.0)
    expected = np.where(lit <= 0.0031308, 12.92 * lit, 1.055 * lit ** (1 / 2.4) - 0.055)
    shown = to_display(light, "Warm", bits=32, manager=get_color_manager(color, UNRESTRICTED))
    inside = (lit > 0.0) & (lit < 4.0)
    np.testing.assert_allclose(shown[inside], expected[inside], atol=2e-4)
    plain = to_display(light, "none", bits=32, look="warm", manager=get_color_manager(color, UNRESTRICTED))
    np.testing.assert_allclose(plain[inside], expected[inside], atol=2e-4)


def test_plain_srgb_needs_nothing_of_a_config(color, light):
    lit = light @ AP1_TO_REC709.T
    expected = np.where(lit <= 0.0031308, 12.92 * lit, 1.055 * np.maximum(lit, 0.0) ** (1 / 2.4) - 0.055)
    inside = (lit > 0.0) & (lit < 4.0)
    for settings in (color, ACESCG):
        shown = to_display(light, "none", bits=32, manager=get_color_manager(settings, UNRESTRICTED))
        np.testing.assert_allclose(shown[inside], expected[inside], atol=1e-4)


def test_built_in_views_from_another_working_space(light):
    """The same light is the same picture."""
    rec709 = (light @ AP1_TO_REC709.T).astype(np.float32)
    for view, display in (("", ""), ("Un-tone-mapped", ""), ("", "Display P3 - Display")):
        wide = to_display(light, view, bits=32, display=display, manager=get_color_manager(ACESCG, UNRESTRICTED))
        np.testing.assert_allclose(wide, to_display(rec709, view, bits=32, display=display), atol=3e-3)


class Picture:
    def __init__(self, texture):
        self.texture, self.full_size, self.channels, self.key = texture, texture.size, 4, "k"
        self.size, self.start = texture.size, (0, 0)


def test_the_viewer_shows_the_same(color, light):
    device = open_device(sandbox=UNRESTRICTED)
    opaque = np.concatenate([light, np.ones_like(light[..., :1])], axis=2)
    texture = upload_texture(device, opaque)
    display = Display(device, "f4")
    for view, screen, look, _ in VIEWS:
        shown = display.draw(
            "x",
            texture.size,
            Picture(texture),
            None,
            Look(view=view, display=screen, look=look, manager=get_color_manager(color, UNRESTRICTED)),
        )
        pixels = read_texture(device, shown)[..., :3]
        expected = to_display(
            light, view, bits=32, display=screen, look=look, manager=get_color_manager(color, UNRESTRICTED)
        )
        np.testing.assert_allclose(pixels, expected, rtol=2e-3, atol=1e-3)
    gray = display.draw(
        "x",
        texture.size,
        Picture(texture),
        None,
        Look(channels="luminance", view="none", manager=get_color_manager(color, UNRESTRICTED)),
    )
    pixels = read_texture(device, gray)[..., 0]
    weighed = (light @ np.array((0.2722287, 0.6740818, 0.0536895)))[..., None].repeat(3, 2).astype(np.float32)
    np.testing.assert_allclose(
        pixels,
        to_display(weighed, "none", bits=32, manager=get_color_manager(color, UNRESTRICTED))[..., 0],
        rtol=2e-3,
        atol=1e-3,
    )
    display.close()
    device.close()
    assert write_view_program("Warm", "Screen", "", get_color_manager(color, UNRESTRICTED)).function == "view_transform"


def test_exr_says_what_it_is(tmp_path, light, color):
    plain, wide = tmp_path / "plain.exr", tmp_path / "wide.exr"
    write_picture(plain, {"": light}, kinds=IMAGE, precision="float", sandbox=UNRESTRICTED)
    write_picture(
        wide,
        {"": light},
        kinds=IMAGE,
        precision="float",
        encoding=Encoding(manager=get_color_manager(ACESCG, UNRESTRICTED)),
        sandbox=UNRESTRICTED,
    )
    assert header(plain).getattribute("chromaticities") is None
    assert header(plain).get_string_attribute("colorInteropID") == "lin_rec709_scene"
    assert header(wide).get_string_attribute("colorInteropID") == "lin_ap1_scene"
    assert header(wide).getattribute("chromaticities") == pytest.approx(AP1)
    np.testing.assert_array_equal(stored(wide), light)
    np.testing.assert_allclose(
        read_layer(wide, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., :3],
        light @ AP1_TO_REC709.T,
        rtol=1e-4,
        atol=1e-4,
    )
    np.testing.assert_array_equal(
        read_layer(wide, "", Kind.IMAGE, manager=get_color_manager(color, UNRESTRICTED), sandbox=UNRESTRICTED).array[
            ..., :3
        ],
        light,
    )


@pytest.mark.parametrize("settings", [ColorSettings(), ACESCG], ids=["rec709", "acescg"])
@pytest.mark.parametrize(
    ("name", "space", "depth", "says"),
    [
        ("a.exr", "ARRI LogC4", "half", True),
        ("a.exr", "arri logc3", "float", True),
        ("a.exr", "ACEScg", "half", True),
        ("a.dpx", "ARRI LogC4", "half", False),
        ("a.dpx", "ARRI LogC4", "float", False),
        ("a.png", "ARRI LogC4", "float", True),
        ("a.tif", "ACEScct", "float", False),
        ("a.png", "sRGB Encoded P3-D65", "float", True),
    ],
)
def test_there_and_back(tmp_path, settings, name, space, depth, says):
    """A ramp of grays and mild colors into a space, against OpenColorIO, and read again."""
    ramp = np.exp2(np.linspace(-6.0, -0.5 if "sRGB" in space else 4.0, 256, dtype=np.float32))[None, :, None]
    light = (ramp * np.array([[[1.0, 1.0, 1.0]], [[1.0, 0.8, 0.7]], [[0.7, 0.8, 1.0]]])).astype(np.float32)
    working = settings.working or "lin_rec709_scene"
    path = tmp_path / name
    write_picture(
        path,
        {"": light},
        kinds=IMAGE,
        precision=depth,
        encoding=Encoding(space=space, manager=get_color_manager(settings, UNRESTRICTED)),
        sandbox=UNRESTRICTED,
    )
    known = "arri_logc3_ei800" if space == "arri logc3" else space
    expected = through(studio(), light, working, known)
    bits = {"half": 10 if name == "a.dpx" else 0, "float": 0 if name == "a.exr" else 16}[depth]
    step = 1.01 / (2**bits - 1) / 2 if bits else 0.0
    kept = expected if name == "a.exr" else expected.clip(0.0, 1.0)
    np.testing.assert_allclose(stored(path)[..., :3], kept, rtol=6e-4 if depth == "half" else 1e-6, atol=step + 1e-6)
    again = read_layer(
        path,
        "",
        Kind.IMAGE,
        manager=get_color_manager(settings, UNRESTRICTED),
        space="" if says else space,
        sandbox=UNRESTRICTED,
    ).array[..., :3]
    codes = name == "a.dpx" and depth == "half"
    np.testing.assert_allclose(again, light, rtol=0.03 if depth == "half" else 2e-3, atol=1e-3 if codes else 1e-4)
    assert bool(header(path).get_string_attribute("colorInteropID")) == (name == "a.exr")


def test_alpha_stays_and_color_is_premultiplied_after(tmp_path):
    color = np.array([[[0.5, 0.25, 0.125, 0.5], [0.3, 0.2, 0.1, 0.0], [1.0, 1.0, 1.0, 1.0]]], np.float32)
    path = tmp_path / "a.exr"
    write_picture(
        path, {"": color}, kinds=IMAGE, precision="float", encoding=Encoding(space="ARRI LogC4"), sandbox=UNRESTRICTED
    )
    pixels = stored(path)
    np.testing.assert_array_equal(pixels[..., 3], color[..., 3])
    half = through(studio(), color[0, :1, :3] / 0.5, "lin_rec709_scene", "ARRI LogC4") * 0.5
    np.testing.assert_allclose(pixels[0, :1, :3], half, rtol=1e-5)


def test_data_is_written_as_it_is(tmp_path, light):
    path = tmp_path / "a.exr"
    layers, kinds = {"rgba": light, "depth": light[..., :1]}, {"rgba": Kind.IMAGE, "depth": Kind.FIELD}
    write_picture(
        path,
        layers,
        kinds=kinds,
        encoding=Encoding(space="ARRI LogC4", manager=get_color_manager(ACESCG, UNRESTRICTED)),
        sandbox=UNRESTRICTED,
    )
    np.testing.assert_array_equal(read_layer(path, "depth", Kind.FIELD, sandbox=UNRESTRICTED).array, light[..., :1])
    buffer = oiio.ImageBuf(str(path), 1, 0)
    assert buffer.spec().get_string_attribute("colorInteropID") == "data"


def test_radiance_files_hold_rec709(tmp_path, light):
    path = tmp_path / "a.hdr"
    write_picture(
        path,
        {"": light},
        kinds=IMAGE,
        encoding=Encoding(manager=get_color_manager(ACESCG, UNRESTRICTED)),
        sandbox=UNRESTRICTED,
    )
    expected = np.maximum(light @ AP1_TO_REC709.T, 0.0)
    brightest = expected.max(axis=2, keepdims=True)  # its three channels share an exponent
    assert (np.abs(stored(path) - expected) / brightest).max() < 0.01
    back = read_layer(
        path, "", Kind.IMAGE, manager=get_color_manager(ACESCG, UNRESTRICTED), sandbox=UNRESTRICTED
    ).array[..., :3]
    np.testing.assert_allclose(back @ AP1_TO_REC709.T, stored(path), rtol=1e-4, atol=1e-3)


def test_a_screen_is_named_in_png(tmp_path, light):
    path = tmp_path / "a.png"
    write_picture(
        path, {"": light}, kinds=IMAGE, encoding=Encoding(display="Display P3 - Display"), sandbox=UNRESTRICTED
    )
    assert header(path).get_string_attribute("oiio:ColorSpace") == "srgb_p3d65_scene"
    write_picture(path, {"": light}, kinds=IMAGE, sandbox=UNRESTRICTED)
    assert header(path).get_string_attribute("oiio:ColorSpace") == "srgb_rec709_scene"


@pytest.mark.parametrize(
    ("encoding", "said"),
    [
        (Encoding(space="ARRI LogC5"), "there is no color space 'ARRI LogC5': did you mean 'ARRI LogC4'"),
        (Encoding(view="none", space="ACEScg"), "through a view or into a color space: give one of them"),
        (Encoding(look="warmm"), "there is no look 'warmm'"),
        (Encoding(display="CRT"), "there is no display 'CRT'"),
    ],
)
def test_what_there_is_not(tmp_path, light, encoding, said):
    with pytest.raises(UsageError, match=said):
        write_picture(tmp_path / "a.exr", {"": light}, kinds=IMAGE, encoding=encoding, sandbox=UNRESTRICTED)
    assert not (tmp_path / "a.exr").exists()


def test_a_table_that_a_config_lacks(tmp_path, light):
    text = HOUSE.replace("!<ExponentTransform> {value: 2.6}", "!<FileTransform> {src: gone.cube}")
    lacks = ColorSettings(str(write_house(tmp_path, "lacks.ocio", text)), "scene_linear")
    with pytest.raises(GraphError, match=r"lacks\.ocio: .*gone\.cube"):
        to_display(light, "Dim", display="Projector", manager=get_color_manager(lacks, UNRESTRICTED))
