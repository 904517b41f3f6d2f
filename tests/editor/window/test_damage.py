"""Changed rectangles of the window, compared with a rasterizer that knows nothing of them."""

from __future__ import annotations

import numpy as np
import pytest
from halation.editor.window.damage import (
    COMMAND,
    MANY,
    are_mostly_new,
    find_boxes,
    find_changed_boxes,
    find_covers,
    find_extent,
    find_last_cover,
    find_picture_boxes,
    make_rows,
    merge_boxes,
    surround,
)

SIZE = (64, 48)


def find_changes(before: np.ndarray, after: np.ndarray) -> list[tuple[int, int, int, int]]:
    """The boxes in which two lists of rows may draw other pixels."""
    return find_changed_boxes(before, after, find_boxes(before), find_boxes(after))


def make_vertices(rects: list[tuple[int, int, int, int, int]]) -> np.ndarray:
    """The corners of rectangles."""
    corners = [((x, y), (x + w, y), (x + w, y + h), (x, y + h)) for x, y, w, h, _ in rects]
    vertices = np.zeros((4 * len(rects), 5), np.uint32)
    vertices[:, :2] = np.array(corners, np.float32).reshape(-1, 2).view(np.uint32)
    vertices[:, 4] = np.repeat([rect[4] for rect in rects], 4)
    return vertices


def make_list(rects: list[tuple[int, int, int, int, int]], clips: list[tuple[int, int, int, int]], texture: int = 7):
    """Rectangles of one color each, as the interface library has them: a command for each clip."""
    vertices = make_vertices(rects)
    indices = np.concatenate([np.array((0, 1, 2, 0, 2, 3)) + 4 * n for n in range(len(rects))]).astype(np.uint32)
    commands = np.zeros(len(clips), COMMAND)
    share = len(rects) // len(clips)
    for number, clip in enumerate(clips):
        last = number == len(clips) - 1
        commands[number] = (clip, 0, texture + number, 0, 6 * share * number, 0, 0)
        commands[number]["count"] = len(indices) - 6 * share * number if last else 6 * share
    return commands, make_rows(vertices, indices, commands)


