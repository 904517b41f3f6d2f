"""Words for the numbers of ITU-T H.273 in a video, against the names that FFmpeg has for them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from halation.media.video.facts import describe_video_attributes, find_kept_tags
from halation.media.video.index import VideoInfo

reformatter: Any = pytest.importorskip(
    "av.video.reformatter", reason="PyAV is not installed: pip install halation[video]"
)
MATRICES = {"ITU709": "BT.709", "FCC": "FCC", "ITU601": "BT.601", "SMPTE240M": "SMPTE 240M", "BT2020": "BT.2020"}
TRANSFERS = {
    "BT709": "BT.709",
    "GAMMA22": "gamma 2.2",
    "GAMMA28": "gamma 2.8",
    "SMPTE170M": "BT.601",
    "LINEAR": "linear",
    "IEC61966_2_1": "sRGB",
    "BT2020_10": "BT.2020",
    "BT2020_12": "BT.2020",
    "SMPTE2084": "PQ",
    "ARIB_STD_B67": "HLG",
}
PRIMARIES = {
    "BT709": "BT.709",
    "BT470BG": "BT.601, 625 lines",
    "SMPTE170M": "BT.601, 525 lines",
    "BT2020": "BT.2020",
    "SMPTE431": "DCI P3",
    "SMPTE432": "Display P3",
}


def describe(pixels: str = "yuv420p", size: tuple[int, int] = (1920, 1080), **numbers: int) -> dict[str, object]:
    color = {"matrix": 2, "range": 0, "transfer": 2, "primaries": 2, **numbers}
    facts = VideoInfo(
        "a.mkv", size, 50, Fraction(25), "matroska", "ffv1", pixels, 8, False, **color, tags={}
    )  # fmt: skip
    return dict(describe_video_attributes(facts))


@pytest.mark.parametrize("name", MATRICES)
def test_matrices_have_the_names_of_their_standards(name: str) -> None:
    assert describe(matrix=int(reformatter.Colorspace[name]))["video:matrix"] == MATRICES[name]


@pytest.mark.parametrize("name", TRANSFERS)
def test_transfers_have_the_names_of_their_standards(name: str) -> None:
    assert describe(transfer=int(reformatter.ColorTrc[name]))["video:transfer"] == TRANSFERS[name]


@pytest.mark.parametrize("name", PRIMARIES)
def test_primaries_have_the_names_of_their_standards(name: str) -> None:
    assert describe(primaries=int(reformatter.ColorPrimaries[name]))["video:primaries"] == PRIMARIES[name]


def test_what_a_file_does_not_say_is_what_is_taken_for_it() -> None:
    said = describe()
    assert (said["video:matrix"], said["video:range"]) == ("BT.709 (not said)", "limited")
    assert (said["video:transfer"], said["video:primaries"]) == ("sRGB (not said)", "BT.709 (not said)")
    assert describe(size=(720, 576))["video:matrix"] == "BT.601 (not said)"
    assert describe(transfer=0)["video:transfer"] == "sRGB (not said)"
    assert describe(transfer=int(reformatter.ColorTrc["LOG"]))["video:transfer"] == "unknown"
    assert (said["video:frames"], said["video:rate"], said["video:seconds"]) == (50, 25.0, 2.0)


@pytest.mark.parametrize(
    ("pixels", "number", "matrix", "spread"),
    [
        ("yuv420p", 0, "BT.709", "limited"),
        ("yuv420p", 1, "BT.709", "limited"),
        ("yuv420p", 2, "BT.709", "full"),
        ("yuvj420p", 1, "BT.709", "full"),
        ("nv12", 1, "BT.709", "limited"),
        ("p010le", 1, "BT.709", "limited"),
        ("uyvy422", 1, "BT.709", "limited"),
        ("gbrp", 0, "RGB", "full"),
        ("rgb24", 1, "RGB", "full"),
    ],
)
def test_rgb_has_no_matrix_and_the_full_range(pixels: str, number: int, matrix: str, spread: str) -> None:
    said = describe(pixels, matrix=1, range=number)
    assert (said["video:matrix"], said["video:range"]) == (matrix, spread)


def test_tags_about_the_file_are_not_kept() -> None:
    tags = {"title": "night", "Encoder": "x", "creation_time": "now", "artist": "me"}
    facts = VideoInfo("a.mkv", (8, 8), 1, Fraction(25), "mov", "ffv1", "gbrp", 8, False, 0, 0, 0, 0, tags)
    assert find_kept_tags(facts) == {"title": "night", "artist": "me"}
