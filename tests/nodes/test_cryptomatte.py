"""Cryptomatte against a decoding of the sample by OpenImageIO and numpy, bit by bit; hashes against known ones."""

from __future__ import annotations

import json
import struct
from fnmatch import fnmatchcase
from functools import cache

import numpy as np
import OpenImageIO as oiio
import pytest
from halation import media
from halation.errors import GraphError
from halation.nodes import Kind, float_bits, murmur3
from halation.nodes.geometry.cryptomatte import Cryptomatte
from halation.presets import sample
from halation.resources.sandbox import UNRESTRICTED

SAMPLE = str(sample())


@cache
def decoded() -> tuple[np.ndarray, np.ndarray, dict[str, int]]:
    """Bits of the ids and their coverages by rank, [rank, h, w], and the ids by name, straight from the file."""
    file, part = oiio.ImageInput.open(SAMPLE), 0
    layers: dict[str, np.ndarray] = {}
    while file.seek_subimage(part, 0):
        spec = file.spec()
        if "CryptoObject" in spec.channelnames[0]:
            layers[spec.channelnames[0]] = np.asarray(file.read_image(part, 0, 0, 4, "float"))
        part += 1
    file.seek_subimage(0, 0)
    manifest = json.loads(file.spec().get_string_attribute("cryptomatte/542cafa/manifest"))
    stack = np.concatenate([layers[name] for name in sorted(layers)], axis=2).transpose(2, 0, 1)
    ids = np.ascontiguousarray(stack[0::2]).view(np.uint32)
    return ids, stack[1::2], {name: int(number, 16) for name, number in manifest.items()}


def expected(names: list[str]) -> np.ndarray:
    """Coverages added in the order of ranks, in the precision of the file."""
    ids, covered, manifest = decoded()
    total = np.zeros(ids.shape[1:], np.float32)
    for rank in range(len(ids)):
        total += np.where(np.isin(ids[rank], [manifest[name] for name in names]), covered[rank], np.float32(0.0))
    return total


def matte(run, pick: str, **more) -> np.ndarray:
    return run(Cryptomatte(path=SAMPLE, pick=pick, **more), output="matte")[..., 0]


def test_every_name_of_the_sample_is_exact(run):
    """And all of them together cover no pixel more than once."""
    manifest = decoded()[2]
    total = np.zeros((270, 480))
    assert len(manifest) > 20
    for name in manifest:
        found = matte(run, name)
        np.testing.assert_array_equal(found, expected([name]))
        total += found
    assert total.mean() > 0.9 and total.max() <= 1.0 + 1e-6
    soft = matte(run, "monkey")
    assert ((soft > 0.0) & (soft < 1.0)).sum() > 100, "edges are soft"


@pytest.mark.parametrize(
    ("pick", "wanted"),
    [
        ("ring_blue, ring_pink", ["ring_blue", "ring_pink"]),
        ("ring_*", ["ring_*"]),
        ("prop0[1-3]\nmonkey", ["prop0[1-3]", "monkey"]),
        ("prop?0", ["prop?0"]),
        ('"floor", "wall"', ["floor", "wall"]),
        ("floor, floor", ["floor"]),
        ("nobody, Floor", []),
        ("", []),
        (" , ,", []),
    ],
)
def test_names_and_wildcards(run, pick, wanted):
    names = [name for name in decoded()[2] if any(fnmatchcase(name, one) for one in wanted)]
    assert bool(names) == bool(wanted)
    found = matte(run, pick)
    np.testing.assert_array_equal(found, expected(names))
    np.testing.assert_array_equal(matte(run, pick, invert=True), 1.0 - found)


def test_more_names_than_one_draw_takes_and_some_left_out(run):
    names = list(decoded()[2])
    np.testing.assert_allclose(matte(run, "*"), expected(names), atol=1e-6)
    left = [name for name in names if name not in ("floor", "wall")]
    np.testing.assert_allclose(matte(run, "*, -floor, -wall"), expected(left), atol=1e-6)
    many = ",".join([f"nobody{number}" for number in range(100)] + ["monkey"])
    np.testing.assert_array_equal(matte(run, many), expected(["monkey"]))


def test_hashes_that_others_have_computed():
    """Of Appleby's MurmurHash3_x86_32 with seed 0, and all of those in the sample, by Blender."""
    known = {
        "": 0x0,
        "test": 0xBA6BD213,
        "hello": 0x248BFA47,
        "hello, world": 0x149BBB7F,
        "Hello, world!": 0xC0363E43,
        "The quick brown fox jumps over the lazy dog": 0x2E4FF723,
    }
    for text, number in known.items():
        assert murmur3(text.encode()) == number, text
    for name, number in decoded()[2].items():
        assert float_bits(murmur3(name.encode())) == float_bits(number), name
    assert f"{murmur3(b'ViewLayer.CryptoObject'):08x}".startswith("542cafa")


