"""Text: letters against FreeType, glyphs and places against hb-shape, what lies around letters in closed form."""

from __future__ import annotations

import json
from pathlib import Path

import freetype
import numpy as np
import pytest
from freetype_letters import draw_letters
from halation.errors import HalationError
from halation.media.lettering.fonts import FONTS
from halation.media.lettering.typesetting import typeset
from halation.nodes import TextBlock
from halation.nodes.input.text import Text
from halation.resources.sandbox import UNRESTRICTED
from scipy import ndimage

DATA = Path(__file__).parents[1] / "data"
CASES = json.loads((DATA / "hb_shape.json").read_text(encoding="utf-8"))
DEJAVU = FONTS / "DejaVuSans.ttf"
LEAST = 1.0 / 255.0
ASCENT = 1901 / 2048


def matte(run, text: Text, size: tuple[int, int], **options) -> np.ndarray:
    """The coverage of a text."""
    return run(text, size=size, output="matte", **options)[..., 0]


def find_font(name: str) -> Path:
    return DEJAVU if name == DEJAVU.name else DATA / name


@pytest.mark.parametrize("name", CASES)
def test_lines_are_those_of_harfbuzz_and_freetype(run, name):
    """Shaped by the program hb-shape, drawn by FreeType: the whole picture, in scripts that join and reorder."""
    case, size, em = CASES[name], (240, 64), 36.0
    font = find_font(case["font"])
    upem, x, glyphs = 2048 if font == DEJAVU else 1000, 5.3, []
    for number, _, across, up, advance in case["glyphs"]:
        glyphs.append((number, x + across / upem * em, 44.6 - up / upem * em))
        x += advance / upem * em
    node = Text(
        text=case["text"], font="" if font == DEJAVU else str(font), size=em / size[1], align="left",
        vertical="baseline", anchor=(5.3 / size[0], 44.6 / size[1]),
    )  # fmt: skip
    drawn = matte(run, node, size)
    np.testing.assert_allclose(drawn, draw_letters(font, glyphs, em, size), atol=LEAST)
    assert drawn.sum() > 200.0


@pytest.mark.parametrize("em", [7.0, 19.5, 90.0, 400.0])
def test_letters_are_exact_at_every_size(run, em):
    size = (int(em * 1.3), int(em * 1.4))
    face = typeset(TextBlock("&"), UNRESTRICTED)
    node = Text(text="&", size=em / size[1], align="left", vertical="baseline", anchor=(0.1, 0.8))
    glyph = [(9, 0.1 * size[0], 0.8 * size[1])]
    np.testing.assert_allclose(matte(run, node, size), draw_letters(DEJAVU, glyph, em, size), atol=LEAST)
    assert face.font == "DejaVu Sans"


def test_proxy_is_as_crisp_as_a_small_picture(run):
    node = Text(text="Proxy", size=0.3)
    np.testing.assert_allclose(matte(run, node, (160, 90), scale=0.5), matte(run, node, (80, 45)), atol=1e-6)


@pytest.mark.parametrize(("align", "place"), [("left", 0.1), ("center", 0.5), ("right", 0.9)])
def test_text_that_is_too_wide_is_drawn_smaller(run, align, place):
    """As at the size at which FreeType's advances, of letters without kerning, take 0.6 of the width."""
    size, word = (200, 320), "minimum\nhum"
    face = freetype.Face(str(DEJAVU))
    face.set_char_size(face.units_per_EM * 64)
    flags = freetype.FT_LOAD_NO_HINTING
    lines = [sum(face.get_advance(face.get_char_index(letter), flags) for letter in line) for line in word.split("\n")]
    em = 0.6 * size[0] / (max(lines) / 65536.0 / face.units_per_EM)
    node = Text(text=word, size=0.2, fit_width=0.6, align=align, anchor=(place, 0.5))
    sized = Text(text=word, size=em / size[1], align=align, anchor=(place, 0.5))
    np.testing.assert_allclose(matte(run, node, size), matte(run, sized, size), atol=2e-3)
    short = Text(text="ok", size=0.1, fit_width=0.6)
    np.testing.assert_array_equal(matte(run, short, size), matte(run, Text(text="ok", size=0.1), size))


