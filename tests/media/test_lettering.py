"""Typesetting: the order of scripts against the bidi algorithm in Rust, lines, and fonts that are no good."""

from __future__ import annotations

import random
import subprocess
import sys
from itertools import pairwise

import bidi
import pytest
from halation.errors import HalationError, InputError
from halation.media.lettering.bidi_runs import find_levels, split_runs
from halation.media.lettering.fonts import FONTS, load_font
from halation.media.lettering.harfbuzz import hb
from halation.media.lettering.shaping import shape_run
from halation.media.lettering.typesetting import typeset
from halation.nodes import TextBlock, Typeface
from halation.resources.sandbox import UNRESTRICTED, Sandbox

DEJAVU = FONTS / "DejaVuSans.ttf"
WORDS = ("abc", "שלום", "(סגור)", "سلام", "123", "45.6", "x,y", "מ-1", "A&B", "«ع»", "[a (ב) c]", "ש (a) b")


def display(text: str, direction: str = "auto") -> str:
    """The letters of a line from left to right, unshaped and without the mirroring that HarfBuzz does."""
    _, levels = find_levels(text, direction)
    runs = split_runs(text, levels, 0, len(text))
    parts = (text[run.start : run.end][:: -1 if run.is_backward else 1] for run in runs)
    return "".join(parts)


@pytest.mark.parametrize("seed", range(40))
def test_lines_run_as_unicode_says(seed):
    """Two hundred words in two ways, against python-bidi's other implementation (unicode-bidi, in Rust)."""
    rng = random.Random(seed)
    text = " ".join(rng.choice(WORDS) for _ in range(rng.randint(1, 9)))
    for direction, base in (("left to right", "L"), ("right to left", "R")):
        assert display(text, direction) == bidi.get_display(text, base_dir=base), (text, direction)


def test_isolates_hold_words_together():
    text = "a \u2067ב (1)\u2069 b"
    _, levels = find_levels(text, "auto")
    assert levels[0] == levels[-1] == 0 and levels[3] == 1


def test_glyphs_of_a_run_are_those_of_harfbuzz():
    """The middle of a paragraph is shaped with what lies around it: letters join across the ends of a run."""
    font = load_font(Typeface(), UNRESTRICTED)
    text = "ab" + "سلام" + "cd"
    _, levels = find_levels(text, "auto")
    run = next(run for run in split_runs(text, levels, 0, len(text)) if run.is_backward)
    buffer = hb.Buffer()
    buffer.add_str("سلام")
    buffer.guess_segment_properties()
    hb.shape(font.font, buffer)
    glyphs = shape_run(text, run, font, 0.0)
    assert [glyph.glyph for glyph in glyphs] == [info.codepoint for info in buffer.glyph_infos]


def test_lines_fit_their_box():
    text = "The quick brown fox jumps over the lazy dog, and runs away. " * 3
    for width in (3.0, 8.0, 20.0):
        whole, wrapped = (typeset(TextBlock(text, width=w), UNRESTRICTED) for w in (0.0, width))
        rights = [place.x for place in wrapped.places]
        assert max(rights) < width and wrapped.width == width
        assert whole.line_count == 1 < wrapped.line_count
        assert len(wrapped.places) == len(whole.places)
        assert wrapped.line_count <= 2 * whole.width / width + 1
        assert wrapped.height == pytest.approx(whole.height + (wrapped.line_count - 1) * 1.2)


def test_long_words_break_and_empty_lines_stay():
    long = typeset(TextBlock("m" * 40, width=5.0), UNRESTRICTED)
    assert long.line_count > 5 and max(place.x for place in long.places) < 5.0
    assert typeset(TextBlock("a\n\nb"), UNRESTRICTED).line_count == 3
    assert typeset(TextBlock(""), UNRESTRICTED).places == ()