def test_an_id_is_a_usual_number():
    for number in (0x0, 0x007FFFFF, 0x7F800000, 0xFFFFFFFF, 0x80000001, 0x12345678):
        (value,) = struct.unpack("<f", struct.pack("<I", float_bits(number)))
        assert np.isfinite(value) and abs(value) >= np.finfo(np.float32).tiny
    assert float_bits(0x12345678) == 0x12345678


IDS = [*(float_bits(murmur3(name)) for name in (b"first", b"second")), 0x00800000, 0x7F7FFFFF]
"""Two names, and the ends of what floats hold."""


def bare(path, layer: str = "crypto_object", ids=IDS, **attributes: str) -> str:
    """A file of two ranks: each of four ids covers three quarters of a pixel, and a quarter of the one before."""
    pixels = np.zeros((1, 4, 4), np.float32)
    for x in range(4):
        pixels[0, x, 0::2] = np.array([ids[x], ids[(x + 1) % 4]], np.uint32).view(np.float32)
        pixels[0, x, 1::2] = 0.75, 0.25
    spec = oiio.ImageSpec(4, 1, 4, "float")
    spec.channelnames = tuple(f"{layer}00.{letter}" for letter in "rgba")
    for name, value in attributes.items():
        spec.attribute(f"cryptomatte/1234567/{name}", value)
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), spec) and file.write_image(pixels) and file.close()
    return str(path)


def test_without_a_manifest_names_are_hashed(run, tmp_path):
    path = bare(tmp_path / "bare.exr")
    for pick, wanted in (
        ("first", [0.75, 0.0, 0.0, 0.25]),
        ("second", [0.25, 0.75, 0.0, 0.0]),
        ("f*", [0.0] * 4),
        ("*", [1.0] * 4),
    ):
        found = run(Cryptomatte(path=path, pick=pick), output="matte")[0, :, 0]
        assert found.tolist() == wanted, pick


@pytest.mark.parametrize("layer", ["crypto_object", "VRayCryptomatte"])
def test_a_manifest_beside_the_picture(run, tmp_path, layer):
    manifest = {"least": "00800000", "most": "7f7fffff", "unfit": "00000000"}
    (tmp_path / "names.json").write_text(json.dumps(manifest), "utf-8")
    path = bare(tmp_path / "named.exr", layer, name=layer, manif_file="names.json")
    for pick, wanted in (
        ("least", [0.0, 0.25, 0.75, 0.0]),
        ("most", [0.0, 0.0, 0.25, 0.75]),
        ("*st", [0.0, 0.25, 1.0, 0.75]),
    ):
        assert run(Cryptomatte(path=path, pick=pick), output="matte")[0, :, 0].tolist() == wanted, pick


@pytest.mark.parametrize("manifest", ["", "no json", '{"first": "xyz"}', "[1]", '{"first": 7, "other": null}'])
def test_a_broken_manifest_has_no_names(run, tmp_path, manifest):
    path = bare(tmp_path / "broken.exr", name="crypto_object", manifest=manifest)
    assert run(Cryptomatte(path=path, pick="second"), output="matte")[0, :, 0].tolist() == [0.25, 0.75, 0.0, 0.0]
    path = bare(tmp_path / "lost.exr", name="crypto_object", manif_file="nowhere.json")
    assert run(Cryptomatte(path=path, pick="first"), output="matte")[0, :, 0].tolist() == [0.75, 0.0, 0.0, 0.25]


def test_the_colors_are_as_opaque_as_what_is_covered(run):
    ids, covered, _ = decoded()
    colors = run(Cryptomatte(path=SAMPLE), output="colors")
    whole = np.where(ids != 0, covered, 0.0).sum(axis=0)
    np.testing.assert_allclose(colors[..., 3], whole, atol=1e-6)
    assert (colors[..., :3].max(axis=2) <= colors[..., 3] + 1e-6).all()


def test_what_no_object_covers_has_no_color(run, tmp_path):
    """Id 0 is that of nothing (Cryptomatte specification 1.2), whatever a renderer writes beside it."""
    path = bare(tmp_path / "bare.exr", ids=[IDS[0], 0, 0, IDS[1]])
    assert run(Cryptomatte(path=path), output="colors")[0, :, 3].tolist() == [0.75, 0.0, 0.25, 1.0]
    assert run(Cryptomatte(path=path, pick="*"), output="matte")[0, :, 0].tolist() == [0.75, 0.0, 0.25, 1.0]


def test_a_file_without_mattes_says_so(run, tmp_path):
    path = tmp_path / "plain.exr"
    media.write_picture(
        path, {"image": np.ones((4, 4, 4), np.float32)}, kinds={"image": Kind.IMAGE}, sandbox=UNRESTRICTED
    )
    with pytest.raises(GraphError, match="has no layer for its output"):
        run(Cryptomatte(path=str(path)), output="matte")
    with pytest.raises(GraphError, match="has no layer for its output"):
        run(Cryptomatte(path=SAMPLE, layer="asset"), output="matte")
