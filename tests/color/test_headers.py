"""Color that a header describes by numbers: chromaticities, gammas, film curves; and names that nobody wrote."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from film_scans import write_cineon
from halation.color.file_space import CHROMATICITIES, SRGB
from halation.color.header_space import REC709, HeaderSpace, make_gamut_matrix
from halation.color.management import LINEAR_REC709, get_color_manager, get_default_color_manager
from halation.errors import InputError
from halation.media import read_info, read_layer
from halation.media.color_spaces import describe_color_spaces, find_layer_spaces
from halation.media.pictures.color_hints import read_color_hints
from halation.nodes import ColorSettings, Kind
from halation.resources.sandbox import UNRESTRICTED
from house_config import AP1_TO_REC709, studio
from oiio_pictures import write_picture

Array = np.ndarray
E_WHITE, D60, D65 = (1.0 / 3.0, 1.0 / 3.0), (0.32168, 0.33767), (0.3127, 0.3290)
XYZ = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
REC709_TO_XYZ = np.array(
    [[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923], [0.0193308, 0.1191948, 0.9505322]]
)
"""IEC 61966-2-1 with the digits of colour-science."""


def with_chromaticities(path: Path, light: Array, numbers: tuple[float, ...], **options: object) -> Path:
    kind = oiio.TypeDesc(f"float[{len(numbers)}]")
    return write_picture(path, light, attributes={"chromaticities": (kind, numbers)}, **options)


def rgb(path: Path, color: ColorSettings | None = None) -> Array:
    return read_layer(
        path, "", Kind.IMAGE, manager=get_color_manager(color or ColorSettings(), UNRESTRICTED), sandbox=UNRESTRICTED
    ).array[..., :3]


def test_every_gamut_is_opencolorios():
    """The chromaticities of each space that has a name, as a matrix, against the built-in config's own."""
    assert len(CHROMATICITIES) >= 6
    for name, gamut in CHROMATICITIES.items():
        colors = np.eye(3, dtype=np.float32)
        studio().getProcessor(name, "lin_rec709_scene").getDefaultCPUProcessor().applyRGB(colors)
        matrix = make_gamut_matrix(gamut)
        assert matrix is not None
        np.testing.assert_allclose(matrix, colors.T, atol=2e-4, err_msg=name)


def name_and_reason(path: Path) -> tuple[str, ...]:
    (row,) = describe_color_spaces(path, sandbox=UNRESTRICTED)
    return row


NAMED = {
    "ACEScg": (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, *D60),
    "ACES2065-1": (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, *D60),
    "Linear Rec.2020": (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, *D65),
    "Linear P3-D65": (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, *D65),
    "Linear AdobeRGB": (0.64, 0.33, 0.21, 0.71, 0.15, 0.06, *D65),
}
CAMERAS = {
    "ARRI 3": (0.684, 0.313, 0.221, 0.848, 0.0861, -0.102, *D65),
    "ARRI 4": (0.7347, 0.2653, 0.1424, 0.8576, 0.0991, -0.0308, *D65),
    "RED": (0.780308, 0.304253, 0.121595, 1.493994, 0.095612, -0.084589, *D65),
    "Sony": (0.730, 0.280, 0.140, 0.855, 0.100, -0.050, *D65),
    "Panasonic": (0.730, 0.280, 0.165, 0.840, 0.100, -0.030, *D65),
}


@pytest.mark.parametrize("space", NAMED)
def test_chromaticities_are_those_of_the_space(tmp_path, light, space):
    """With a name or without: the matrix is that of OpenColorIO."""
    path = with_chromaticities(tmp_path / "a.exr", light, NAMED[space])
    expected = np.array(light)
    studio().getProcessor(space, "Linear Rec.709 (sRGB)").getDefaultCPUProcessor().applyRGB(expected)
    np.testing.assert_allclose(rgb(path), expected, rtol=2e-3, atol=2e-3 * np.abs(expected).max(axis=2).min())
    assert name_and_reason(path)[1] == "its chromaticities"
    wide = rgb(path, ColorSettings("", "ACEScg"))
    np.testing.assert_allclose(wide @ AP1_TO_REC709.T, rgb(path), rtol=1e-3, atol=1e-3)


@pytest.mark.parametrize("maker", CAMERAS)
def test_gamuts_of_cameras(tmp_path, light, maker):
    """In float64, by the definition of chromaticities: X = x / y * Y of each primary, which add up to white."""
    x, y = np.array(CAMERAS[maker]).reshape(4, 2).T
    columns = np.array([x, y, 1.0 - x - y])
    to_xyz = columns[:, :3] * np.linalg.solve(columns[:, :3], columns[:, 3] / y[3])
    path = with_chromaticities(tmp_path / "a.exr", light, CAMERAS[maker])
    expected = light.astype(np.float64) @ np.linalg.solve(REC709_TO_XYZ, to_xyz).T
    np.testing.assert_allclose(rgb(path), expected, rtol=1e-3, atol=1e-3 * np.abs(expected).max())


