"""What one pass draws together: strokes that do not read each other, letters and boxes that do not meet."""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.nodes import PaintTool
from halation.nodes.filter import paint
from halation.nodes.filter._brush_paths import boxes_meet, find_patch, grow_box
from halation.nodes.input import text

NEAR, FAR = (0.0, 0.0, 10.0, 10.0), (50.0, 50.0, 60.0, 60.0)


def trace(tool: PaintTool = PaintTool.BRUSH, **facts: Any) -> Any:
    """A stroke near the left top corner that reads nothing but its own pixel."""
    path = SimpleNamespace(channel_count=facts.pop("channels", 1), box=facts.pop("box", NEAR))
    return SimpleNamespace(
        stroke=SimpleNamespace(tool=tool), path=path, **({"copied": "", "sigma": 0.0, "read": None} | facts)
    )


def run(*traces: Any, left: int = 64) -> Any:
    made = paint._Run(traces[0], left)  # pyright: ignore[reportPrivateUsage]
    for other in traces[1:]:
        made.add(other)
    return made


CLONE, REVEAL = trace(PaintTool.CLONE, copied="picture"), trace(PaintTool.REVEAL, copied="first")
BLUR, WIDER = trace(PaintTool.BLUR, sigma=2.0), trace(PaintTool.BLUR, sigma=3.0)


@pytest.mark.parametrize(
    ("before", "after", "is_taken"),
    [
        ((trace(),), trace(), True), ((trace(),), CLONE, True), ((CLONE,), trace(), True), ((CLONE,), CLONE, True),
        ((CLONE,), REVEAL, False), ((trace(), CLONE), REVEAL, False), ((CLONE, trace()), REVEAL, False),
        ((trace(),), BLUR, True), ((BLUR,), trace(), True), ((BLUR,), BLUR, True), ((BLUR,), WIDER, False),
        ((trace(), BLUR), WIDER, False), ((BLUR,), CLONE, True), ((trace(PaintTool.SMEAR),), trace(), False),
        ((trace(),), trace(PaintTool.SMEAR), False), ((trace(),), trace(read=NEAR), False),
        ((trace(),), trace(read=FAR), True), ((trace(box=FAR), trace()), trace(read=FAR), False),
        ((trace(read=FAR),), trace(), True),
    ],
)  # fmt: skip
def test_strokes_share_a_pass_that_copy_the_same_and_read_nothing_of_each_other(
    before: Any, after: Any, is_taken: bool
) -> None:
    assert run(*before).takes(after) is is_taken


def test_a_pass_has_room_for_some_strokes_and_channels() -> None:
    most = paint._MOST_CHANNELS  # pyright: ignore[reportPrivateUsage]
    assert run(trace(channels=most - 2)).takes(trace(channels=2))
    assert not run(trace(channels=most - 2)).takes(trace(channels=3))
    assert not run(trace(channels=most - 2), trace(channels=1)).takes(trace(channels=2))


@pytest.mark.parametrize("left", [1, 31, 63, 64, 65, 127, 128, 200, 256, 300])
def test_programs_are_for_few_or_for_powers_of_two(left: int) -> None:
    """A program for 64 strokes draws the first 64 of 80, and one for 32 the rest: so there are few programs."""
    made, count = run(trace(), left=left), 1
    while made.takes(trace()):
        made.add(trace())
        count += 1
    few, most = paint._FEW_STROKES, paint._MOST_STROKES  # pyright: ignore[reportPrivateUsage]
    assert count == max(few, max(power for power in (1, 2, 4, 8, 16, 32, 64, 128, 256) if power <= min(left, most)))


def test_boxes_meet_where_they_have_a_place_in_common() -> None:
    def shares(first: range, second: range) -> bool:
        return bool({*first} & {*second})

    spans = [(0, 2), (1, 3), (2, 4), (3, 5)]
    for (ax, ay), (bx, by) in product(product(spans, spans), repeat=2):
        first, second = (ax[0], ay[0], ax[1], ay[1]), (bx[0], by[0], bx[1], by[1])
        expected = shares(range(ax[0], ax[1] + 1), range(bx[0], bx[1] + 1)) and shares(
            range(ay[0], ay[1] + 1), range(by[0], by[1] + 1)
        )
        assert boxes_meet(first, second) is expected
        overlap = min(ax[1], bx[1]) > max(ax[0], bx[0]) and min(ay[1], by[1]) > max(ay[0], by[0])
        letter: Any = SimpleNamespace(box=first)
        others: Any = [SimpleNamespace(box=(90, 90, 95, 95)), SimpleNamespace(box=second)]
        assert text._meets_any(letter, others) is overlap, "letters that touch may be drawn together"  # pyright: ignore
    assert grow_box((1.0, 2.0, 3.0, 4.0), 0.5, 0.25) == (0.5, 1.75, 3.5, 4.25)


@pytest.mark.parametrize("overscan", [0, 7])
@pytest.mark.parametrize("seed", range(30))
def test_a_patch_holds_what_the_strokes_reach_of_the_picture(seed: int, overscan: int) -> None:
    """Every pixel of the picture and its overscan that a box touches, and none beyond; None if there is none."""
    chance, size = np.random.default_rng(seed), (300, 200) if seed % 2 else (256, 128)
    corner = chance.integers((-400, -300), (600, 500), (2, 2))
    if seed % 4 == 0:  # beside the picture, where steps and its edge meet
        axis = int(chance.integers(2))
        corner[:, axis] = size[axis] + chance.integers(0, 40, 2)
    boxes = [(*at, *(at + chance.integers(1, 150, 2))) for at in corner.astype(float)]
    whole = np.zeros((1200, 1600), bool)  # from (-600, -400)
    for x0, y0, x1, y1 in boxes:
        whole[int(y0) + 400 : int(y1) + 400, int(x0) + 600 : int(x1) + 600] = True
    picture = np.zeros_like(whole)
    picture[400 - overscan : 400 + size[1] + overscan, 600 - overscan : 600 + size[0] + overscan] = True
    paths: Any = [SimpleNamespace(box=box) for box in boxes]
    patch = find_patch(paths, size, overscan)
    held = np.zeros_like(whole)
    if patch is not None:
        (x, y), (width, height) = patch.origin, patch.size
        held[y + 400 : y + 400 + height, x + 600 : x + 600 + width] = True
    assert not (held & ~picture).any() and not (whole & picture & ~held).any()
    assert patch is None or (patch.size[0] > 0 and patch.size[1] > 0)
