"""Ambient occlusion against closed forms in a corner, and against rays cast in numpy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import CameraModel, look_at
from halation.nodes.light.ambient_occlusion import AmbientOcclusion
from lens import blender

FULL, SMALL = (320, 180), (192, 108)
UP = ((0.0, 0.0, 1.0), 0.0)  # a floor: its normal, and n . x on it
MODES = ("gtao", "hbao", "bitmask", "hemisphere", "crytek", "alchemy")


def taken(size, planes, eye=(5.0, 0.0, 3.0), target=(1.0, 0.0, 0.6), focal=30 / 36, up=(0.0, 0.0, 1.0)):
    """A camera before planes that form a hollow: the camera, depth, normals and places of what it sees first."""
    width, height = size
    camera = look_at(eye, target, (focal, focal * width / height), up)
    y, x = np.mgrid[0:height, 0:width]
    seen = np.stack([(x + 0.5) / width, (y + 0.5) / height, np.ones(x.shape)], -1)
    rays = seen @ np.reshape(camera.inverse, (3, 4))[:, :3].T
    depths = []
    for normal, level in planes:
        with np.errstate(divide="ignore"):
            depth = (level - np.dot(normal, eye)) / (rays @ np.asarray(normal))
        depths.append(np.where(depth > 0, depth, np.inf))
    first = np.argmin(depths, 0)
    depth = np.min(depths, 0)
    with np.errstate(invalid="ignore"):
        places = eye + depth[..., None] * rays
    return camera, depth, np.asarray([normal for normal, _ in planes], float)[first], places


def corner(size, **view):
    """Floor and wall at right angles; how far every place is from the other one; where the radius fits the picture."""
    camera, depth, normal, place = taken(size, [UP, ((1.0, 0.0, 0.0), 0.0)], **view)
    return camera, depth, normal, np.where(normal[..., 2] > 0.5, place[..., 0], place[..., 2])


def inner(depth, radius, focal=30 / 36):
    """Where all within the radius is in the picture."""
    height, width = depth.shape
    reach = radius / depth * focal * width + 2
    y, x = np.mgrid[0:height, 0:width]
    return (x > reach) & (x < width - reach) & (y > reach) & (y < height - reach)


def cosine_share(c):
    """The cosine-weighted share of the sky beside a wall c radii away: Monte Carlo and Cycles agree."""
    c = np.clip(c, 0, 1)
    return 1 - (np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi


def even_share(c):
    """The same, evenly weighted."""
    return (1 + np.clip(c, 0, 1)) / 2


def radial_share(c):
    """The part of all points of a half ball, spread evenly over directions and distance, that is before the wall."""
    c = np.clip(c, 1e-12, 1)
    return 1 - ((1 - c) + c * np.log(c)) / 2


def ball_share(c):
    """Twice the part of a ball's volume that is before floor and wall."""
    cap = 1 - np.clip(c, 0, 1)
    return 1 - cap * cap * (3 - cap) / 4


def render(run, camera, depth, normal=None, output="occlusion", **values):
    given = {"depth": depth, "camera": camera}
    if normal is not None:
        given["normal"] = normal
    found = run(AmbientOcclusion(**({"falloff": 0.0, "radius": 0.5} | values)), given, output=output)
    return found[..., 0] if output == "occlusion" else found


def rms(error) -> float:
    return float(np.sqrt(np.mean(np.square(error))))


@pytest.mark.parametrize(("quality", "mean", "scatter"), [("reference", 0.005, 0.01), ("quality", 0.009, 0.016)])
def test_the_corner_has_a_closed_form(run, quality, mean, scatter):
    camera, depth, normal, away = corner(FULL)
    found = render(run, camera, depth, normal, quality=quality, denoise=False)
    error = (found - cosine_share(away / 0.5))[inner(depth, 0.5)]
    assert abs(error.mean()) < mean and rms(error) < scatter


