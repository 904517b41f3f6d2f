"""Pictures of scopes: heights are counts, traces lie at their levels, chroma has its own color."""

from __future__ import annotations

import numpy as np
import pytest
from halation.editor.viewer import scope_images, scopes

ROWS = 100


def bars(levels: dict[float, int]) -> np.ndarray:
    """A row of gray pixels that have each level so many times."""
    return np.repeat(np.repeat(np.float32([*levels]), [*levels.values()])[None, :, None], 3, axis=2)


@pytest.mark.parametrize("dark", [True, False])
def test_a_histogram_is_as_high_as_its_counts(dark: bool) -> None:
    """Codes 40 to 239 have 8 pixels, so they are the full height; code 20 has 4, and code 30 has 2."""
    levels = {(code + 0.5) / 256: 8 for code in range(40, 240)} | {20.5 / 256: 4, 30.5 / 256: 2}
    image = scope_images.histogram_image(bars(levels), 0.0, 1.0, False, dark, ROWS)
    assert image.shape == (ROWS, scopes.BINS, 4) and image.dtype == np.uint8
    seen = image[..., 3] > 128
    heights = seen.sum(axis=0)
    assert heights[100] == ROWS and heights[20] == ROWS // 2 and heights[30] == ROWS // 4 and heights[10] == 0
    assert seen[-1, 20] and not seen[0, 20], "it stands on the ground"


def test_a_logarithmic_histogram_shows_small_counts() -> None:
    levels = {(code + 0.5) / 256: 63 for code in range(40, 240)} | {20.5 / 256: 7}
    image = scope_images.histogram_image(bars(levels), 0.0, 1.0, True, True, ROWS)
    assert (image[:, 20, 3] > 128).sum() == ROWS // 2, "log(1 + 7) is half of log(1 + 63)"


def test_channels_add_up_and_luminance_lies_behind_them() -> None:
    gray = np.repeat(np.linspace(0.2, 0.8, 4000, dtype=np.float32)[None, :, None], 3, axis=2)
    dark = scope_images.histogram_image(gray, 0.0, 1.0, False, True, ROWS)[-1, 128]
    assert dark[3] == 255 and dark[:3].min() > 200, "all channels are nearly white together"
    green = np.zeros((1, 4000, 3), np.float32)
    green[..., 1] = gray[..., 1]
    image = scope_images.histogram_image(green, 0.0, 1.0, False, True, ROWS)
    only_luminance = image[-1, round(0.2 * 0.7152 * 256) + 4]
    assert 60 < only_luminance[0] == only_luminance[1] == only_luminance[2] < 130 and only_luminance[3] == 255


@pytest.mark.parametrize("dark", [True, False])
def test_chroma_has_the_color_that_it_stands_for(dark: bool) -> None:
    """R'G'B' of Y' and differences by the luma coefficients of BT.709 (H.273); on white it is darker, of one hue."""
    kr, kb = 0.2126, 0.0722
    rgb = np.float32([color for _, color in scopes.TARGETS])[None]
    image = scope_images.vectorscope_image(rgb, dark, 256)
    for color in rgb[0]:
        x, y = scopes.chroma_place(tuple(map(float, color)))
        pixel = image[int(y * 256), int(x * 256)]
        assert pixel[3] > 200, "one pixel can be seen"
        blue, red = ((x - 0.5) * 2 * scopes.CHROMA, (0.5 - y) * 2 * scopes.CHROMA)
        made = np.array([0.55 + 2 * (1 - kr) * red, 0.0, 0.55 + 2 * (1 - kb) * blue])
        made[1] = (0.55 - kr * made[0] - kb * made[2]) / (1 - kr - kb)
        expected = np.clip(made, 0.15, 1.0) if dark else np.clip(made / made.max() * 0.58, 0.0, 1.0)
        assert np.abs(pixel[:3] / 255.0 - expected).max() < 0.02
    assert (image[..., 3] > 0).sum() == len(scopes.TARGETS)


def test_traces_have_the_color_of_their_channel_at_its_level() -> None:
    flat = np.broadcast_to(np.float32([0.75, 0.5, 0.25]), (4, 30, 3))
    image = scope_images.waveform_image(flat, 0.0, 1.0, True)
    assert image.shape == (scope_images.LEVELS, 30, 4)
    rows = np.nonzero(image[:, 0, 3])[0]
    assert rows.tolist() == [int((1.0 - level) * scope_images.LEVELS) - 1 for level in (0.75, 0.5, 0.25)]
    assert [int(image[row, 0, :3].argmax()) for row in rows] == [0, 1, 2]
    parade = scope_images.parade_image(flat, 0.0, 1.0, True)
    assert [sorted({*np.nonzero(parade[row, :, 3])[0] // 10}) for row in rows] == [[0], [1], [2]]
    assert scope_images.parade_image(np.zeros((2, 32, 3), np.float32), 0.0, 1.0, True).shape[1] == 30


def test_on_a_light_panel_traces_are_ink() -> None:
    flat = np.broadcast_to(np.float32([0.75, 0.5, 0.25]), (4, 30, 3))
    light, dark = (scope_images.waveform_image(flat, 0.0, 1.0, is_dark) for is_dark in (False, True))
    seen = dark[..., 3] > 0
    assert np.array_equal(seen, light[..., 3] > 0)
    assert (dark[seen][:, :3].max(axis=1) == 255).all() and (light[seen][:, :3].max(axis=1) == 148).all()