def test_alignment_and_tracking():
    block = TextBlock("ab\nabcd", align="right")
    right, loose = typeset(block, UNRESTRICTED), typeset(TextBlock("abcd", tracking=0.5), UNRESTRICTED)
    plain = typeset(TextBlock("abcd"), UNRESTRICTED)
    assert right.places[0].x == pytest.approx(right.width - typeset(TextBlock("ab"), UNRESTRICTED).width)
    assert loose.width == pytest.approx(plain.width + 3 * 0.5)
    steps = [b.x - a.x for a, b in pairwise(loose.places)]
    assert steps == pytest.approx([b.x - a.x + 0.5 for a, b in pairwise(plain.places)])
    assert typeset(TextBlock("fi", tracking=0.1), UNRESTRICTED).places[1:], "a ligature cannot be moved apart"


def test_missing_characters_are_named():
    assert typeset(TextBlock("aकb\u200dक漢"), UNRESTRICTED).missing == ("क", "漢")


def test_families_of_the_package_need_no_installation():
    names = [load_font(Typeface(family=name), UNRESTRICTED).name for name in ("", "dejavu  SANS", "DejaVu Sans Mono")]
    assert names == ["DejaVu Sans", "DejaVu Sans", "DejaVu Sans Mono"]
    with pytest.raises(InputError, match="no font family 'DejaVu Sanz' here: did you mean"):
        load_font(Typeface(family="DejaVu Sanz"), UNRESTRICTED)


def test_a_font_outside_of_the_root_is_refused(tmp_path):
    (tmp_path / "root").mkdir()
    font = tmp_path / "font.ttf"
    font.write_bytes(DEJAVU.read_bytes())
    with pytest.raises(InputError, match=r"font\.ttf"):
        load_font(Typeface(path=str(font)), Sandbox(tmp_path / "root"))


@pytest.mark.parametrize("seed", range(60))
def test_damaged_fonts_end_in_a_sentence(tmp_path, seed):
    """Cut off, or with wrong bytes in its head, its tables or anywhere: letters, or a sentence that names the file."""
    rng = random.Random(seed)
    content = bytearray(DEJAVU.read_bytes())
    if seed % 3 == 0:
        del content[rng.randrange(len(content)) :]
    else:
        reach = 400 if seed % 3 == 1 else len(content)
        for _ in range(rng.choice((1, 20, 2000))):
            content[rng.randrange(reach)] = rng.randrange(256)
    font = tmp_path / "damaged.ttf"
    font.write_bytes(content)
    try:
        text = typeset(TextBlock("AVe\u0301 fi سلام", Typeface(path=str(font))), UNRESTRICTED)
        assert all(abs(place.x) < 1e6 for place in text.places)
    except HalationError as fault:
        assert "damaged.ttf" in str(fault) or "too many curves" in str(fault)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "empty"),
        (b"wOF2" + bytes(100), "is a packed font for web pages"),
        (b"not a font at all", "is no font that can be read"),
    ],
)
def test_other_files_are_no_fonts(tmp_path, content, words):
    font = tmp_path / "f.ttf"
    font.write_bytes(content)
    with pytest.raises(InputError, match=f"f.ttf: .*{words}"):
        load_font(Typeface(path=str(font)), UNRESTRICTED)


ALONE = """
from halation.media.lettering.fonts import load_font
from halation.media.lettering.shaping import trace_glyph
from halation.nodes import Typeface
from halation.resources.sandbox import UNRESTRICTED
for weight in (400.0, 700.0):
    font = load_font(Typeface(weight=weight), UNRESTRICTED)
    print([trace_glyph(font, glyph) for glyph in range(200)])
"""
FOREIGN = """
import ctypes, OpenImageIO
OpenImageIO.ImageBufAlgo.text_size("abc")
try:
    ctypes.CDLL("libharfbuzz.so.0", mode=ctypes.RTLD_GLOBAL)
except OSError:
    raise SystemExit(77)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it")
def test_a_harfbuzz_of_the_system_changes_nothing():
    """Another library may load it for the whole process: then outlines were damaged, or the process ended."""
    alone, beside = (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        for code in (ALONE, FOREIGN + ALONE)
    )
    if beside.returncode == 77:
        pytest.skip("this system has no libharfbuzz")
    assert beside.returncode == 0, beside.stderr
    assert beside.stdout == alone.stdout and len(alone.stdout) > 10_000