def draw(rects, clips) -> np.ndarray:
    """The same rectangles, one above the other."""
    pixels = np.zeros((SIZE[1], SIZE[0]), np.uint32)
    share = len(rects) // len(clips)
    for number, (x, y, width, height, color) in enumerate(rects):
        left, top, right, bottom = clips[min(number // share, len(clips) - 1)]
        low_x, low_y, high_x, high_y = max(x, left), max(y, top), min(x + width, right), min(y + height, bottom)
        if low_x < high_x and low_y < high_y:
            pixels[low_y:high_y, low_x:high_x] = color
    return pixels


def choose(random: np.random.Generator) -> tuple[int, int, int, int, int]:
    """A rectangle in the window."""
    x, y = random.integers(0, SIZE[0] - 4), random.integers(0, SIZE[1] - 4)
    return int(x), int(y), int(random.integers(1, 16)), int(random.integers(1, 16)), int(random.integers(1, 2**32))


@pytest.mark.parametrize("seed", range(60))
def test_no_pixel_outside_of_the_boxes_differs(seed: int) -> None:
    random = np.random.default_rng(seed)
    before = [choose(random) for _ in range(40)]
    after, clips = list(before), [(0, 0, 40, 48), (8, 0, 64, 40)]
    new_clips = list(clips)
    for _ in range(int(random.integers(1, 4))):
        place = int(random.integers(0, len(after)))
        match int(random.integers(0, 5)):
            case 0:
                after[place] = choose(random)
            case 1:
                after.insert(place, choose(random))
            case 2:
                del after[place]
            case 3:
                after[place] = (*after[place][:4], 5)
            case _:
                new_clips[1] = (8, 0, 50, 44)
    boxes = find_changes(make_list(before, clips)[1], make_list(after, new_clips)[1])
    outside = np.ones((SIZE[1], SIZE[0]), bool)
    for left, top, right, bottom in boxes:
        outside[max(top, 0) : bottom, max(left, 0) : right] = False
    assert not (draw(before, clips) != draw(after, new_clips))[outside].any()
    merged = merge_boxes(boxes, (0, 0, *SIZE))
    covered = np.zeros((SIZE[1], SIZE[0]), int)
    for left, top, right, bottom in merged:
        covered[top:bottom, left:right] += 1
    assert covered.max(initial=0) <= 1 and (covered[~outside] == 1).all(), "merged boxes cover all, and each pixel once"


@pytest.mark.parametrize("seed", range(6))
def test_a_panned_list_differs_only_within_both_extents(seed: int) -> None:
    random = np.random.default_rng(seed)
    rects, clips = [choose(random) for _ in range(MANY // 4)], [(5, 7, 50, 40), (9, 3, 44, 45)]
    moved = [(x + 2, y + 1, *rest) for x, y, *rest in rects]
    lists = make_vertices(rects), make_vertices(moved)
    assert are_mostly_new(*lists)

    (left, top, right, bottom), *others = merge_boxes(
        [box for points in lists for box in surround(find_extent(points, make_list(rects, clips)[0]))], (0, 0, *SIZE)
    )

    assert not others and (left, top, right, bottom) == (5, 3, 50, 45)
    before, after = draw(rects, clips), draw(moved, clips)
    before[top:bottom, left:right] = after[top:bottom, left:right]
    assert (before == after).all()


def test_what_comes_between_vertices_that_stay_leaves_most_as_they_were() -> None:
    random = np.random.default_rng(1)
    rects = [choose(random) for _ in range(MANY // 4)]
    points, new = make_vertices(rects), [(1, 1, 3, 3, 9)]
    assert not are_mostly_new(points, points)
    for place in (0, len(rects) // 4, len(rects)):
        longer = make_vertices([*rects[:place], *new, *rects[place:]])
        assert not are_mostly_new(points, longer) and not are_mostly_new(longer, points)


def test_small_lists_are_always_compared_by_their_triangles() -> None:
    rects = [choose(np.random.default_rng(2)) for _ in range(MANY // 4 - 1)]
    assert not are_mostly_new(make_vertices(rects), make_vertices([(x + 1, *rest) for x, *rest in rects]))


def test_an_extent_is_that_of_the_vertices_within_the_clips() -> None:
    points, (commands, _) = make_vertices([(20, 10, 4, 5, 1)]), make_list([(20, 10, 4, 5, 1)], [(0, 0, 22, 48)])
    assert surround(find_extent(points, commands)) == [(20, 10, 22, 15)]
    points[0, :2] = np.array([np.nan, np.inf], np.float32).view(np.uint32)  # the others are its other three corners
    assert surround(find_extent(points, commands)) == [(20, 10, 22, 48)]
    assert not surround(find_extent(points[:0], commands[:0]))


@pytest.mark.parametrize("box", [(5.0, 5.0, 5.0, 9.0), (5.0, 9.0, 8.0, 9.0), (9.0, 5.0, 5.0, 9.0)])
def test_what_has_no_width_or_no_height_draws_nothing(box: tuple[float, ...]) -> None:
    drawn = (1.2, 2.0, 3.0, 4.5)
    assert surround(np.array([box], np.float32)) == []
    assert surround(np.array([box, drawn], np.float32)) == [(1, 2, 3, 5)]


def test_equal_lists_have_no_box() -> None:
    random = np.random.default_rng(0)
    rects = [choose(random) for _ in range(40)]
    rows = make_list(rects, [(0, 0, 64, 48)])[1]
    assert find_changes(rows, rows.copy()) == []
    empty = make_rows(np.empty((0, 5), np.uint32), np.empty(0, np.uint32), np.empty(0, COMMAND))
    assert find_changes(empty, empty) == []
    assert find_changes(empty, rows) == find_changes(rows, empty) != []


def test_a_picture_has_the_box_of_its_texture() -> None:
    commands, rows = make_list([(1, 2, 8, 4, 1), (20, 10, 10, 10, 1)], [(0, 0, 64, 48), (0, 0, 25, 48)])
    assert find_picture_boxes(commands, find_boxes(rows), {8}) == [(20, 10, 25, 20)]
    assert find_picture_boxes(commands, find_boxes(rows), {7, 8}) == [(1, 2, 9, 6), (20, 10, 25, 20)]
    assert find_picture_boxes(commands, find_boxes(rows), {3}) == []


def test_far_boxes_stay_apart() -> None:
    near, far = (10, 10, 60, 60), (1500, 900, 1560, 960)
    assert merge_boxes([near, far], (0, 0, 1920, 1080)) == [near, far]
    assert merge_boxes([near, (40, 40, 80, 80)], (0, 0, 1920, 1080)) == [(10, 10, 80, 80)]
    assert merge_boxes([(-5, -5, 0, 0), (1900, 1000, 2000, 1200)], (0, 0, 1920, 1080)) == [(1900, 1000, 1920, 1080)]


@pytest.mark.parametrize("seed", range(40))
def test_nothing_below_a_cover_is_seen(seed: int) -> None:
    random = np.random.default_rng(seed)
    rects = [choose(random) for _ in range(30)]
    for place in (5, 12):  # opaque ones among others that let something through, some of them clipped
        rects.insert(place, (0, 0, 50, 44, 0xFF000000 + place))
    rects.insert(20, (0, 0, 60, 48, 0x7F000000))
    clips = [(0, 0, 64, 48), (int(random.integers(0, 12)), 0, 64, 48)]
    rows = make_list(rects, clips)[1]
    rows[:, 19] = 1  # the texture of the interface itself, which is opaque where rectangles read it
    box = (10, 6, 30, 20)
    cover = find_last_cover(find_covers(rows), box)
    assert cover is not None and cover % 2 == 0
    part = np.s_[box[1] : box[3], box[0] : box[2]]
    left = [rect if number >= cover // 2 else (0, 0, 0, 0, 0) for number, rect in enumerate(rects)]
    assert (draw(rects, clips)[part] == draw(left, clips)[part]).all()
    assert find_last_cover(find_covers(rows), (0, 0, 64, 48)) is None
    rows[:, 19] = 0  # pictures may let through what is below
    assert find_last_cover(find_covers(rows), box) is None
