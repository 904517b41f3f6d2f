"""Attributes of any type under any name that means something: a damaged header is no reason to fail."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.media import read_layer, read_metadata, write_picture
from halation.media.color_spaces import describe_color_spaces
from halation.media.header import read_header
from halation.media.pictures.open import read_pixel_aspect
from halation.nodes import Kind
from halation.render_layers.analysis import analyze_render
from halation.render_layers.mattes import find_mattes
from halation.render_layers.report import format_report
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import write_picture as write_by_openimageio

NAMES = (
    "chromaticities",
    "colorInteropID",
    "Orientation",
    "worldToCamera",
    "worldToNDC",
    "worldToScreen",
    "screenWindowWidth",
    "screenWindowCenter",
    "PixelAspectRatio",
    "Software",
    "multiView",
    "view",
    "BlenderMultiChannel",
    "cryptomatte/1234567/name",
    "cryptomatte/1234567/manifest",
    "cryptomatte/1234567/manif_file",
    "halation:graph",
    "halation:renderer",
    "halation:inputs",
    "oiio:Gamma",
    "oiio:ColorSpace",
    "smpte:TimeCode",
    "FramesPerSecond",
    "DateTime",
    "ImageDescription",
    "owner",
    "envmap",
    "wrapmodes",
    "dwa:compressionLevel",
)
NAN, INF = float("nan"), float("inf")
VALUES = {
    "text": "what?",
    "empty": "",
    "long": "x" * 70_000,
    "nested": "[" * 20_000,
    "int": 2**31 - 1,
    "negative": -(2**31),
    "float": 1e38,
    "nan": NAN,
    "infinite": INF,
    "texts": ("string[3]", ("a", "b", "")),
    "many texts": ("string[16]", ("a",) * 16),
    "ints": ("int[8]", (0,) * 8),
    "floats": ("float[8]", (NAN, INF, -INF, 0.0, 1e38, -1.0, 1.0, 0.5)),
    "zeros": ("float[8]", (0.0,) * 8),
    "matrix": ("matrix", (NAN,) * 16),
    "big matrix": ("matrix", (1e38,) * 16),
    "zero matrix": ("matrix", (0.0,) * 16),
    "double": ("double", 1e308),
    "timecode": ("timecode", (2**32 - 1, 2**32 - 1)),
    "rational": ("rational", (1, 0)),
    "vector": ("vector", (NAN, INF, 0.0)),
    "box": ("box2i", (2**31 - 1, -(2**31), 0, 0)),
}


ENDINGS = ("exr", "png", "tif", "jpg")


@pytest.mark.parametrize("value", VALUES)
@pytest.mark.parametrize("ending", ENDINGS)
def test_any_attribute(tmp_path, value, ending, is_nightly):
    """Every name with every value: every day in two of the four formats, at night in all."""
    if (value, ending) == ("long", "jpg"):
        pytest.skip("libjpeg ends the process of whoever writes it, see below")
    given = VALUES[value]
    first, step = (0, 1) if is_nightly else ((list(VALUES).index(value) + ENDINGS.index(ending)) % 2, 2)
    for number, name in enumerate(NAMES[first::step]):
        attributes = {name: (oiio.TypeDesc(given[0]), given[1]) if isinstance(given, tuple) else given}
        array = np.full((6, 8, 4), 0.5, np.float32)
        path = tmp_path / f"{number}.{ending}"
        try:
            write_by_openimageio(path, array, format="float" if ending == "exr" else "uint8", attributes=attributes)
        except (AssertionError, TypeError):  # OpenImageIO does not write it
            continue
        header = read_header(path, sandbox=UNRESTRICTED)
        json.dumps({key: repr(item) for key, item in header.attributes.items()})
        describe_color_spaces(path, sandbox=UNRESTRICTED)
        analysis = analyze_render(path, sandbox=UNRESTRICTED)
        assert list(format_report(analysis)) and isinstance(find_mattes(analysis), tuple)
        metadata = read_metadata(path, sandbox=UNRESTRICTED)
        for target in (tmp_path / f"out.{ending}", tmp_path / "out.exr"):
            write_picture(target, {"": array}, kinds={"": Kind.IMAGE}, metadata=metadata, sandbox=UNRESTRICTED)
            assert target.stat().st_size
        if name not in ("colorInteropID", "oiio:ColorSpace"):
            assert np.isfinite(read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array).all()


@pytest.mark.parametrize("size", [900, 7900, 70_000])
def test_many_long_texts(tmp_path, size):
    """Together they are longer than a block of a JPEG's header, where libjpeg ends the process, so another one writes.

    It says what it has written, so that the last word is before the file at fault.
    """
    names = ["ImageDescription", "Artist", "Copyright", "Software", "Make", "Model", "HostComputer", "Keywords"]
    names += [f"Exif:{word}" for word in ("UserComment", "ImageUniqueID", "LensModel", "MakerNote", "BodySerialNumber")]
    names += [f"IPTC:{word}" for word in ("Caption", "Instructions", "City", "Creator", "CopyrightNotice", "Headline")]
    endings = ["jpg", "png", "tif", "webp", "hdr", "dpx", "exr"]
    metadata = dict.fromkeys(names, "&<\u00e9" * (size // 3))
    array = np.full((6, 8, 4), 0.5, np.float32)
    code = """