def test_tristimulus_values_are_the_light_itself(tmp_path, light):
    """As in OpenEXR's XYZ.exr: the same picture as Rec709.exr, in CIE XYZ."""
    path = with_chromaticities(tmp_path / "a.exr", (light @ REC709_TO_XYZ.T).astype(np.float32), (*XYZ, *E_WHITE))
    np.testing.assert_allclose(rgb(path), light, rtol=2e-3, atol=2e-3)
    assert name_and_reason(path) == ("lin_ciexyzd65_scene", "its chromaticities")


def test_a_white_is_adapted(tmp_path):
    """White is white, whatever light it was seen in (Bradford); with Rec.709's primaries too."""
    white = np.ones((2, 2, 3), np.float32)
    for numbers in ((*REC709[:6], *D60), (*NAMED["Linear P3-D65"][:6], 0.314, 0.351), (*REC709[:6], *E_WHITE)):
        path = with_chromaticities(tmp_path / "a.exr", white, numbers)
        np.testing.assert_allclose(rgb(path), white, rtol=1e-5)
        assert name_and_reason(path)[0].startswith("primaries (")
    same = with_chromaticities(tmp_path / "b.exr", white, REC709)
    assert name_and_reason(same) == ("lin_rec709_scene", "its chromaticities")


def test_a_config_without_rec709_gets_it_from_the_studio_config(tmp_path, light, house, color):
    """Light by primaries of its own, in the working space of a house whose config has no linear Rec.709."""
    text = house.read_text("utf-8")
    start, end = (
        text.index("  - !<ColorSpace>\n    name: house seven"),
        text.index("  - !<ColorSpace>\n    name: house tex"),
    )
    house.write_text(text[:start] + text[end:], "utf-8")
    path = with_chromaticities(tmp_path / "a.exr", light, (0.62, 0.34, 0.29, 0.61, 0.15, 0.07, *D65))
    expected = rgb(path).astype(np.float64) @ np.linalg.inv(AP1_TO_REC709).T
    np.testing.assert_allclose(rgb(path, color), expected, rtol=1e-4, atol=1e-4 * np.abs(expected).max())


IMPOSSIBLE = {
    "zeros": (0.0,) * 8,
    "on a line": (0.1, 0.1, 0.2, 0.2, 0.3, 0.3, *D65),
    "no white": (*REC709[:6], 0.3, 0.0),
    "a white from nowhere": (*REC709[:6], 0.9, 0.9),
    "no number": (float("nan"), *REC709[1:]),
    "infinite": (float("inf"), *REC709[1:]),
    "too few": REC709[:6],
}


@pytest.mark.parametrize("numbers", IMPOSSIBLE.values(), ids=IMPOSSIBLE)
def test_impossible_ones_are_reported(tmp_path, light, numbers):
    path = with_chromaticities(tmp_path / "a.exr", light, numbers)
    np.testing.assert_array_equal(rgb(path), light)
    name, reason = name_and_reason(path)
    if len(numbers) != 8:  # OpenEXR drops an attribute of another type
        return
    assert name == "lin_rec709_scene" and "those of no colors" in reason and "give the input a color_space" in reason
    assert "those of no colors" in read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).warning


def test_the_matrix_of_the_same_primaries_is_none_at_all():
    np.testing.assert_allclose(make_gamut_matrix(REC709), np.eye(3), atol=1e-6)
    assert HeaderSpace().is_linear and not HeaderSpace(gamma=2.0).is_linear


