"""Written files hold what was asked for, as OpenImageIO reads them back."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.color.display import to_display
from halation.errors import UsageError
from halation.media import TypedAttribute, read_info, read_layer, read_metadata, write_picture
from halation.nodes import Kind
from halation.resources.render_choices import Precision
from halation.resources.sandbox import UNRESTRICTED

Make = Callable[..., Path]
Random = np.random.Generator
IMAGE = {"image": Kind.IMAGE}
NEON = Path(__file__).parents[2] / "presets/samples/neon.exr"


def parts(path: Path) -> list[tuple[oiio.ImageSpec, np.ndarray]]:
    """Header and pixels of every part, alpha as stored."""
    wish = oiio.ImageSpec()
    wish.attribute("oiio:UnassociatedAlpha", 1)
    handle = oiio.ImageInput.open(str(path), wish)
    assert handle is not None, oiio.geterror()
    found = []
    while handle.seek_subimage(len(found), 0):
        found.append((handle.spec(), handle.read_image(len(found), 0, 0, 10000, "float")))
    return found


def hdr(rng: Random, channels: int = 4, size: tuple[int, int] = (9, 13)) -> np.ndarray:
    colors = np.exp2(rng.uniform(-8, 5, (*size, channels))).astype(np.float32)
    if channels == 4:
        colors[..., 3] = rng.uniform(0.1, 1.0, size)
    return colors


@pytest.mark.parametrize(("precision", "dtype"), [("half", np.float16), ("float", np.float32)])
def test_exr_of_one_picture(tmp_path: Path, rng: Random, precision: Any, dtype: type) -> None:
    colors = hdr(rng)
    write_picture(tmp_path / "a.exr", {"image": colors}, kinds=IMAGE, precision=precision, sandbox=UNRESTRICTED)
    [(spec, pixels)] = parts(tmp_path / "a.exr")
    assert spec.channelnames == ("R", "G", "B", "A") and str(spec.format) == precision
    assert spec.get_string_attribute("compression") == "zip"
    assert spec.get_string_attribute("colorInteropID") == "lin_rec709_scene"
    np.testing.assert_array_equal(pixels, colors.astype(dtype).astype(np.float32))
    again = read_layer(tmp_path / "a.exr", "", Kind.IMAGE, sandbox=UNRESTRICTED)
    np.testing.assert_array_equal(again.array, colors.astype(dtype))


def test_halves_end_at_their_largest_number(tmp_path: Path) -> None:
    write_picture(
        tmp_path / "a.exr",
        {"image": np.array([[[1e6, -1e6, np.inf, 1]]], np.float32)},
        kinds=IMAGE,
        sandbox=UNRESTRICTED,
    )
    np.testing.assert_array_equal(parts(tmp_path / "a.exr")[0][1], [[[65504, -65504, 65504, 1]]])


@pytest.mark.parametrize("compression", ["none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"])
def test_exr_compression(tmp_path: Path, rng: Random, compression: str) -> None:
    colors, depth = hdr(rng, size=(40, 40)), rng.uniform(1, 1e4, (40, 40, 1)).astype(np.float32)
    write_picture(
        tmp_path / "a.exr",
        {"": colors, "depth": depth},
        kinds={"": Kind.IMAGE, "depth": Kind.FIELD},
        compression=compression,
        sandbox=UNRESTRICTED,
    )
    (color, _), (data, stored) = parts(tmp_path / "a.exr")
    assert color.get_string_attribute("compression").partition(":")[0] == compression
    np.testing.assert_array_equal(stored, depth)  # whatever happens to the color
    assert data.get_string_attribute("compression") in ("none", "rle", "zips", "zip", "piz")


def test_exr_of_many_layers(tmp_path: Path, rng: Random) -> None:
    layers = {
        "image": hdr(rng),
        "zDepth": rng.random((9, 13, 1), np.float32),
        "mask": rng.random((9, 13, 1), np.float32),
        "normal": rng.random((9, 13, 3), np.float32),
        "motion": rng.random((9, 13, 2), np.float32),
    }
    kinds = {
        "image": Kind.IMAGE,
        "zDepth": Kind.FIELD,
        "mask": Kind.FIELD,
        "normal": Kind.VECTOR,
        "motion": Kind.VECTOR,
    }
    write_picture(tmp_path / "a.exr", layers, kinds=kinds, metadata={"only": "once"}, sandbox=UNRESTRICTED)
    found = parts(tmp_path / "a.exr")
    assert [spec.channelnames for spec, _ in found] == [
        ("image.R", "image.G", "image.B", "image.A"),
        ("zDepth.Z",),
        ("mask.Y",),
        ("normal.X", "normal.Y", "normal.Z"),
        ("motion.X", "motion.Y"),
    ]
    assert [str(spec.format) for spec, _ in found] == ["half", "float", "float", "float", "float"]
    assert [spec.get_string_attribute("colorInteropID") for spec, _ in found] == ["lin_rec709_scene", *["data"] * 4]
    assert [spec.get_string_attribute("only") for spec, _ in found] == ["once", "", "", "", ""]
    for name, (_, pixels) in zip(layers, found, strict=True):
        exact = layers[name].astype(np.float16) if name == "image" else layers[name]
        np.testing.assert_array_equal(pixels, exact.astype(np.float32))
        width = layers[name].shape[2]
        np.testing.assert_array_equal(
            read_layer(tmp_path / "a.exr", name, kinds[name], width, sandbox=UNRESTRICTED).array, exact
        )
    assert [(layer.name, layer.is_data) for layer in read_info(tmp_path / "a.exr", sandbox=UNRESTRICTED).layers] == [
        ("image", False),
        ("zDepth", True),
        ("mask", True),
        ("normal", True),
        ("motion", True),
    ]


@pytest.mark.parametrize(
    ("name", "kind", "width", "expected"),
    [
        ("depth", Kind.FIELD, 1, "Z"),
        ("mask", Kind.FIELD, 1, "Y"),
        ("uv", Kind.VECTOR, 2, "XY"),
        ("c", Kind.IMAGE, 3, "RGB"),
    ],
)
def test_a_layer_alone_has_plain_channels(
    tmp_path: Path, rng: Random, name: str, kind: Kind, width: int, expected: str
) -> None:
    write_picture(
        tmp_path / "a.exr", {name: rng.random((4, 4, width), np.float32)}, kinds={name: kind}, sandbox=UNRESTRICTED
    )
    assert parts(tmp_path / "a.exr")[0][0].channelnames == tuple(expected)


def test_a_flat_array_is_a_field(tmp_path: Path, rng: Random) -> None:
    mask = rng.random((4, 6), np.float32)
    write_picture(tmp_path / "a.exr", {"mask": mask}, kinds={"mask": Kind.FIELD}, sandbox=UNRESTRICTED)
    np.testing.assert_array_equal(
        read_layer(tmp_path / "a.exr", "", Kind.FIELD, sandbox=UNRESTRICTED).array[..., 0], mask
    )


def test_views(tmp_path: Path, rng: Random) -> None:
    colors = hdr(rng)
    for view in ("", "none", "Raw"):
        write_picture(tmp_path / "a.png", {"image": colors}, kinds=IMAGE, view=view, sandbox=UNRESTRICTED)
        [(spec, pixels)] = parts(tmp_path / "a.png")
        assert str(spec.format) == "uint8" and spec.channelnames == ("R", "G", "B", "A")
        np.testing.assert_array_equal(np.rint(pixels * 255), to_display(colors, view))
    write_picture(tmp_path / "b.png", {"image": colors}, kinds=IMAGE, sandbox=UNRESTRICTED)
    assert (tmp_path / "b.png").read_bytes() != (tmp_path / "a.png").read_bytes()


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.tiff"])
def test_16_bits(tmp_path: Path, rng: Random, name: str) -> None:
    colors = hdr(rng)
    write_picture(tmp_path / name, {"image": colors}, kinds=IMAGE, precision="float", sandbox=UNRESTRICTED)
    [(spec, pixels)] = parts(tmp_path / name)
    assert str(spec.format) == "uint16"
    np.testing.assert_array_equal(np.rint(pixels * 65535), to_display(colors, bits=16))


def test_written_and_read_again(tmp_path: Path, rng: Random) -> None:
    colors = rng.uniform(0, 1, (16, 16, 4)).astype(np.float32)
    colors[..., :3] *= colors[..., 3:]
    for name in ("a.png", "a.tif"):
        write_picture(
            tmp_path / name, {"image": colors}, kinds=IMAGE, view="none", precision="float", sandbox=UNRESTRICTED
        )
        np.testing.assert_allclose(
            read_layer(tmp_path / name, "", Kind.IMAGE, sandbox=UNRESTRICTED).array, colors, atol=1e-4
        )


def test_opaque_pictures_have_no_alpha(tmp_path: Path, rng: Random) -> None:
    colors = hdr(rng)
    colors[..., 3] = 1.0
    write_picture(tmp_path / "a.png", {"image": colors}, kinds=IMAGE, sandbox=UNRESTRICTED)
    assert parts(tmp_path / "a.png")[0][0].nchannels == 3


@pytest.mark.parametrize(
    ("alpha", "precision", "count"), [(0.9995, "half", 3), (0.9995, "float", 4), (0.99, "half", 4)]
)
def test_alpha_stays_where_a_code_says_something(
    tmp_path: Path, rng: Random, alpha: float, precision: Precision, count: int
) -> None:
    """A blur leaves 0.9995 of an alpha of 1 in half floats: of 255 codes that is all of them, of 65,535 it is not."""
    colors = hdr(rng)
    colors[..., 3] = 1.0
    colors[3, 5, 3] = alpha
    write_picture(tmp_path / "a.png", {"image": colors}, kinds=IMAGE, precision=precision, sandbox=UNRESTRICTED)
    [(spec, pixels)] = parts(tmp_path / "a.png")
    assert spec.nchannels == count
    if count == 4:
        assert pixels[3, 5, 3] == pytest.approx(alpha, abs=0.5 / 255)


@pytest.mark.parametrize("name", ["a.jpg", "a.JPEG", "a.webp"])
def test_lossy_pictures_are_close(tmp_path: Path, name: str) -> None:
    ramp = np.ones((64, 64, 4), np.float32)
    ramp[..., :3] = np.linspace(0, 1, 64)[:, None, None]
    write_picture(tmp_path / name, {"image": ramp}, kinds=IMAGE, sandbox=UNRESTRICTED)
    [(spec, pixels)] = parts(tmp_path / name)
    assert spec.nchannels == 3
    assert np.abs(pixels * 255 - to_display(ramp[..., :3])).max() <= 4


def test_jpeg_is_over_black(tmp_path: Path) -> None:
    glass = np.full((16, 16, 4), 0.25, np.float32)
    write_picture(tmp_path / "a.jpg", {"image": glass}, kinds=IMAGE, view="none", sandbox=UNRESTRICTED)
    expected = (1.055 * 0.25 ** (1 / 2.4) - 0.055) * 255
    assert np.abs(parts(tmp_path / "a.jpg")[0][1] * 255 - expected).max() <= 1


def test_radiance(tmp_path: Path, rng: Random) -> None:
    colors = hdr(rng, 3)
    write_picture(tmp_path / "a.hdr", {"image": colors}, kinds=IMAGE, sandbox=UNRESTRICTED)
    pixels = parts(tmp_path / "a.hdr")[0][1]
    assert (np.abs(pixels - colors) <= colors.max(axis=2, keepdims=True) / 128).all()  # 8 bits and a common exponent


def test_the_first_picture_is_shown(tmp_path: Path, rng: Random) -> None:
    colors, mask = hdr(rng), rng.random((9, 13, 1), np.float32)
    both: Mapping[str, np.ndarray] = {"mask": mask, "image": colors}
    write_picture(tmp_path / "a.png", both, kinds={"mask": Kind.FIELD, **IMAGE}, sandbox=UNRESTRICTED)
    np.testing.assert_array_equal(np.rint(parts(tmp_path / "a.png")[0][1] * 255), to_display(colors))
    write_picture(tmp_path / "m.png", {"mask": mask}, kinds={"mask": Kind.FIELD}, view="none", sandbox=UNRESTRICTED)
    np.testing.assert_array_equal(np.rint(parts(tmp_path / "m.png")[0][1] * 255), np.rint(mask.repeat(3, 2) * 255))


def test_metadata_passes_through(tmp_path: Path, make: Make, rng: Random) -> None:
    matrix, timecode = tuple(float(number) for number in range(16)), (19088743, 0)
    source = make(
        "a.exr",
        rng.random((4, 4, 3), np.float32),
        format="half",
        attributes={
            "Scene": "Straße 9",
            "shutter": 0.5,
            "take": 3,
            "worldToCamera": ("matrix", matrix),
            "smpte:TimeCode": ("timecode", timecode),
            "PixelAspectRatio": 2.0,
            "compression": "piz",
            "chromaticities": ("float[8]", (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)),
            "Orientation": 1,
        },
    )
    kept = read_metadata(source, sandbox=UNRESTRICTED)
    assert kept == {
        "Scene": "Straße 9",
        "shutter": 0.5,
        "take": 3,
        "worldToCamera": TypedAttribute("matrix", matrix),
        "smpte:TimeCode": TypedAttribute("timecode", timecode),
        "PixelAspectRatio": 2.0,
    }
    write_picture(tmp_path / "b.exr", {"image": hdr(rng)}, kinds=IMAGE, metadata=kept, sandbox=UNRESTRICTED)
    assert read_metadata(tmp_path / "b.exr", sandbox=UNRESTRICTED) == kept
    [(spec, _)] = parts(tmp_path / "b.exr")
    assert spec.get_string_attribute("compression") == "zip"
    names = [item.name for item in spec.extra_attribs]
    assert len(names) == len(set(names))


def test_metadata_of_a_render(tmp_path: Path, rng: Random) -> None:
    kept = read_metadata(NEON, sandbox=UNRESTRICTED)
    assert kept["Software"] == "Blender 5.0.1" and kept["cryptomatte/542cafa/hash"] == "MurmurHash3_32"
    assert not {"compression", "name", "colorInteropID", "screenWindowWidth", "openexr:chunkCount"} & {*kept}
    write_picture(tmp_path / "b.exr", {"image": hdr(rng)}, kinds=IMAGE, metadata=kept, sandbox=UNRESTRICTED)
    assert read_metadata(tmp_path / "b.exr", sandbox=UNRESTRICTED) == kept


GRAPH = '{"ä": 1, "nodes": ["' + "x" * 100_000 + '"]}'


@pytest.mark.parametrize("name", ["a.exr", "a.png"])
def test_a_graph_fits_into_the_header(tmp_path: Path, rng: Random, name: str) -> None:
    metadata = {"halation:graph": GRAPH, "halation:version": "0.1.0"}
    write_picture(tmp_path / name, {"image": hdr(rng)}, kinds=IMAGE, metadata=metadata, sandbox=UNRESTRICTED)
    assert {key: read_metadata(tmp_path / name, sandbox=UNRESTRICTED)[key] for key in metadata} == metadata


@pytest.mark.parametrize("name", ["a.jpg", "a.tif"])
def test_one_place_holds_all_that_is_ours(tmp_path: Path, rng: Random, name: str) -> None:
    """Formats without names of our own: what is not ours stays beside it, and nothing is invented."""
    ours = {"halation:graph": GRAPH[:40_000] + '"]}', "halation:input:inputs.beauty": "ä b.exr:Z sha256:0"}
    ours["Artist"] = "me"
    write_picture(tmp_path / name, {"image": hdr(rng)}, kinds=IMAGE, metadata=ours, sandbox=UNRESTRICTED)
    kept = read_metadata(tmp_path / name, sandbox=UNRESTRICTED)
    assert {key: kept[key] for key in ours} == ours
    write_picture(tmp_path / f"b{name}", {"image": hdr(rng)}, kinds=IMAGE, metadata=kept, sandbox=UNRESTRICTED)
    assert read_metadata(tmp_path / f"b{name}", sandbox=UNRESTRICTED) == kept


@pytest.mark.parametrize("name", ["a.jpg", "a.tif", "a.webp", "a.hdr"])
def test_a_graph_does_no_harm_elsewhere(tmp_path: Path, rng: Random, name: str) -> None:
    metadata = {
        "halation:graph": GRAPH,
        "ImageDescription": GRAPH,
        "Copyright": GRAPH,
        "Artist": "me",
        "worldToCamera": TypedAttribute("matrix", tuple(float(number) for number in range(16))),
        "take": 3,
        "gain": 0.5,
    }
    write_picture(tmp_path / name, {"image": hdr(rng)}, kinds=IMAGE, metadata=metadata, sandbox=UNRESTRICTED)
    assert parts(tmp_path / name)[0][1].shape[:2] == (9, 13)


def test_any_alphabet(tmp_path: Path, rng: Random) -> None:
    for name in ("ä 画像 👁.exr", "ä 画像 👁.png"):
        write_picture(tmp_path / name, {"image": hdr(rng)}, kinds=IMAGE, sandbox=UNRESTRICTED)
        assert read_info(tmp_path / name, sandbox=UNRESTRICTED).size == (13, 9)


def refused(path: Path, layers: Mapping[str, np.ndarray], kinds: Mapping[str, Kind], **options: Any) -> str:
    with pytest.raises(UsageError) as caught:
        write_picture(path, layers, kinds=kinds, **options, sandbox=UNRESTRICTED)
    assert not path.exists() and not [*path.parent.iterdir()]
    return str(caught.value)


def test_calls_that_make_no_sense(tmp_path: Path, rng: Random) -> None:
    image = {"image": hdr(rng)}
    assert "cannot write '.xyz' files: use one of .exr, .png" in refused(tmp_path / "a.xyz", image, IMAGE)
    assert "has no ending" in refused(tmp_path / "a", image, IMAGE)
    assert "'zpi': did you mean 'zip'? Choose from none, rle" in refused(
        tmp_path / "a.exr", image, IMAGE, compression="zpi"
    )
    assert "no compression 'dwaa'" in refused(tmp_path / "a.tif", image, IMAGE, compression="dwaa")
    assert "no view 'AGES': did you mean" in refused(tmp_path / "a.png", image, IMAGE, view="AGES")
    assert "nothing to write" in refused(tmp_path / "a.exr", {}, {})
    assert "no view 'typo'" in refused(tmp_path / "a.exr", image, IMAGE, view="typo")
    vectors = rng.random((4, 4, 3), np.float32)
    assert "write them to an .exr" in refused(tmp_path / "a.png", {"n": vectors}, {"n": Kind.VECTOR})
    assert "one size, but there are 'image' 13x9, 'n' 4x4" in refused(
        tmp_path / "a.exr", {**image, "n": vectors}, {**IMAGE, "n": Kind.VECTOR}
    )


def test_srgb_and_linear_rec709_are_tagged_as_openimageio_does_without_its_color_config(tmp_path: Path) -> None:
    """Loading the config takes as long as writing a small picture. It announces itself, if it is asked to."""
    code = (
        "import sys, numpy as np, OpenImageIO as oiio\n"
        "from halation.media import write_picture\n"
        "from halation.nodes import Kind\n"
        "from halation.resources.sandbox import UNRESTRICTED\n"
        "layers = {'image': np.ones((2, 2, 4), np.float32), 'Z': np.ones((2, 2, 1), np.float32)}\n"
        "kinds = {'image': Kind.IMAGE, 'Z': Kind.FIELD}\n"
        "for name in sys.argv[1:]:\n"
        "    chosen = layers if name.endswith('.exr') else {'image': layers['image']}\n"
        "    write_picture(name, chosen, kinds=kinds, sandbox=UNRESTRICTED)\n"
        "print('written')\n"
        "spec = oiio.ImageSpec(2, 2, 3, 'uint8')\n"
        "spec.attribute('oiio:ColorSpace', 'srgb_rec709_scene')\n"
        "oiio.ImageOutput.create('jpeg').open(sys.argv[1] + '.jpg', spec)\n"
    )
    names = [str(tmp_path / f"a.{ending}") for ending in ("exr", "png", "jpg", "tif", "webp", "hdr", "dpx")]
    environment = {**os.environ, "OIIO_DEBUG_COLOR": "1"}
    run = subprocess.run([sys.executable, "-c", code, *names], env=environment, capture_output=True, text=True)
    before, _, after = run.stdout.partition("written")
    assert run.returncode == 0 and "OCIO" not in before and "OCIO" in after, run.stdout + run.stderr
    tags = [spec.get_string_attribute("oiio:ColorSpace") for name in names[:4] for spec, _ in parts(Path(name))]
    assert tags == ["lin_rec709_scene", "data", "srgb_rec709_scene", "srgb_rec709_scene", "srgb_rec709_scene"]


@pytest.mark.parametrize("ending", ["png", "jpg", "tif"])
def test_bytes_are_those_of_an_explicit_tag(tmp_path: Path, ending: str) -> None:
    codes = np.full((2, 2, 3), 128, np.uint8)
    light = np.full((2, 2, 3), 0.2158605, np.float32)  # code 128 of sRGB
    write_picture(tmp_path / f"a.{ending}", {"image": light}, kinds=IMAGE, view="Un-tone-mapped", sandbox=UNRESTRICTED)
    spec = oiio.ImageSpec(2, 2, 3, "uint8")
    for name, value in (
        ("DateTime", ""),
        ("oiio:ColorSpace", "srgb_rec709_scene"),
        ("oiio:UnassociatedAlpha", 1),
        ("compression", {"png": "", "jpg": "jpeg:95", "tif": "zip"}[ending]),
        ("jpeg:subsampling", "4:4:4"),
        ("png:compressionLevel", 4),
    ):
        spec.attribute(name, value)
    output = oiio.ImageOutput.create(ending)
    assert output.open(str(tmp_path / f"b.{ending}"), spec) and output.write_image(codes) and output.close()
    assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()
