"""The contact sheet shows every picture where it belongs, over its name."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from halation.errors import OutputError, UsageError
from halation.media.comparison.contact_sheet import (
    make_caption,
    make_grid_sheet,
    make_grouped_sheet,
    make_sheet,
    show_any_light,
    show_data,
    show_light,
    show_over_checker,
    write_sheet,
)
from halation.resources.sandbox import UNRESTRICTED

COLORS = {"red": (0.8, 0.0, 0.0), "green_blue": (0.0, 0.7, 0.6), "white": (1.0, 1.0, 1.0)}
PICTURES = {name: np.full((40, 80, 3), color, np.float32) for name, color in COLORS.items()}
MARGIN, GAP, LABEL, HEAD = 16, 12, 30, 45
ROUND = slice(6, -6)


def inner(made: np.ndarray, left: int, top: int, width: int = 80, height: int = 40) -> np.ndarray:
    """A cell of the sheet without its round corners."""
    return made[top : top + height, left : left + width][ROUND, ROUND]


def test_pictures_fill_rows() -> None:
    made = make_sheet(PICTURES, columns=2)
    assert made.shape == (2 * (40 + LABEL + GAP) - GAP + 2 * MARGIN, 2 * (80 + GAP) - GAP + 2 * MARGIN, 3)
    for index, color in enumerate(COLORS.values()):
        top, left = MARGIN + index // 2 * (40 + LABEL + GAP), MARGIN + index % 2 * (80 + GAP)
        assert np.allclose(inner(made, left, top), color, atol=1e-5)
    assert np.ptp(made[-40:, -80:], axis=(0, 1)).max() == 0.0


def test_corners_are_round() -> None:
    made, back = make_sheet(PICTURES), make_sheet(PICTURES)[0, 0]
    cell = made[MARGIN : MARGIN + 40, MARGIN : MARGIN + 80]
    for corner in (cell[0, 0], cell[0, -1], cell[-1, 0], cell[-1, -1]):
        assert np.abs(corner - back).max() < 0.05
    for middle in (cell[0, 40], cell[-1, 40], cell[20, 0], cell[20, -1]):
        assert np.allclose(middle, COLORS["red"], atol=1e-5)


def test_names_are_written_below() -> None:
    made = make_sheet(PICTURES, columns=3)
    below = made[MARGIN + 40 :]
    for index in range(3):
        left = MARGIN + index * (80 + GAP)
        assert below[:, left : left + 80].max() > 0.3
    others = make_sheet({f"other {name}": one for name, one in PICTURES.items()}, columns=3)
    assert np.array_equal(made[: MARGIN + 40], others[: MARGIN + 40])
    assert not np.array_equal(made, others)


def test_a_long_name_stays_within_its_picture() -> None:
    made = make_sheet({"a quite long name": PICTURES["red"], "b": PICTURES["red"]}, columns=2)
    gap = made[MARGIN + 40 :, MARGIN + 82 : MARGIN + 80 + GAP]
    assert np.ptp(gap, axis=(0, 1)).max() == 0.0


def test_pictures_shrink_to_the_width() -> None:
    made = make_sheet(PICTURES, columns=3, width=40)
    assert made.shape[1] == 3 * (40 + GAP) - GAP + 2 * MARGIN
    assert np.allclose(inner(made, MARGIN, MARGIN, 40, 20), COLORS["red"], atol=1e-5)


def test_other_sizes_keep_their_scale_or_fit() -> None:
    """Half as large as the first is shown so, in the middle; twice as large fits."""
    small, large = np.ones((20, 40, 3), np.float32), np.ones((160, 160, 3), np.float32)
    made = make_sheet({"first": PICTURES["red"], "small": small, "large": large}, columns=3)
    for left, top, width, height in ((20, 10, 40, 20), (20, 0, 40, 40)):
        cell = made[MARGIN : MARGIN + 40, MARGIN + (1 + (height > 20)) * (80 + GAP) :][:, :80]
        assert np.allclose(cell[top : top + height, left : left + width], 1.0, atol=1e-4)
        assert cell[20, left - 2].max() < 0.1 > cell[20, left + width + 1].max()


def test_groups_have_headings_in_their_color_and_share_rows() -> None:
    """Four columns: two groups of two stand side by side, one of three below."""
    red = PICTURES["red"]
    groups = {"one": {"a": red, "b": red}, "three": dict.fromkeys("cde", red), "two": {"f": red, "g": red}}
    made = make_grouped_sheet(groups, columns=4, colors={"two": (0.0, 1.0, 0.0)})
    row = HEAD + 40 + LABEL + GAP
    assert made.shape[:2] == (2 * row - GAP + 2 * MARGIN, 4 * (80 + GAP) - GAP + 2 * MARGIN)
    across = [MARGIN + column * (80 + GAP) for column in range(4)]
    for left, top in [(left, MARGIN + HEAD) for left in across] + [(left, MARGIN + row + HEAD) for left in across[:3]]:
        assert np.allclose(inner(made, left, top), COLORS["red"], atol=1e-5)
    rule = MARGIN + HEAD - 15
    assert np.allclose(made[rule, across[2] : across[3] + 80], (0.0, 1.0, 0.0), atol=1e-5)
    assert made[rule, across[2] - 1].max() < 0.05
    assert all(made[MARGIN:rule, left : left + 60].max() > 0.5 for left in (across[0], across[2]))


def test_a_large_group_takes_several_rows() -> None:
    made = make_grouped_sheet(
        {"many": dict.fromkeys("abcde", PICTURES["red"]), "one": {"f": PICTURES["white"]}}, columns=2
    )
    row = 40 + LABEL + GAP
    for index in range(5):
        left, top = MARGIN + index % 2 * (80 + GAP), MARGIN + HEAD + index // 2 * row
        assert np.allclose(inner(made, left, top), COLORS["red"], atol=1e-5)
    assert np.allclose(inner(made, MARGIN, MARGIN + 2 * HEAD + 3 * row), 1.0, atol=1e-5)


def test_light_of_the_display_is_what_srgb_says() -> None:
    """Without a tone map, 0..1 comes out as it went in; brighter light ends at 1, premultiplied color is straight."""
    light = np.linspace(0.0, 1.0, 256, dtype=np.float32).repeat(4).reshape(16, 16, 4)
    light[..., 3] = 1.0
    assert np.abs(show_light(light, "none") - light[..., :3]).max() < 1e-3
    bright = np.array([[[7.0, 0.25, 0.0, 0.5]]], np.float32)
    assert np.allclose(show_light(bright, "none"), (1.0, 0.5, 0.0), atol=1e-3)


def test_squares_show_through_what_is_transparent() -> None:
    picture = np.zeros((24, 48, 4), np.float32)
    picture[:, 24:] = (0.25, 0.25, 0.25, 0.5)
    made = show_over_checker(picture, "none")
    dark, bright = made[0, 0, 0], made[0, 12, 0]
    assert 0.02 < dark < bright < 0.1 and made[12, 0, 0] == bright
    assert np.allclose(made[0, 24], 0.5 * 0.5 + 0.5 * dark, atol=1e-3)
    picture[..., :3], picture[..., 3] = 0.3, 0.0
    assert np.allclose(show_over_checker(picture, "none")[0, 0], 0.3 + dark, atol=1e-3)


def test_data_is_shown_within_its_range() -> None:
    """Codes of the display, not light; infinities and NaN do no harm."""
    data = np.array([[[-2.0], [0.0], [2.0], [np.nan], [np.inf]]], np.float32)
    assert np.allclose(show_data(data, -2.0, 2.0)[0, :, 1], (0.0, 0.214, 1.0, 0.214, 1.0), atol=1e-3)
    two = show_data(np.ones((1, 1, 2), np.float32), 0.0, 1.0)
    assert two.tolist() == [[[1.0, 1.0, 0.0]]]
    gray = show_any_light(np.full((1, 1, 1), 0.18, np.float32))
    assert np.ptp(gray) < 1e-3 and 0.05 < gray.mean() < 0.25


def test_numbers_are_written_over_the_picture() -> None:
    made = make_caption(np.full((90, 160, 3), 0.5, np.float32), ("average 0.5", "maximum 7"))
    assert np.allclose(made[:15], 0.03, atol=1e-3) and made[25:65].max() > 0.6
    middle = np.flatnonzero(made.max((0, 2)) > 0.1).mean()
    assert abs(middle - 80) < 6


def test_a_written_sheet_says_what_it_shows(tmp_path: Path) -> None:
    made, file = make_sheet(PICTURES), tmp_path / "sheet.jpg"
    write_sheet(file, made, "red, green", sandbox=UNRESTRICTED)
    there = cv2.imread(str(file))[..., ::-1]
    assert there.shape == made.shape and np.abs(there[MARGIN + 20, MARGIN + 40] - (231, 0, 0)).max() < 8
    assert b"red, green" in file.read_bytes()
    with pytest.raises(OutputError, match="no such folder"):
        write_sheet(tmp_path / "nowhere" / "sheet.jpg", made, sandbox=UNRESTRICTED)


def test_unknown_view() -> None:
    with pytest.raises(UsageError, match="there is no view 'sepia'"):
        show_light(PICTURES["red"], "sepia")


def find_ink(made: np.ndarray, other: np.ndarray) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of what two sheets do not have in common."""
    rows, columns = np.nonzero((made != other).any(axis=2))
    return int(columns.min()), int(rows.min()), int(columns.max()) + 1, int(rows.max()) + 1


