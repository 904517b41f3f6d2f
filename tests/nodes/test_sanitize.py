"""Sanitize against OpenImageIO's fixNonFinite."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.color.sanitize import Sanitize
from oiio_pictures import make_buffer
from scipy.ndimage import generic_filter

MODES = {"neighbors": oiio.NONFINITE_BOX3, "black": oiio.NONFINITE_BLACK}


def broken(picture: np.ndarray) -> np.ndarray:
    """Single channels, whole pixels and corners, each on its own: OpenImageIO repairs in place, one after the other."""
    picture = picture.copy()
    picture[0, 0] = np.nan
    picture[3, 4, 1] = np.inf
    picture[6, 7] = -np.inf
    picture[-1, -1, 3] = np.nan
    picture[10, 2, :2] = np.nan
    return picture


@pytest.mark.parametrize("repair", MODES)
def test_it_is_openimageios(run, hdr, repair):
    picture = broken(hdr(23, 17))
    source = make_buffer(picture)
    expected = oiio.ImageBufAlgo.fixNonFinite(source, MODES[repair]).get_pixels("float")
    out = run(Sanitize(repair=repair, negative="keep"), {"image": picture})
    assert np.isfinite(expected).all()
    assert (np.abs(out - expected) / np.maximum(np.abs(expected), 1.0)).max() < 1e-6


def test_blocks_take_what_sound_pixels_lie_around(run, hdr):
    picture = hdr(23, 17)
    picture[5:8, 6:9] = np.nan
    picture[0, 3:12] = np.inf
    holes = np.where(np.isfinite(picture), picture, np.nan).astype(np.float64)
    around = np.stack(
        [
            generic_filter(holes[..., channel], sound_average, size=3, mode="constant", cval=np.nan)
            for channel in range(4)
        ],
        -1,
    )
    expected = np.where(np.isnan(holes), around, holes)
    out = run(Sanitize(), {"image": picture})
    assert not out[6, 7].any()  # the middle of the block, with nothing sound in reach
    assert (np.abs(out - expected) / np.maximum(expected, 1.0)).max() < 1e-6


def sound_average(values: np.ndarray) -> float:
    sound = values[~np.isnan(values)]
    return float(sound.mean()) if sound.size else 0.0


def test_sound_pictures_stay(run, hdr):
    picture = hdr(23, 17)
    np.testing.assert_array_equal(run(Sanitize(), {"image": picture}), picture)


@pytest.mark.parametrize(("negative", "becomes"), [("keep", -0.5), ("clip", 0.0), ("mirror", 0.5)])
def test_negative_light(run, negative, becomes):
    picture = np.float32([[[-0.5, 0.25, 1e30, -0.1]]])
    out = run(Sanitize(negative=negative, maximum=100.0), {"image": picture})
    np.testing.assert_array_equal(out, np.float32([[[becomes, 0.25, 100.0, 0.0]]]))


def test_alpha_is_limited_on_demand(run):
    picture = np.full((1, 1, 4), 3.0, np.float32)
    assert run(Sanitize(), {"image": picture})[0, 0, 3] == 1.0
    assert run(Sanitize(limit_alpha=False), {"image": picture})[0, 0, 3] == 3.0


def test_a_picture_of_nothing_but_holes_is_black(run):
    assert not run(Sanitize(), {"image": np.full((3, 5, 4), np.nan)}).any()