import pickle, sys
from halation.media import write_picture
options = pickle.load(sys.stdin.buffer)
for path in options.pop("paths"):
    write_picture(path, **options)
    print(path.suffix[1:], flush=True)
"""
    options = {
        "paths": [tmp_path / f"a.{ending}" for ending in endings],
        "layers": {"": array},
        "kinds": {"": Kind.IMAGE},
        "metadata": metadata,
        "sandbox": UNRESTRICTED,
    }
    ended = subprocess.run([sys.executable, "-P", "-c", code], input=pickle.dumps(options), stdout=subprocess.PIPE)
    assert ended.stdout.decode().split() == endings and ended.returncode == 0
    for path in options["paths"]:
        assert read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array.shape == (6, 8, 4)


@pytest.mark.parametrize("ending", ["jpg", "tif", "png", "exr"])
@pytest.mark.parametrize("size", [100, 7_000, 20_000, 50_000])
def test_a_graph_in_a_header_may_be_longer_than_other_texts(tmp_path, ending, size):
    """In a JPEG a foreign text of more than 8,000 bytes is left out; the graph that made the picture has 60,000."""
    ours = {"halation:graph": "x" * size, "halation:version": "1"}
    foreign = {"ImageDescription": "y" * size} if ending == "jpg" else {}
    path = tmp_path / f"a.{ending}"
    array = np.full((6, 8, 4), 0.5, np.float32)
    write_picture(path, {"": array}, kinds={"": Kind.IMAGE}, metadata=ours | foreign, sandbox=UNRESTRICTED)
    found = read_metadata(path, sandbox=UNRESTRICTED)
    assert {name: found.get(name) for name in ours} == ours
    assert ("ImageDescription" in found) == (ending == "jpg" and size < 8_000)


@pytest.mark.parametrize(
    ("orientation", "aspect", "expected"),
    [(1, None, 1.0), (1, 2.0, 2.0), (4, 16.0, 16.0), (5, 2.0, 0.5), (8, 0.0625, 16.0), (1, 16.5, 1.0), (1, 0.0, 1.0)],
)
def test_the_shape_of_pixels_is_that_of_the_upright_picture(orientation, aspect, expected) -> None:
    spec = oiio.ImageSpec(4, 4, 3, oiio.FLOAT)
    spec.attribute("Orientation", orientation)
    if aspect is not None:
        spec.attribute("PixelAspectRatio", aspect)
    assert read_pixel_aspect(spec) == expected