@pytest.mark.parametrize(
    ("mode", "share", "scatter"),
    [
        ("gtao", cosine_share, 0.012),
        ("bitmask", cosine_share, 0.012),
        ("hbao", even_share, 0.012),
        ("hemisphere", radial_share, 0.016),
        ("crytek", ball_share, 0.012),
    ],
)
@pytest.mark.parametrize("resolution", ["full", "half"])
def test_modes_in_the_corner(run, mode, share, scatter, resolution):
    """At the quality that one works with, denoised, from depth alone."""
    camera, depth, _, away = corner(FULL)
    found = render(run, camera, depth, mode=mode, thickness=1e6, resolution=resolution)
    error = (found - share(away / 0.5))[inner(depth, 0.5)]
    assert abs(error.mean()) < 0.01 and rms(error) < scatter * (2.0 if resolution == "half" else 1.0)


def test_alchemy_is_its_integral(run):
    """The mean over a disc across the view, of which every radius counts alike, made densely in numpy."""
    camera, depth, normal, _ = corner(SMALL)
    found = render(run, camera, depth, normal, mode="alchemy", quality="reference", denoise=False)
    rows, inverse = np.reshape(camera.rows, (3, 4))[:, :3], np.reshape(camera.inverse, (3, 4))[:, :3]
    inside = np.argwhere(inner(depth, 0.5))[::301]
    error = []
    for y, x in inside:
        place = depth[y, x] * inverse @ [(x + 0.5) / SMALL[0], (y + 0.5) / SMALL[1], 1.0]
        view = -place / np.linalg.norm(place)
        right = np.cross(view, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        part, turn = np.meshgrid((np.arange(400) + 0.5) / 400, np.arange(128) * np.pi / 64, indexing="ij")
        off = np.cos(turn)[..., None] * right + np.sin(turn)[..., None] * np.cross(view, right)
        seen = (place + 0.5 * part[..., None] * off) @ rows.T
        ray = np.stack([seen[..., 0] / seen[..., 2], seen[..., 1] / seen[..., 2], np.ones(part.shape)], -1) @ inverse.T
        eye = np.asarray(camera.eye)
        with np.errstate(divide="ignore"):
            hits = [-eye[axis] / ray[..., axis] for axis in (0, 2)]
        deep = np.minimum(*(np.where(hit > 0, hit, np.inf) for hit in hits))[..., None]
        way = (deep * ray - place) / 0.5
        square = (way**2).sum(-1)
        gain = np.maximum(way @ normal[y, x] - 1e-4 * deep[..., 0] / 0.5, 0) / (square + 1e-2)
        error.append(found[y, x] - max(1 - np.where(square < 1, gain, 0).mean(), 0))
    assert len(error) > 10 and rms(error) < 0.01


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("tilt", [0.0, 60.0, 80.0])
def test_flat_surfaces_are_open(run, mode, tilt):
    angle = np.radians(tilt)
    camera, depth, normal, _ = taken(
        (96, 54), [UP], eye=(0.0, -5 * np.sin(angle), 5 * np.cos(angle)), target=(0, 0, 0), up=(0, 1, 0)
    )
    seen = depth < 1e9
    for denoise in (False, True):
        found = render(run, camera, depth, normal, mode=mode, denoise=denoise)[seen]
        assert abs(found.mean() - 1) < 1e-3 and found.min() > (0.94 if mode == "crytek" else 0.999)
    alone = render(run, camera, depth, mode=mode)[seen]
    assert abs(alone.mean() - 1) < 2e-3
    bent = render(run, camera, depth, normal, output="bent_normal", mode=mode)[seen]
    assert bent[:, 2].mean() > np.cos(np.radians(1.0))


def cast(place, normal, planes, radius, steps=96):
    """The cosine-weighted share of directions with nothing nearer than the radius, and their mean direction."""
    u, v = np.meshgrid((np.arange(steps) + 0.5) / steps, (np.arange(steps) + 0.5) / steps)
    across = np.cross(normal, (0.3, 0.9, 0.1))
    across /= np.linalg.norm(across)
    spread = np.sqrt(u)[..., None] * (
        np.cos(2 * np.pi * v)[..., None] * across + np.sin(2 * np.pi * v)[..., None] * np.cross(normal, across)
    )
    way = spread + np.sqrt(1 - u)[..., None] * np.asarray(normal)
    free = np.ones(u.shape, bool)
    for other, level, stop in planes:
        with np.errstate(divide="ignore", invalid="ignore"):
            far = (level - np.dot(other, place)) / (way @ np.asarray(other))
            free &= ~((far > 1e-6) & (far < radius) & stop(place + far[..., None] * way))
    return free.mean(), (free[..., None] * way).sum((0, 1))


@pytest.mark.parametrize("degrees", [60.0, 90.0, 130.0])
def test_wedges_of_any_angle(run, degrees):
    """C4, (1 + cos) / 2 of the sky at the edge of a wedge, and what rays find anywhere in it."""
    angle = np.radians(degrees)
    slope = (np.sin(angle), 0.0, -np.cos(angle))
    camera, depth, normal, place = taken(FULL, [UP, (slope, 0.0)], eye=(4.0, 0.0, 2.5), target=(0.8, 0.0, 0.3))
    found = render(run, camera, depth, normal, quality="reference", denoise=False)
    bent = render(run, camera, depth, normal, output="bent_normal", quality="reference", denoise=False)
    anywhere = lambda at: np.ones(at.shape[:2], bool)  # noqa: E731
    error, turn = [], []
    inside = inner(depth, 0.5)
    close = inside & (np.hypot(place[..., 0], place[..., 2]) < 0.08)
    for y, x in [*np.argwhere(inside)[::1501], *np.argwhere(close)[::301]]:
        facing = normal[y, x]
        planes = [(*plane, anywhere) for plane in (UP, (slope, 0.0)) if np.dot(plane[0], facing) < 0.999]
        share, way = cast(place[y, x], facing, planes, 0.5)
        error.append(found[y, x] - share)
        turn.append(np.degrees(np.arccos(min(np.dot(bent[y, x], way / np.linalg.norm(way)), 1.0))))
    assert len(error) > 12 and abs(np.mean(error)) < 0.006 and rms(error) < 0.016
    assert np.mean(turn) < 0.6 and np.max(turn) < 4.0


def test_a_low_wall(run):
    """C2: from its foot, half of the sky and what is seen over its top: (1 + d / sqrt(d^2 + h^2)) / 2."""
    size, high = FULL, 0.4
    camera, depth, normal, place = taken(size, [UP, ((1.0, 0.0, 0.0), 0.0)])
    top = taken(size, [((0.0, 0.0, 1.0), high)])
    above = place[..., 2] > high
    depth, normal = np.where(above, top[1], depth), np.where(above[..., None], top[2], normal)
    found = render(run, camera, depth, normal, quality="reference", radius=2.0)
    floor = (normal[..., 2] > 0.5) & ~above & (np.abs(place[..., 1]) < 0.3)
    away = place[..., 0]
    for d in (0.1, 0.2, 0.4):
        near = floor & (np.abs(away - d) < 0.02)
        assert abs(found[near].mean() - (1 + d / np.hypot(d, high)) / 2) < 0.03
    stands = (place[..., 2] < high) & (normal[..., 0] > 0.5) & (np.abs(place[..., 1]) < 0.3) & (place[..., 2] > 0.05)
    share = cosine_share(place[..., 2] / 2.0)
    assert abs((found - share)[stands].mean()) < 0.03


@pytest.mark.parametrize("mode", ["gtao", "bitmask"])
def test_a_ball_over_the_floor(run, mode):
    """C3: 1 - r^2 h / (x^2 + h^2)^(3/2). Depth does not tell what is below the ball, so a tenth is allowed."""
    camera, depth, normal, place = taken(SMALL, [UP], eye=(0.0, -6.0, 3.5), target=(0.0, 0.0, 0.3), focal=1.2)
    rays = (place - camera.eye) / depth[..., None]
    radius, center = 0.5, np.array([0.0, 0.0, 0.8])
    way = camera.eye - center
    a, b, c = (rays**2).sum(-1), rays @ way, way @ way - radius**2
    with np.errstate(invalid="ignore"):
        ball = (-b - np.sqrt(b * b - a * c)) / a
    hit = np.isfinite(ball)
    normal = np.where(hit[..., None], (way + np.nan_to_num(ball)[..., None] * rays) / radius, normal)
    depth = np.where(hit, ball, depth)
    found = render(run, camera, depth, normal, mode=mode, quality="reference", radius=4.0, thickness=1.0)
    expected = 1 - radius**2 * 0.8 / ((place[..., :2] ** 2).sum(-1) + 0.64) ** 1.5
    floor = ~hit & (np.abs(place[..., :2]).max(-1) < 1.5) & (place[..., 1] < 0.5)
    assert np.abs((found - expected)[floor]).mean() < 0.1


def test_it_does_not_depend_on_the_view(run):
    curves = []
    for eye in ((4.0, 2.5, 2.0), (2.5, -1.0, 4.5)):
        camera, depth, normal, away = corner(FULL, eye=eye, target=(0.4, 0.0, 0.3))
        error = render(run, camera, depth, normal, quality="reference", denoise=False) - cosine_share(away / 0.5)
        floor = inner(depth, 0.5) & (normal[..., 2] > 0.5)
        bins = [floor & (away > low) & (away <= low + 0.1) for low in np.arange(0, 0.6, 0.1)]
        curves.append([error[one].mean() for one in bins])
    assert np.ptp(curves, 0).max() < 0.01


def test_what_is_far_behind_has_no_halo(run):
    """A box before a wall that is farther than the radius leaves it open to the last pixel, and so does a denoiser."""
    camera, depth, normal, _ = taken((97, 61), [((1.0, 0.0, 0.0), 0.0)], eye=(6.0, 0.0, 0.0), target=(0.0, 0.0, 0.0))
    box = np.zeros(depth.shape, bool)
    box[20:40, 30:60] = True
    depth = np.where(box, 3.0, depth)
    for resolution in ("full", "half"):
        for mode in MODES:
            found = render(run, camera, depth, normal, radius=1.0, mode=mode, resolution=resolution)
            assert found.min() > (0.98 if mode == "crytek" else 0.9999), (mode, resolution)


def test_a_pit_is_as_symmetric_as_it_is(run):
    """Seen from above, the four walls of a pit are alike."""
    size = (121, 121)
    walls = [((1, 0, 0), -1), ((-1, 0, 0), -1), ((0, 1, 0), -1), ((0, -1, 0), -1)]
    camera, depth, normal, _ = taken(
        size, [((0, 0, 1), -1.0), *walls], eye=(0, 0, 3.0), target=(0, 0, 0), focal=1.1, up=(0, 1, 0)
    )
    found = render(run, camera, depth, normal, radius=1.0, quality="reference")
    assert found.min() < 0.4 and found.max() > 0.99
    for turns in (1, 2, 3):
        assert rms(found - np.rot90(found, turns)) < 0.01
    quarters = [np.rot90(found, turns)[:60, :60].mean() for turns in range(4)]
    assert np.ptp(quarters) < 2e-3


def test_nothing_is_open(run):
    camera, depth, normal, _ = corner((40, 30))
    for empty in (1e10, np.inf, 0.0, -1.0, np.nan):
        depth[:, :20] = empty
        for resolution in ("full", "half"):
            found = render(run, camera, depth, normal, resolution=resolution)
            assert np.all(found[:, :20] == 1.0) and np.all(np.isfinite(found))
            assert np.all(render(run, camera, depth, normal, output="bent_normal", resolution=resolution)[:, :20] == 0)


def test_bent_normals_lean_away_from_the_wall(run):
    camera, depth, normal, away = corner(SMALL)
    floor = inner(depth, 0.5) & (normal[..., 2] > 0.5) & (away < 0.2)
    for mode in MODES:
        bent = render(run, camera, depth, normal, output="bent_normal", mode=mode)[floor]
        assert np.allclose(np.linalg.norm(bent, axis=-1), 1, atol=1e-5)
        assert bent[:, 0].min() > 0.05 and np.abs(bent[:, 1]).mean() < 0.08, mode


def test_power_and_tint(run):
    camera, depth, normal, _ = corner((48, 27))
    once = render(run, camera, depth, normal)
    np.testing.assert_allclose(render(run, camera, depth, normal, power=2.5), once**2.5, rtol=1e-5)
    plain = render(run, camera, depth, normal, output="out")
    np.testing.assert_allclose(plain[..., :3], np.repeat(once[..., None], 3, -1), rtol=1e-6)
    assert np.all(plain[..., 3] == 1.0)
    albedo = np.broadcast_to(np.float32([0.8, 0.5, 0.1, 1.0]), (27, 48, 4))
    node = AmbientOcclusion(falloff=0.0, radius=0.5, multi_bounce=True)
    found = run(node, {"depth": depth, "normal": normal, "camera": camera, "albedo": albedo})
    color, once = albedo[..., :3].astype(float), once[..., None].astype(float)
    fit = (2.0404 * color - 0.3324) * once**3 + (0.6417 - 4.7951 * color) * once**2 + (2.7552 * color + 0.6903) * once
    np.testing.assert_allclose(found[..., :3], np.maximum(once, fit), atol=2e-6)


def test_falloff_only_opens(run):
    camera, depth, normal, away = corner(SMALL)
    hard = render(run, camera, depth, normal, denoise=False)
    soft = render(run, camera, depth, normal, falloff=0.6, denoise=False)
    assert np.all(soft >= hard - 1e-5) and (soft - hard)[away < 0.4].mean() > 0.01


def test_thin_things_let_light_through(run):
    """A board before a floor: the bitmask sees sky behind it, slices between two horizons do not."""
    camera, depth, normal, _ = taken(SMALL, [UP], eye=(0.0, -5.0, 3.0), target=(0.0, 0.0, 0.5))
    board = np.zeros(depth.shape, bool)
    board[40:46, 60:130] = True
    depth = np.where(board, depth - 0.6, depth)
    below = np.zeros(depth.shape, bool)
    below[50:54, 70:120] = True
    values = {"radius": 1.5}
    thick = render(run, camera, depth, normal, **values)[below].mean()
    thin = render(run, camera, depth, normal, mode="bitmask", thickness=0.02, **values)[below].mean()
    solid = render(run, camera, depth, normal, mode="bitmask", thickness=1e6, **values)[below].mean()
    assert abs(solid - thick) < 0.01 < thin - thick


@pytest.mark.parametrize(
    ("mode", "mean", "scatter"),
    [
        ("gtao", 0.002, 0.009),
        ("bitmask", 0.002, 0.009),
        ("hbao", 0.008, 0.016),
        ("hemisphere", 0.015, 0.034),
        ("crytek", 0.015, 0.048),
        ("alchemy", 0.012, 0.03),
    ],
)
def test_cycles_where_the_picture_shows_all_that_matters(run, mode, mean, scatter):
    """A box and a ball before a wall. `known`: the share of directions of which rays through the scene and through the
    picture say the same. Modes that do not go by the cosine are another measure, but not far from it."""
    data = blender("occlusion")
    camera, depth, normal = CameraModel(tuple(data["open_rows"].ravel())), data["open_depth"], data["open_normal"]
    found = render(run, camera, depth, normal, mode=mode, quality="reference", radius=0.6, denoise=False)
    error, known = found - data["open_share"].astype(float), data["open_known"] / 255.0
    assert (known > 0.99).mean() > 0.4 and data["open_share"][known > 0.99].min() < 0.6
    assert abs(error[known > 0.99].mean()) < mean and rms(error[known > 0.99]) < scatter
    if mode in ("gtao", "bitmask"):
        assert abs(error[known > 0.98].mean()) < 0.004 and rms(error[known > 0.98]) < 0.014
        worked = render(run, camera, depth, normal, mode=mode, radius=0.6) - data["open_share"].astype(float)
        assert abs(worked[known > 0.99].mean()) < 0.004 and rms(worked[known > 0.99]) < 0.01