def test_text_lies_over_the_picture(run):
    below = np.full((48, 96, 4), (0.2, 0.4, 0.6, 1.0), np.float32)
    node = Text(text="Over", size=0.4, color=(0.5, 0.0, 0.0, 0.5))
    cover = matte(run, node, (96, 48))[..., None]
    expected = np.array(node.color) * cover + below * (1.0 - 0.5 * cover)
    np.testing.assert_allclose(run(node, {"image": below}), expected, atol=1e-6)


def test_rotation_and_alignment(run):
    """A quarter turn of the text is a quarter turn of the picture; right is left, mirrored at the anchor's margin."""
    level = matte(run, Text(text="Turn", size=0.25), (96, 96))
    turned = matte(run, Text(text="Turn", size=0.25, rotation=90.0), (96, 96))
    np.testing.assert_allclose(turned, np.rot90(level, -1), atol=1e-5)
    across = typeset(TextBlock("rig"), UNRESTRICTED).width * 0.4 * 64 / 96
    left = matte(run, Text(text="rig", size=0.4, align="left", anchor=(0.9 - across, 0.5)), (96, 64))
    right = matte(run, Text(text="rig", size=0.4, align="right", anchor=(0.9, 0.5)), (96, 64))
    np.testing.assert_allclose(right, left, atol=1e-4)


def test_outline_is_as_wide_as_it_says(run):
    node = Text(text="O", size=0.7, outline_width=0.05, outline_color=(0.0, 0.0, 0.0, 1.0))
    drawn = run(node, size=(96, 96))[..., 3]
    large = matte(run, Text(text="O", size=0.7), (96 * 8, 96 * 8)) >= 0.5
    grown = ndimage.distance_transform_edt(~large) <= 0.05 * 96 * 8
    expected = grown.reshape(96, 8, 96, 8).mean((1, 3))
    assert np.abs(drawn - expected).max() < 0.13
    assert np.abs(drawn - expected).mean() < 2e-3


def test_shadow_is_the_text_moved_and_blurred(run):
    node = Text(
        text="Sh",
        size=0.4,
        shadow_offset=(0.125, 0.0625),
        shadow_blur=0.03,
        shadow_color=(0, 0, 0, 0.5),
        color=(0,) * 4,
    )  # fmt: skip
    cover = matte(run, node, (96, 64))
    moved = ndimage.shift(cover, (4.0, 8.0), order=1)
    expected = 0.5 * ndimage.gaussian_filter(moved, 0.03 * 64, mode="constant", truncate=6.0)
    np.testing.assert_allclose(run(node, size=(96, 64))[..., 3], expected, atol=2e-3)


def test_weights(run):
    covers = [matte(run, Text(text="nnn", size=0.5, weight=weight), (128, 64)).sum() for weight in (200, 400, 700, 900)]
    assert covers == sorted(covers) and covers[2] > covers[1] * 1.3


@pytest.mark.parametrize("weight", [100.0, 370.0, 900.0])
@pytest.mark.parametrize("em", [21.0, 120.0])
def test_contours_of_a_variable_font_may_overlap(run, em, weight):
    """Without seams where they do. FreeType leaves some, of one of its pixels: 32 of them are one of ours."""
    font, size = DATA / "overlapping_variable.ttf", (int(em), int(1.2 * em))
    node = Text(
        text="H", font=str(font), weight=weight, size=em / size[1], align="left", vertical="baseline",
        anchor=(0.1, 0.9),
    )  # fmt: skip
    drawn = matte(run, node, size)
    reference = draw_letters(font, [(1, 0.1 * size[0], 0.9 * size[1])], em, size, weight)
    np.testing.assert_allclose(drawn, reference, atol=LEAST)
    assert reference.sum() > 0.1 * em**2


def test_faults_are_sentences(run, tmp_path):
    broken = tmp_path / "broken.ttf"
    broken.write_bytes(DEJAVU.read_bytes()[:3000])
    for node, words in (
        (Text(font=str(broken)), "broken.ttf"),
        (Text(font=str(tmp_path / "none.otf")), "there is no such file"),
        (Text(family="Nobody Has This"), "there is no font family 'Nobody Has This'"),
        (Text(text="{nothing}"), "node 'node': the text has the token '{nothing}'"),
        (Text(text="{"), "write {{ for a brace"),
        (Text(text="a" * 20_001), "20,001 characters"),
    ):
        with pytest.raises(HalationError, match=words.replace("{", r"\{").replace("(", r"\(")) as caught:
            run(node, size=(16, 16))
        assert caught.value.node