def png(path: Path, codes: Array, *chunks: tuple[bytes, bytes]) -> Path:
    """A PNG of gray codes with these chunks before the picture."""
    depth, (height, width) = (16 if codes.dtype == np.uint16 else 8), codes.shape
    rows = b"".join(b"\0" + row.astype(codes.dtype.newbyteorder(">")).tobytes() for row in codes)
    parts = [(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)), *chunks]
    parts += [(b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    body = b"".join(struct.pack(">I", len(d)) + t + d + struct.pack(">I", zlib.crc32(t + d)) for t, d in parts)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + body)
    return path


@pytest.mark.parametrize("gamma", [0.25, 0.35, 0.4, 0.45455, 0.5, 0.55, 0.7, 1.0, 1.4, 2.5])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_gammas_of_png(tmp_path, gamma, dtype):
    """The sample is light to the power of gAMA (PNG 1.2, 10.5)."""
    codes = np.linspace(0, np.iinfo(dtype).max, 64).astype(dtype).reshape(8, 8)
    path = png(tmp_path / "a.png", codes, (b"gAMA", struct.pack(">I", round(gamma * 1e5))))
    expected = (codes / np.iinfo(dtype).max) ** (1.0 / gamma)
    np.testing.assert_allclose(rgb(path)[..., 0], expected, rtol=2e-4, atol=1e-6)
    assert "header" in name_and_reason(path)[1] or name_and_reason(path)[1] == "its gamma"


@pytest.mark.parametrize("raw", [0, 1, 2**31 - 1])
def test_impossible_gammas_are_ignored(tmp_path, raw):
    path = png(tmp_path / "a.png", np.full((4, 4), 128, np.uint8), (b"gAMA", struct.pack(">I", raw)))
    assert np.isfinite(rgb(path)).all()


@pytest.mark.parametrize(
    "chunk",
    [
        (b"sRGB", b"\0"),
        (b"cHRM", struct.pack(">8I", 31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)),
        (b"iCCP", b"profile\0\0" + zlib.compress(bytes(200))),
        (b"cICP", bytes((1, 13, 0, 1))),
        (b"cICP", bytes((9, 16, 0, 1))),
        (b"cICP", bytes((200, 200, 0, 1))),
    ],
    ids=lambda chunk: f"{chunk[0].decode()}{chunk[1][:4].hex()}",
)
def test_every_chunk_of_color_is_readable(tmp_path, chunk):
    path = png(tmp_path / "a.png", np.full((4, 4), 128, np.uint8), chunk)
    assert 0.0 < rgb(path).max() < 1.0


def test_film_scans(tmp_path):
    """Kodak's curve: 95 is black, 685 is white, 1023 is 13.5 times as much."""
    codes = np.array([[95, 445, 685, 1023]] * 2)[..., None].repeat(3, axis=2)
    path = write_cineon(tmp_path / "a.cin", codes)
    black = 10.0 ** ((95 - 685) * 0.002 / 0.6)
    expected = (10.0 ** ((codes - 685) * 0.002 / 0.6) - black) / (1.0 - black)
    np.testing.assert_allclose(rgb(path), expected, atol=2e-4)
    assert name_and_reason(path) == ("Kodak log film", "its header says so")


@pytest.mark.parametrize("ending", ["pfm", "ppm", "pgm", "pbm", "pnm"])
@pytest.mark.parametrize("format", ["uint8", "uint16", "float"])
def test_portable_maps(tmp_path, ending, format):
    codes = np.full((4, 5, 1 if ending in ("pgm", "pbm") else 3), 0.5, np.float32)
    path = write_picture(tmp_path / f"a.{ending}", codes, format=format)
    stored = read_layer(path, "", Kind.FIELD, sandbox=UNRESTRICTED).array
    if str(oiio.ImageBuf(str(path)).spec().format) == "float":
        np.testing.assert_array_equal(rgb(path), 0.5)
    else:
        expected = ((stored + 0.055) / 1.055) ** 2.4 if stored.max() < 1.0 else 1.0
        np.testing.assert_allclose(rgb(path)[..., :1], expected, rtol=1e-3)


@pytest.mark.parametrize("format", ["uint8", "uint16"])
def test_a_later_page_of_a_tiff_is_read_as_the_first_one(tmp_path, format):
    """OpenImageIO gives later pages names of spaces that nobody wrote."""
    path, spec = tmp_path / "a.tif", oiio.ImageSpec(5, 4, 3, format)
    file, pages = oiio.ImageOutput.create(str(path)), [np.full((4, 5, 3), code, np.float32) for code in (0.2, 0.6)]
    for mode, page in zip(("Create", "AppendSubimage"), pages, strict=True):
        assert file.open(str(path), spec, mode) and file.write_image(page)
    assert file.close()
    names = [layer.name for layer in read_info(path, sandbox=UNRESTRICTED).layers]
    assert len(names) == 2
    for name, page in zip(names, pages, strict=True):
        stored = read_layer(path, name, Kind.FIELD, sandbox=UNRESTRICTED).array
        np.testing.assert_allclose(stored[..., 0], page[..., 0], atol=2e-3)
        array = read_layer(path, name, Kind.IMAGE, sandbox=UNRESTRICTED).array
        np.testing.assert_allclose(array[..., :1], ((stored + 0.055) / 1.055) ** 2.4, rtol=1e-3)


@pytest.mark.parametrize(
    ("format", "tag"), [("pnm", "Rec709"), ("tiff", SRGB), ("tiff", "sRGB"), ("png", SRGB), ("hdr", LINEAR_REC709)]
)
def test_a_tag_that_a_library_gives_to_all_files_of_a_format_says_nothing(format, tag):
    """Which tags it gives, and to which pages, depends on the version of OpenImageIO."""
    spec = oiio.ImageSpec(5, 4, 3, "uint8")
    spec.attribute("oiio:ColorSpace", tag)
    assert read_color_hints(spec, format, "uint8").tag == ""


def test_a_name_that_the_author_wrote_is_refused(tmp_path, light):
    path = write_picture(tmp_path / "a.exr", light, attributes={"colorInteropID": ("string", "my studio log")})
    with pytest.raises(InputError, match="'my studio log' is unknown: give the input a color_space"):
        find_layer_spaces(path, get_default_color_manager(), sandbox=UNRESTRICTED)
