"""Channel Shuffle, Separate and Combine, Premultiply and Unpremultiply against OpenImageIO."""

from __future__ import annotations

from itertools import product

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.channel.channel_shuffle import ChannelShuffle
from halation.nodes.channel.combine import Combine
from halation.nodes.channel.combine_vector import CombineVector
from halation.nodes.channel.combine_vector2 import CombineVector2
from halation.nodes.channel.combine_vector4 import CombineVector4
from halation.nodes.channel.premultiply import Premultiply
from halation.nodes.channel.separate import Separate
from halation.nodes.channel.separate_vector import SeparateVector
from halation.nodes.channel.separate_vector2 import SeparateVector2
from halation.nodes.channel.separate_vector4 import SeparateVector4
from halation.nodes.channel.unpremultiply import Unpremultiply

ALGO = oiio.ImageBufAlgo
VECTORS = [
    (2, SeparateVector2, CombineVector2),
    (3, SeparateVector, CombineVector),
    (4, SeparateVector4, CombineVector4),
]


def pixels(seed: int, channels: int = 4) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-2.0, 8.0, (11, 13, channels)).astype(np.float32)


def buffer(array: np.ndarray) -> oiio.ImageBuf:
    made = oiio.ImageBuf(oiio.ImageSpec(array.shape[1], array.shape[0], array.shape[2], "float"))
    made.set_pixels(oiio.ROI.All, array)
    made.specmod().alpha_channel = 3
    return made


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (2, 1, 0, 3), (3, 3, 3, 0), (0, 0, 0, 2)])
def test_shuffle_is_channels_of_openimageio(run, order):
    image, names = pixels(0), ("red", "green", "blue", "alpha")
    node = ChannelShuffle(**{name: names[index] for name, index in zip(names, order, strict=True)})
    assert np.array_equal(run(node, {"image": image}), ALGO.channels(buffer(image), order).get_pixels("float"))


def test_shuffle_takes_from_the_other_image_and_constants(run):
    image, other = pixels(1), pixels(2)
    node = ChannelShuffle(red="other blue", green="zero", blue="one", alpha="other alpha")
    out = run(node, {"image": image, "other": other})
    assert np.array_equal(out, np.stack([other[..., 2], 0 * image[..., 0], 0 * image[..., 0] + 1, other[..., 3]], -1))
    out = run(ChannelShuffle(red="luminance", green="other luminance"), {"image": image, "other": other})
    for channel, source in ((0, image), (1, other)):
        assert np.abs(out[..., channel] - source[..., :3].astype(np.float64) @ [0.2126, 0.7152, 0.0722]).max() < 2e-6


def test_every_choice_fills_every_channel(run):
    image, other = pixels(3), pixels(4)
    luminance = [source[..., :3].astype(np.float64) @ [0.2126, 0.7152, 0.0722] for source in (image, other)]
    expected = [
        *np.moveaxis(image, -1, 0),
        luminance[0],
        0 * image[..., 0],
        0 * image[..., 0] + 1,
        *np.moveaxis(other, -1, 0),
        luminance[1],
    ]
    choices = ChannelShuffle.values["red"].choices
    for (number, channel), (choice, wanted) in product(
        enumerate(("red", "green", "blue", "alpha")), zip(choices, expected, strict=True)
    ):
        out = run(ChannelShuffle(**{channel: choice}), {"image": image, "other": other})
        assert np.abs(out[..., number] - wanted).max() < 2e-6, (channel, choice)


def test_separate_and_combine_are_inverse(run):
    image = pixels(5)
    parts = {name: run(Separate(), {"image": image}, output=name) for name in Separate.outputs}
    for number, part in enumerate(parts.values()):
        assert np.array_equal(part[..., 0], image[..., number])
    assert np.array_equal(run(Combine(), parts), image)


def test_combine_is_opaque_unless_linked(run):
    red = pixels(6, 1)
    out = run(Combine(), {"red": red})
    assert np.array_equal(out[..., 0], red[..., 0])
    assert np.all(out[..., 1:3] == 0.0) and np.all(out[..., 3] == 1.0)


@pytest.mark.parametrize(("width", "separate", "combine"), VECTORS)
def test_vectors_separate_and_combine(run, width, separate, combine):
    vector = pixels(7, width)
    parts = {axis: run(separate(), {"vector": vector}, output=axis) for axis in "xyzw"[:width]}
    for number, part in enumerate(parts.values()):
        assert np.array_equal(part[..., 0], vector[..., number])
    assert np.array_equal(run(combine(), parts, output="vector")[..., :width], vector)


@pytest.mark.parametrize(("node", "reference"), [(Premultiply(), ALGO.premult), (Unpremultiply(), ALGO.unpremult)])
def test_premultiplication_is_that_of_openimageio(run, node, reference):
    image = np.abs(pixels(8))
    image[..., 3] = np.random.default_rng(9).uniform(0.0, 1.0, image.shape[:2])
    image[:3, :3, 3] = 0.0
    expected = reference(buffer(image)).get_pixels("float")
    assert (np.abs(run(node, {"image": image}) - expected) / np.maximum(1.0, np.abs(expected))).max() < 1e-6


def test_unpremultiply_undoes_premultiply(run):
    image = np.abs(pixels(10))
    image[..., 3] = np.random.default_rng(11).uniform(0.01, 1.0, image.shape[:2])
    back = run(Unpremultiply(), {"image": run(Premultiply(), {"image": image})})
    assert (np.abs(back - image) / np.maximum(1.0, image)).max() < 1e-6