def find_cell(made: np.ndarray, color: float) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of what has a gray that nothing else has."""
    rows, columns = np.nonzero((np.abs(made - color) < 1e-5).all(axis=2))
    return int(columns.min()), int(rows.min()), int(columns.max()) + 1, int(rows.max()) + 1


@pytest.mark.parametrize("title", ["", "How it looks"])
def test_a_grid_has_its_headings_beside_and_above_its_cells(title: str) -> None:
    grays = np.linspace(0.3, 0.9, 6).reshape(2, 3)
    rows = [[np.full((40, 80, 3), gray, np.float32) for gray in row] for row in grays]
    down, across = ("1", "much longer"), ("one", "two", "three")
    made = make_grid_sheet(rows, down, across, title=title)
    cells = {(y, x): find_cell(made, grays[y, x]) for y in range(2) for x in range(3)}
    left, top = cells[0, 0][:2]
    assert made.shape == (top + 2 * (40 + GAP) - GAP + MARGIN, left + 3 * (80 + GAP) - GAP + MARGIN, 3)
    for (y, x), cell in cells.items():
        at = left + x * (80 + GAP), top + y * (40 + GAP)
        assert cell == (*at, at[0] + 80, at[1] + 40)
    ink = find_ink(made, make_grid_sheet(rows, ("", down[1]), across, title=title))
    assert ink[0] > MARGIN and left - 2 * GAP < ink[2] <= left and abs((ink[1] + ink[3]) / 2 - (top + 20)) <= 4
    beside = made[top + 40 + GAP : -MARGIN, :left]
    assert np.ptp(beside, axis=(0, 1)).max() > 0.1 and np.ptp(beside[:, :MARGIN]) == np.ptp(beside[0, 0])
    for x in range(3):
        ink = find_ink(made, make_grid_sheet(rows, down, [*across[:x], "", *across[x + 1 :]], title=title))
        assert cells[0, x][0] <= ink[0] and ink[2] <= cells[0, x][2] and top - 24 <= ink[1] and ink[3] <= top - 8
    if title:
        ink = find_ink(made, make_grid_sheet(rows, down, across, title="."))
        above = made[:top, MARGIN:-MARGIN]
        (rule,) = np.nonzero((above == above[:, :1]).all(axis=(1, 2)) & (above[:, 0, 0] > 0.3))
        assert len(rule) == 2 and ink[0] >= MARGIN <= ink[1] and ink[3] + 4 < rule[0] and rule[-1] < top - 24
