"""Pictures of differences: how bright a difference is, read by another library."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from halation.media.pictures.stored import StoredPart
from halation.regression.pictures import make_views
from halation.regression.results import PictureCheck


def make_part(pixels: np.ndarray) -> StoredPart:
    return StoredPart(pixels, ("R", "G", "B", "A"), False)


def read_png(data: bytes, folder: Path) -> np.ndarray:
    path = folder / "view.png"
    path.write_bytes(data)
    return np.asarray(oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT))


def test_differences_have_the_power_of_a_display(tmp_path: Path) -> None:
    """The largest is white; half of it is 0.5 to the power of 1 / 2.2."""
    golden = make_part(np.zeros((4, 4, 4), np.float32))
    changed = np.zeros((4, 4, 4), np.float32)
    changed[0, :, :3], changed[1, :, :3] = 0.5, 0.25
    check = PictureCheck(Path("golden.exr"), 1, "image")
    views = make_views(check, {"image": make_part(changed)}, {"image": golden}, "")
    assert views.gain == 2.0
    seen = read_png(views.difference, tmp_path)[:, 0, 0]
    np.testing.assert_allclose(seen, [1.0, 0.5 ** (1.0 / 2.2), 0.0, 0.0], atol=0.6 / 255)
