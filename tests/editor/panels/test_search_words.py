"""The search of the canvas knows what other programs call things."""

from __future__ import annotations

import pytest
from halation.authoring.library import PresetLibrary
from halation.editor.shared.entries import (
    GROUP,
    CatalogEntry,
    arrange_entries,
    code_entries,
    graph_entries,
    mode_entries,
    node_entries,
    preset_entries,
    rank_entries,
)
from halation.nodes import catalogue
from halation.reference.program_words import MENU_WORDS

ENTRIES = (
    *node_entries(catalogue()),
    *mode_entries(catalogue()),
    *code_entries(),
    *preset_entries(PresetLibrary().list_presets()),
    *graph_entries(),
)


COMMON_NAMES = {
    "write": "output:Image", "save": "output:Image", "export": "output:Image", "switch": "select", "select": "select",
    "expression": "pixel_formula", "vector math": "vector_math", "map range": "map_range", "remap": "map_range",
    "clamp": "clip", "hue curves": "hue_curves", "hue vs hue": "hue_curves", "color balance": "color_balance",
    "lift gamma gain": "color_balance", "color wheels": "color_balance", "histogram": "histogram",
    "z merge": "depth_merge", "z combine": "depth_merge", "light groups": "light_groups",
    "light mixer": "light_groups", "palette": "color_palette", "quantize": "color_palette", "brick": "brick",
    "wave": "wave", "gabor": "gabor_noise", "height to normal": "height_to_normal", "bump": "height_to_normal",
    "sharpen": "sharpen", "unsharp mask": "sharpen", "upscale": "upscale", "super resolution": "upscale",
    "stereo": "stereo", "anaglyph": "stereo", "corner pin": "corner_pin", "screen replacement": "corner_pin",
    "grid warp": "grid_warp", "mesh warp": "grid_warp", "morph": "spline_warp",
    "blendmat": "mix_images", "textblock": "text", "ifelse": "select", "inside edge": "edge_matte",
    "outside edge": "edge_matte", "rgb key": "chroma_key", "luma level": "levels", "hsv adjust": "hue_saturation",
    "slope": "height_to_normal", "movie file in": "read_image", "movie file out": "output:Image",
    "cc power pin": "corner_pin", "levels (individual controls)": "levels", "vr sphere to plane": "panorama",
    "truelight": "lut_file", "blocky": "pixelate", "psd merge": "merge", "rolling guidance": "bilateral_blur",
    "replace color": "chroma_key", "ranges mask": "luma_key", "triangles mask": "shape", "paint mask": "paint",
    "write-on": "paint", "scribble": "paint", "vegas": "outline", "remove grain": "denoise", "noise alpha": "noise",
    "gradient wipe": "mix_images", "linear wipe": "mix_images", "block dissolve": "mix_images",
    "change to color": "hue_curves", "refine hard matte": "feather", "key cleaner": "keyer",
    "time machine": "time_offset", "latlong patcher": "panorama", "planar transform": "corner_pin",
    "track position": "transform", "tracker": "transform", "degrain": "denoise", "varied blur": "variable_blur",
    "coordinate space": "polar", "beam": "shape", "eyedropper fill": "constant", "cc halftone": "halftone",
    "warp stabilizer": "transform", "transform masked": "transform", "charcoal": "crosshatch",
}  # fmt: skip
"""What somebody types who wants a node, in the words of the trade."""


def describe(entry: CatalogEntry) -> str:
    return f"{entry.id}:{entry.title}" if entry.values else entry.id


@pytest.mark.parametrize(("program", "word", "wanted"), MENU_WORDS)
def test_a_word_of_a_menu_finds_its_node_among_the_first_three(program: str, word: str, wanted: str) -> None:
    first = [describe(entry) for entry in rank_entries(ENTRIES, word)[:3]]
    targets = [wanted] if ":" in wanted else wanted.split()
    assert set(first) & set(targets), f"{program}: {word} finds {first}, not {wanted}"


@pytest.mark.parametrize(("word", "wanted"), COMMON_NAMES.items())
def test_a_common_name_finds_its_node_among_the_first_three(word: str, wanted: str) -> None:
    first = [entry.id for entry in rank_entries(ENTRIES, word)[:3]]
    assert wanted in first, f"{word} finds {first}"


def test_there_are_two_hundred_words() -> None:
    assert len(MENU_WORDS) >= 200


@pytest.mark.parametrize("id", list(catalogue()))
def test_every_title_finds_its_node_first(id: str) -> None:
    assert rank_entries(ENTRIES, catalogue()[id].title)[0].id == id


def test_nodes_come_before_presets() -> None:
    for word in ("halation", "glow", "toon", "light", "night"):
        groups = [entry.category == GROUP for entry in rank_entries(ENTRIES, word)[:3]]
        assert groups == sorted(groups) and not groups[0], word


@pytest.mark.parametrize("words", ["ready graph", "added as a group", "where it enters", "a preset"])
def test_sentences_that_all_entries_share_are_not_searched(words: str) -> None:
    assert not [entry.title for entry in rank_entries(ENTRIES, words) if entry.category == GROUP]


def test_every_merge_mode_is_an_entry_of_its_own() -> None:
    for mode in catalogue()["merge"].values["mode"].choices:
        first = rank_entries(ENTRIES, f"merge {mode}")[0]
        assert (first.id, dict(first.values)) == ("merge", {"mode": mode})


def test_modes_are_listed_by_a_search_alone() -> None:
    listed = [entry for section in arrange_entries(ENTRIES, "") for entry in section.entries]
    assert not [entry for entry in listed if entry.values]
    assert [entry.id for entry in listed].count("merge") == 1
