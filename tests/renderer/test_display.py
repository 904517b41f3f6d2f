"""What a panel shows: exact color, exact places, and nothing drawn twice."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from device_textures import read_texture, upload_texture
from halation.color.display import list_displays, list_views, to_display
from halation.errors import UsageError
from halation.renderer import DeviceTexture, Display, Look, Renderer, find_panel_point, find_picture_point, fit_zoom
from halation.renderer.opengl.device import OpenGLDevice

NUMBERS = itertools.count()
RAW = {"view": "Raw", "surround": (0.25, 0.25, 0.25), "checker": False}


@dataclass
class Result:
    texture: DeviceTexture
    full_size: tuple[int, int]
    channels: int
    key: str
    size: tuple[int, int]
    start: tuple[int, int] = (0, 0)


@pytest.fixture
def display(renderer: Renderer) -> Iterator[Display]:
    made = Display(renderer.device, "f4")
    yield made
    made.close()


@pytest.fixture
def result(renderer: Renderer):
    """`result(pixels)` is a texture as the runner keeps it: three channels are stored as four."""
    made: list[DeviceTexture] = []

    def uploaded(pixels, scale: float = 1.0) -> Result:
        array = np.asarray(pixels, np.float32)
        height, width, channels = array.shape
        stored = 4 if channels == 3 else channels
        padded = np.zeros((height, width, stored), np.float32)
        padded[..., :channels] = array
        made.append(upload_texture(renderer.device, padded))
        full = (round(width / scale), round(height / scale))
        return Result(made[-1], full, channels, f"{next(NUMBERS)}", (width, height))

    yield uploaded
    with renderer.device.make_current():
        for texture in made:
            texture.release()


@pytest.fixture
def shown(display: Display, renderer: Renderer):
    """`shown(a, (w, h), zoom=2.0, ...)` as [h, w, 3]."""

    def drawn(a, size=None, b=None, **look):
        size = size or a.full_size
        texture = display.draw("panel", size, a, b, Look(**look))
        pixels = read_texture(renderer.device, texture)
        assert (pixels[..., 3] == 1.0).all()
        return pixels[..., :3]

    return drawn


def stops(rng: np.random.Generator) -> np.ndarray:
    """Opaque random colors, 8 stops below to 6 above middle gray."""
    pixels = np.ones((48, 64, 4), np.float32)
    pixels[..., :3] = 0.18 * np.exp2(rng.uniform(-8.0, 6.0, (48, 64, 3)))
    return pixels


@pytest.mark.parametrize("view", ["", "Un-tone-mapped", "Video", "Raw", "none"])
def test_views_are_those_of_written_files(result, shown, view):
    pixels = stops(np.random.default_rng(1))
    expected = to_display(pixels, view, bits=32)[..., :3].clip(0.0, 1.0)
    assert np.abs(shown(result(pixels), view=view).clip(0.0, 1.0) - expected).max() <= 1e-4


@pytest.mark.parametrize("screen", [name for name in list_displays() if "HDR" not in name][1:])
def test_every_display_has_its_views(result, shown, screen):
    pixels = stops(np.random.default_rng(2))
    expected = to_display(pixels, "", bits=32, display=screen)[..., :3].clip(0.0, 1.0)
    assert np.abs(shown(result(pixels), display=screen).clip(0.0, 1.0) - expected).max() <= 1.0 / 255.0
    assert list_views(screen)[-1] == "none"


def test_a_screen_gets_eight_bits(renderer, result):
    pixels = stops(np.random.default_rng(3))
    display = Display(renderer.device)
    texture = display.draw("a", (64, 48), result(pixels))
    got = read_texture(renderer.device, texture, np.uint8)[..., :3]
    assert np.abs(got.astype(int) - to_display(pixels)[..., :3]).max() <= 1
    display.close()


def test_an_unknown_view_is_the_user_s_mistake(result, display):
    with pytest.raises(UsageError, match="there is no view 'qqq'"):
        display.draw("a", (4, 4), result(np.ones((4, 4, 4))), None, Look(view="qqq"))


def test_the_view_sees_straight_color(result, shown):
    """As in a written file: unpremultiplied, through the view, and only then over what is behind."""
    rng = np.random.default_rng(4)
    pixels = stops(rng)
    pixels[..., 3] = rng.uniform(0.05, 1.0, (48, 64))
    pixels[..., :3] *= pixels[..., 3:]
    view = to_display(pixels, "none", bits=32)
    behind = np.array((0.2, 0.4, 0.6), np.float32)
    expected = view[..., :3] * view[..., 3:] + behind * (1.0 - view[..., 3:])
    got = shown(result(pixels), view="none", checker=False, background=(0.2, 0.4, 0.6))
    np.testing.assert_allclose(got, expected, atol=2e-5)


def test_light_without_alpha_is_added_to_what_is_behind(result, shown):
    got = shown(result(np.full((4, 4, 4), 0.25) * [1, 1, 1, 0]), background=(0.5, 0.0, 0.0), **RAW)
    np.testing.assert_allclose(got[0, 0], (0.75, 0.25, 0.25), atol=1e-6)


def test_a_checker_of_screen_pixels_lies_behind_what_is_transparent(result, shown):
    small, large = (shown(result(np.zeros((4, 4, 4))), (64, 64), zoom=zoom, view="none") for zoom in (16.0, 40.0))
    np.testing.assert_array_equal(small, large)
    assert (small[:8, :8] == small[0, 0]).all() and (small[8:16, :8] != small[0, 0]).all()


# --- places ----------------------------------------------------------------------------------------------------------


def test_row_zero_is_on_top_and_pixels_are_exact(result, shown):
    pixels = np.ones((5, 7, 4), np.float32)
    pixels[..., 0], pixels[..., 1] = np.arange(7), np.arange(5)[:, None]
    np.testing.assert_array_equal(shown(result(pixels), **RAW), pixels[..., :3])
    larger = shown(result(pixels), (21, 15), zoom=3.0, **RAW)
    np.testing.assert_array_equal(larger, pixels[..., :3].repeat(3, 0).repeat(3, 1))


def test_outside_is_the_surround(result, shown):
    got = shown(result(np.ones((4, 6, 4))), (12, 10), pan=(1.0, -2.0), **RAW)
    inside = np.zeros((10, 12), bool)
    inside[1:5, 4:10] = True
    assert (got[inside] == 1.0).all() and (got[~inside] == 0.25).all()
    assert (shown(result(np.ones((4, 6, 4))), (12, 10), pan=(100.0, 0.0), **RAW) == 0.25).all()


def test_nothing_to_show(display, renderer):
    texture = display.draw("panel", (3, 2), None, None, Look(**RAW))
    assert set(read_texture(renderer.device, texture).flat) == {0.25, 1.0}


@pytest.mark.parametrize("zoom", [0.5, 0.25])
def test_zooming_out_takes_the_mean(result, shown, zoom):
    pixels = np.random.default_rng(5).random((32, 48, 4), np.float32)
    pixels[..., 3] = 1.0
    n = round(1 / zoom)
    expected = pixels.reshape(32 // n, n, 48 // n, n, 4).mean(axis=(1, 3))[..., :3]
    got = shown(result(pixels), (48 // n, 32 // n), zoom=zoom, **RAW)
    np.testing.assert_allclose(got, expected, atol=1e-6)


def test_a_fraction_of_a_pixel_counts_for_its_fraction(result, shown):
    pixels = np.ones((1, 3, 4), np.float32)
    pixels[0, :, 0] = (1.0, 4.0, 9.0)
    got = shown(result(pixels), (2, 1), zoom=2 / 3, **RAW)
    np.testing.assert_allclose(got[0, :, 0], ((1.0 + 0.5 * 4.0) / 1.5, (0.5 * 4.0 + 9.0) / 1.5), rtol=1e-6)


def test_a_fine_pattern_does_not_alias_from_far_away(result, shown):
    pixels = np.ones((256, 256, 4), np.float32)
    pixels[..., :3] = (np.indices((256, 256)).sum(axis=0) % 2)[..., None]
    got = shown(result(pixels), (64, 64), zoom=0.25, **RAW)
    np.testing.assert_allclose(got, 0.5, atol=1e-6)


def test_a_proxy_covers_what_the_full_size_would(result, shown):
    pixels = np.random.default_rng(6).random((6, 8, 4), np.float32)
    pixels[..., 3] = 1.0
    got = shown(result(pixels, scale=0.5), (16, 12), **RAW)
    np.testing.assert_array_equal(got, pixels[..., :3].repeat(2, 0).repeat(2, 1))


@pytest.mark.parametrize("pan", [(0.0, 0.0), (31.0, -17.0), (-70.0, 60.0)])
def test_an_enlarged_picture_shows_the_same_colors(result, shown, pan):
    """The view is then computed once per texel."""
    rng = np.random.default_rng(9)
    pixels = stops(rng)
    pixels[..., 3] = rng.uniform(0.0, 1.0, (48, 64))
    look = {"exposure": 0.5, "gamma": 1.2, "checker": False, "background": (0.2, 0.4, 0.6)}
    whole = shown(result(pixels), (64, 48), **look).repeat(4, 0).repeat(4, 1)
    panel = shown(result(pixels), (100, 60), zoom=4.0, pan=pan, **look)
    left, top = (int(part) for part in find_picture_point(Look(pan=pan), (100, 60), (256, 192), (0.0, 0.0)))
    np.testing.assert_allclose(panel, whole[top : top + 60, left : left + 100], atol=1e-6)


def test_points_of_panel_and_picture():
    look, panel, picture = Look(zoom=2.5, pan=(7.0, -3.0)), (101, 67), (30, 20)
    there = find_picture_point(look, panel, picture, (40.0, 20.0))
    assert find_panel_point(look, panel, picture, there) == pytest.approx((40.0, 20.0))
    assert find_picture_point(Look(), (10, 8), (10, 8), (3.0, 2.0)) == (3.0, 2.0)
    assert fit_zoom((100, 80), (50, 20)) == 2.0


def test_the_pixel_under_a_point_is_the_one_that_is_named(result, shown):
    pixels = np.zeros((20, 30, 4), np.float32)
    pixels[13, 22] = 1.0
    look = {"zoom": 2.5, "pan": (7.0, -3.0)}
    got = shown(result(pixels), (101, 67), **look, **RAW)
    found = {
        tuple(int(part) for part in find_picture_point(Look(**look), (101, 67), (30, 20), (column + 0.5, row + 0.5)))
        for row, column in np.argwhere(got[..., 0] == 1.0)
    }
    assert found == {(22, 13)}


# --- what of it ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("channels", "expected"),
    [
        ("red", 0.1),
        ("green", 0.2),
        ("blue", 0.4),
        ("alpha", 0.5),
        ("luminance", 0.2126 * 0.1 + 0.7152 * 0.2 + 0.0722 * 0.4),
    ],
)
def test_one_channel_is_gray(result, shown, channels, expected):
    got = shown(result(np.full((2, 2, 4), (0.1, 0.2, 0.4, 0.5))), channels=channels, **RAW)
    np.testing.assert_allclose(got, expected, rtol=1e-5)


def test_exposure_and_gamma(result, shown):
    pixels = result(np.full((2, 2, 4), (0.1, 0.2, 0.4, 1.0)))
    np.testing.assert_allclose(shown(pixels, exposure=1.0, **RAW)[0, 0], (0.2, 0.4, 0.8), rtol=1e-6)
    np.testing.assert_allclose(shown(pixels, gamma=2.0, **RAW)[0, 0], np.sqrt((0.1, 0.2, 0.4)), rtol=1e-5)


def test_false_color_says_how_bright(result, shown):
    grays = 0.18 * np.exp2(np.array((-8.0, -3.0, 0.0, 2.0, 5.0, 8.0)))
    got = shown(result(np.ones((1, 6, 4)) * grays[None, :, None]), channels="false color")
    assert len({tuple(color) for color in got[0]}) == 6
    np.testing.assert_allclose(got[0, 2], 0.5)
    assert got[0, 1].argmax() == 2 and got[0, 4].argmax() == 0


def test_a_field_shows_its_range(result, shown):
    got = shown(result(np.array([[[2.0], [4.0], [6.0]]])), meaning="field", low=2.0, high=6.0)
    np.testing.assert_allclose(got[0], np.repeat([[0.0], [0.5], [1.0]], 3, axis=1))


def test_a_normal_and_a_motion_vector(result, shown):
    normal = shown(result(np.array([[[0.0, -1.0, 1.0]]])), meaning="normal")
    np.testing.assert_allclose(normal[0, 0], (0.5, 0.0, 1.0))
    motion = shown(result(np.array([[[-8.0, 8.0]]])), meaning="vector", low=-16.0, high=16.0)
    np.testing.assert_allclose(motion[0, 0, :2], (0.25, 0.75))


def test_broken_pixels_are_loud_at_any_zoom(result, shown):
    pixels = np.full((64, 64, 4), 0.5, np.float32)
    pixels[33, 17, 1] = np.nan
    pixels[40, 50, 0] = np.inf
    loud = (shown(result(pixels), (16, 16), zoom=0.25, **RAW) == (1.0, 0.0, 1.0)).all(axis=2)
    assert {tuple(int(part) for part in at) for at in np.argwhere(loud)} == {(8, 4), (10, 12)}
    quiet = shown(result(pixels), (16, 16), zoom=0.25, nonfinite=False, **RAW)
    np.testing.assert_allclose(quiet, 0.5)


def test_clipping_is_striped(result, shown):
    pixels = np.full((32, 96, 4), 0.5, np.float32)
    pixels[:, 32:64, 0], pixels[:, 64:, 1], pixels[..., 3] = 1.5, -0.5, 1.0
    plain, striped = (shown(result(pixels), clipping=clipping, **RAW) for clipping in (False, True))
    changed = (plain != striped).any(axis=2).reshape(32, 3, 32).mean(axis=(0, 2))
    assert changed[0] == 0.0 and 0.3 < changed[1] < 0.7 and 0.3 < changed[2] < 0.7
    assert striped[:, 32:64][..., 0].max() == plain[:, 32:64][..., 0].max()
    wide = {"meaning": "vector", "low": -9.0, "high": 9.0}
    np.testing.assert_array_equal(shown(result(pixels), clipping=True, **wide), shown(result(pixels), **wide))


def test_what_lies_outside_of_the_region_is_dimmed(result, shown):
    got = shown(result(np.ones((10, 10, 4))), region=(2.0, 3.0, 4.0, 5.0), **RAW)
    inside = np.zeros((10, 10), bool)
    inside[3:8, 2:6] = True
    assert (got[inside] == 1.0).all() and (got[~inside] < 0.5).all()


@pytest.mark.parametrize(("zoom", "step", "repeat"), [(1.0, 1, 1), (3.0, 1, 3), (0.5, 2, 1)])
def test_what_goes_on_around_the_frame_is_shown_dimmed(result, shown, zoom, step, repeat):
    """A frame of 12 x 8 whose texture has 4 more pixels on the left, 2 above and 6 to the right, and none below."""
    pixels = np.ones((10, 22, 4), np.float32)
    pixels[..., :3] = np.random.default_rng(6).random((5, 11, 3), np.float32).repeat(2, axis=0).repeat(2, axis=1)
    around = replace(result(pixels), size=(12, 8), full_size=(12, 8), start=(-4, -2))
    expected = np.full((24, 32, 3), 0.25, np.float32)
    expected[6:16, 6:28] = 0.35 * pixels[..., :3]
    expected[8:16, 10:22] = pixels[2:, 4:16, :3]
    got = shown(around, (round(32 * zoom), round(24 * zoom)), zoom=zoom, **RAW)
    np.testing.assert_allclose(got, expected[::step, ::step].repeat(repeat, 0).repeat(repeat, 1), atol=1e-6)


@pytest.mark.parametrize(("zoom", "stretch"), [(1.0, 2.0), (2.0, 0.5), (3.0, 2.0)])
def test_pixels_are_shown_in_their_shape(result, shown, zoom, stretch):
    """An anamorphic picture is as wide as it is meant, and the points of panel and picture agree with it."""
    pixels = np.random.default_rng(4).random((8, 12, 3))
    across, down = round(zoom * stretch), round(zoom)
    size = (12 * across, 8 * down)
    got = shown(result(pixels), size, zoom=zoom, stretch=stretch, **RAW)
    np.testing.assert_allclose(got, pixels.repeat(down, axis=0).repeat(across, axis=1), atol=1e-6)
    look = Look(zoom=zoom, stretch=stretch)
    assert find_picture_point(look, size, (12, 8), (5 * across, 3 * down)) == (5.0, 3.0)
    assert find_panel_point(look, size, (12, 8), (5.0, 3.0)) == (5 * across, 3 * down)
    assert fit_zoom(size, (12, 8), stretch) == zoom


# --- two pictures ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("angle", "first"), [(0.0, (slice(None), slice(0, 7))), (90.0, (slice(0, 7), slice(None)))])
def test_a_wipe_has_a_on_one_side_and_b_on_the_other(result, shown, angle, first):
    a, b = result(np.full((16, 16, 4), (0.1, 0.1, 0.1, 1.0))), result(np.full((16, 16, 4), (0.7, 0.7, 0.7, 1.0)))
    got = shown(a, None, b, compare="wipe", angle=angle, **RAW)
    np.testing.assert_allclose(got[first], 0.1, rtol=1e-6)
    flipped = got[::-1, ::-1]
    np.testing.assert_allclose(flipped[first], 0.7, rtol=1e-6)


def test_the_difference_and_the_other(result, shown):
    a, b = result(np.full((4, 4, 4), (0.5, 0.1, 0.3, 1.0))), result(np.full((4, 4, 4), (0.2, 0.4, 0.3, 0.5)))
    np.testing.assert_allclose(shown(a, None, b, compare="difference", **RAW)[0, 0], (0.3, 0.3, 0.0), atol=1e-6)
    np.testing.assert_allclose(shown(a, None, b, compare="b", channels="alpha", **RAW), 0.5)
    np.testing.assert_allclose(shown(a, None, None, compare="difference", **RAW)[0, 0], (0.5, 0.1, 0.3), atol=1e-6)


def test_a_wipe_between_a_proxy_and_the_full_picture(result, shown):
    pixels = np.ones((8, 8, 4), np.float32)
    got = shown(result(pixels[::2, ::2] * 0.5, scale=0.5), (8, 8), result(pixels), compare="wipe", **RAW)
    np.testing.assert_allclose(got[:, -3:], 1.0)
    assert got.shape == (8, 8, 3) and (got[0, 0] != 0.25).all()


# --- upkeep ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("zoom", [3.7, 1.0, 0.4])
@pytest.mark.parametrize("compare", ["off", "wipe", "difference"])
def test_a_part_is_shown_where_it_lies_in_the_whole(result, shown, zoom, compare):
    pixels = np.random.default_rng(5).random((40, 60, 4))
    whole, other = result(pixels), result(pixels[::-1])
    x, y, width, height = 12, 9, 31, 22
    parts = [
        replace(result(one[y : y + height, x : x + width]), size=(60, 40), full_size=(60, 40), start=(x, y))
        for one in (pixels, pixels[::-1])
    ]
    look = {"zoom": zoom, "compare": compare, "wipe": (0.5, 0.4), "angle": 30.0, "pan": (3.0, 2.0)} | RAW
    expected, got = shown(whole, (70, 50), other, **look), shown(parts[0], (70, 50), parts[1], **look)
    there = ~(got == np.float32(RAW["surround"][0])).all(axis=2)
    assert there.any()
    np.testing.assert_array_equal(got[there], expected[there])
    # Only what some texel is missing for is left out: what lies a pixel inside of the part is all there.
    left, top = (panel / 2 + pan - size * zoom / 2 for panel, pan, size in ((70, 3.0, 60), (50, 2.0, 40)))
    columns, rows = np.meshgrid((np.arange(70) + 0.5 - round(left)) / zoom, (np.arange(50) + 0.5 - round(top)) / zoom)
    reach = max(1.0, 1.0 / zoom)
    inner = (columns >= x + reach) & (columns < x + width - reach) & (rows >= y + reach) & (rows < y + height - reach)
    assert there[inner].all() and inner.any()
    outer = (columns < x) | (columns >= x + width) | (rows < y) | (rows >= y + height)
    assert not there[outer].any() or compare == "wipe"  # its line is drawn everywhere


def test_it_draws_only_what_changed(result, display):
    a, look = result(np.ones((4, 4, 4))), Look(view="none")
    first = display.draw("one", (8, 8), a, None, look)
    assert display.draw("one", (8, 8), a, None, Look(view="none")) is first and display.draw_count == 1
    display.draw("two", (8, 8), a, None, look)
    assert display.draw("one", (8, 8), a, None, look) is first and display.draw_count == 2
    a.key = "changed"
    assert display.draw("one", (8, 8), a, None, look) is first and display.draw_count == 3
    display.draw("one", (8, 8), a, None, Look(view="none", exposure=1.0))
    assert display.draw("one", (9, 8), a, None, look).size == (9, 8) and display.draw_count == 5


def test_what_was_bound_stays_bound(result, display, renderer):
    assert isinstance(renderer.device, OpenGLDevice)
    context = renderer.device.context
    with renderer.device.make_current():
        mine = context.framebuffer([context.texture((3, 3), 4)])
        mine.use()
    display.draw("one", (8, 8), result(np.ones((4, 4, 4))), None, Look(view="none"))
    display.release_slot("one")
    with renderer.device.make_current():
        assert context.fbo is mine and context.viewport == (0, 0, 3, 3)
        renderer.device._idle.use()
        mine.release()
