"""Which outlines a tile lists, against all of them one after the other, in masks from 0 to 1.

The reference is a formula of layers written as mixtures: an outline's own effect, mixed in by its opacity.
"""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from halation.compiler.lowering.outline_tables import _combine_levels

MASKS = np.linspace(0.0, 1.0, 9)
MODES = "union", "subtract", "intersect", "max", "min", "difference", "plus"


def combine(below: np.ndarray, level: float, fill: SimpleNamespace) -> np.ndarray:
    """A mask with one more outline of this coverage."""
    cover, opacity = (1.0 - level if fill.invert else level), fill.opacity
    match fill.mode:
        case "union":
            return (1.0 - opacity) * below + opacity * (1.0 - (1.0 - below) * (1.0 - cover))
        case "subtract":
            return (1.0 - opacity) * below + opacity * below * (1.0 - cover)
        case "intersect":
            return (1.0 - opacity) * below + opacity * below * cover
        case "max":
            return np.fmax(below, opacity * cover)
        case "min":
            return np.fmin(below, (1.0 - opacity) + opacity * cover)
        case "difference":
            return np.abs(below - opacity * cover)
        case _:
            return np.clip(below + opacity * cover, None, 1.0)


def make_item(rng: np.random.Generator, tiles: int) -> SimpleNamespace:
    """An outline that covers tiles in full, in part or not at all, and whose edge goes through some of them."""
    fill = SimpleNamespace(
        mode=str(rng.choice(MODES)), opacity=float(rng.choice([1.0, 1.0, 0.4, 0.0])), invert=bool(rng.integers(2))
    )
    level = rng.choice([0.0, 1.0, 0.3], (1, tiles), p=[0.45, 0.45, 0.1])
    return SimpleNamespace(fill=fill, level=level, matters=rng.random((1, tiles)) < 0.1)


def check(items: list[SimpleNamespace], tiles: int) -> None:
    scale, offset, listed = _combine_levels(items, SimpleNamespace(down=1, across=tiles))
    for tile in range(tiles):
        at, some = (0, tile), [each[0, tile] for each in listed]
        everything, only_listed = MASKS, MASKS
        for item, is_listed in zip(items, some, strict=True):
            everything = combine(everything, item.level[at], item.fill)
            only_listed = combine(only_listed, item.level[at], item.fill) if is_listed else only_listed
            assert is_listed or not item.matters[at], "a pixel has to look at it"
        if any(some):
            np.testing.assert_allclose(only_listed, everything, atol=1e-12)
        else:
            np.testing.assert_allclose(scale[at] * MASKS + offset[at], everything, atol=1e-12)


@pytest.mark.parametrize(("mode", "invert", "opacity"), [*product(MODES, (False, True), (1.0, 0.4, 0.0))])
def test_one_outline(mode: str, invert: bool, opacity: float) -> None:
    """Tiles that it covers, does not cover, and covers in part; and it has no entry where it changes nothing."""
    fill = SimpleNamespace(mode=mode, opacity=opacity, invert=invert)
    level = np.array([[0.0, 1.0, 0.3]])
    item = SimpleNamespace(fill=fill, level=level, matters=np.zeros((1, 3), bool))
    check([item], 3)
    *_, (listed,) = _combine_levels([item], SimpleNamespace(down=1, across=3))
    for tile in range(3):
        results = combine(MASKS, level[0, tile], fill)
        bends = np.abs(np.diff(results, 2)).max() > 1e-9
        assert listed[0, tile] == bends or (opacity != 1.0 and not bends), "what only scales and adds needs no entry"
    item.matters[:] = True
    *_, (listed,) = _combine_levels([item], SimpleNamespace(down=1, across=3))
    assert listed.all()


@pytest.mark.parametrize("seed", range(8))
def test_many_outlines(seed: int) -> None:
    rng = np.random.default_rng(seed)
    check([make_item(rng, 40) for _ in range(1 + seed % 5)], 40)


def test_in_a_tile_with_an_edge_what_changes_nothing_has_no_entry() -> None:
    """Each entry costs a look at it: an outline far away, and all that lies behind what it keeps."""
    edge = SimpleNamespace(
        fill=SimpleNamespace(mode="union", opacity=1.0, invert=False),
        level=np.zeros((1, 1)),
        matters=np.ones((1, 1), bool),
    )
    for mode, invert, level in product(MODES, (False, True), (0.0, 1.0)):
        fill = SimpleNamespace(mode=mode, opacity=1.0, invert=invert)
        other = SimpleNamespace(fill=fill, level=np.full((1, 1), level), matters=np.zeros((1, 1), bool))
        *_, listed = _combine_levels([edge, other], SimpleNamespace(down=1, across=1))
        changes = not np.array_equal(combine(MASKS, level, fill), MASKS)
        assert [bool(each[0, 0]) for each in listed] == [True, changes], (mode, invert, level)
