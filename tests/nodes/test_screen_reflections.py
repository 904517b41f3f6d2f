"""Screen-space reflections against rays that numpy casts at the same planes, and Schlick's formula."""

from __future__ import annotations

import numpy as np
import pytest
from geometry import ball, rays
from halation.nodes import CameraModel, look_at
from halation.nodes.light.screen_reflections import ScreenReflections

Array = np.ndarray
SIZE = (160, 90)
FLOOR, WALL = ((0.0, 0.0, 1.0), 0.0), ((0.0, -1.0, 0.0), -4.0)  # normals, and n . x on the plane
MIRROR = {"roughness": 0.0, "reflectance": 1.0, "border": 0.0, "distance": 1e6, "fade": 0.0}


def meet(eye: Array, way: Array, planes) -> tuple[Array, Array]:
    """How far along rays the first plane is that they meet from the front, and which."""
    found = []
    for normal, level in planes:
        with np.errstate(divide="ignore", invalid="ignore"):
            far = (level - eye @ np.array(normal)) / (way @ np.array(normal))
        found.append(np.where((far > 1e-9) & (way @ np.array(normal) < 0), far, np.inf))
    return np.min(found, 0), np.argmin(found, 0)


def taken(camera: CameraModel, planes, size=SIZE) -> tuple[Array, Array, Array, Array]:
    """Depth, normals, places and views of planes in double precision; 1e10 where nothing is."""
    way, eye = rays(camera, *size), np.array(camera.eye)
    depth, first = meet(eye, way, planes)
    there = np.isfinite(depth)
    place = eye + np.where(there, depth, 0.0)[..., None] * way
    normal = np.array([one for one, _ in planes])[first] * there[..., None]
    return np.where(there, depth, 1e10), normal, place, way / np.linalg.norm(way, axis=-1, keepdims=True)


def projected(camera: CameraModel, place: Array, size=SIZE) -> tuple[Array, Array]:
    """Pixel positions and depth."""
    rows = np.reshape(camera.rows, (3, 4))
    seen = place @ rows[:, :3].T + rows[:, 3]
    with np.errstate(divide="ignore", invalid="ignore"):
        return seen[..., :2] / seen[..., 2:] * size, seen[..., 2]


def ramp(size=SIZE) -> Array:
    """A picture that says where each pixel is."""
    y, x = np.mgrid[: size[1], : size[0]] + 0.5
    return np.dstack([x, y, np.ones_like(x), np.ones_like(x)])


def mirrored(run, camera, depth, normal=None, output="reflection", image=None, **values) -> Array:
    inputs = {"image": ramp(depth.shape[::-1]) if image is None else image, "depth": depth, "camera": camera}
    node = ScreenReflections(**(MIRROR | values))
    return run(node, inputs | ({} if normal is None else {"normal": normal}), output=output)


@pytest.mark.parametrize("eye", [(0.0, -4.0, 1.5), (1.5, -3.0, 0.8), (-2.0, -5.0, 3.0)])
@pytest.mark.parametrize("given", [True, False], ids=["normals", "depth alone"])
def test_a_mirror_before_a_wall(run, eye, given):
    """Every ray meets what analysis says, to a tenth of a pixel; those that leave the picture meet nothing."""
    camera = look_at(eye, (0.2, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    depth, normal, place, view = taken(camera, [FLOOR, WALL])
    floor = normal[..., 2] > 0.5
    assert 0.2 < floor.mean() < 0.9
    way = view * np.array([1.0, 1.0, -1.0])
    far, _ = meet(place, way, [WALL])
    expected, _ = projected(camera, place + np.minimum(far, 1e9)[..., None] * way)
    inside = ((expected > 1.0) & (expected < np.array(SIZE) - 1.0)).all(-1)
    outside = ((expected < -1.0) | (expected > np.array(SIZE) + 1.0)).any(-1)
    confidence = mirrored(run, camera, depth, normal if given else None, "confidence")[..., 0]
    found = mirrored(run, camera, depth, normal if given else None)[..., :2]
    assert (floor & inside).sum() > 500
    assert np.all(confidence[floor & inside] > 0.999) and np.all(confidence[floor & outside] == 0.0)
    error = np.abs(found - expected).max(-1)
    assert error[floor & inside].max() < 0.6
    y, x = np.mgrid[: SIZE[1], : SIZE[0]]
    own = (np.floor(expected) == np.dstack([x, y])).all(-1)  # a pixel cannot show both the floor and its wall
    assert error[floor & inside & ~own].max() < 0.05
    # The wall looks past the camera: what it mirrors is nearer than the picture shows.
    assert np.all(confidence[~floor & (view[..., 2] > -0.01)] == 0.0)


@pytest.mark.parametrize("tilt", [0.0, 30.0, 60.0, 80.0, 87.0, 89.0])
@pytest.mark.parametrize("turn", [0.0, 25.0, 90.0])
def test_planes_do_not_mirror_themselves(run, tilt, turn):
    """At any angle, at any distance, with rays that leave in any direction."""
    a, b = np.radians(tilt), np.radians(turn)
    normal = (np.sin(a) * np.cos(b), -np.cos(a), np.sin(a) * np.sin(b))
    for far in (0.3, 50.0):
        camera = look_at((0.0, -far, 0.0), (0.0, 0.0, 0.0), (1.0, 16 / 9))
        depth, normals, _, _ = taken(camera, [(normal, 0.0)])
        for given in (normals, None):
            found = mirrored(run, camera, depth, given, "confidence", sky=False)
            assert np.all(found == 0.0), far
        rough = mirrored(run, camera, depth, normals, "confidence", sky=False, roughness=0.6, quality="preview")
        assert np.all(rough == 0.0), far


@pytest.mark.parametrize("radius", [0.3, 1.0, 2.5])
def test_balls_do_not_mirror_themselves(run, radius):
    camera = look_at((0.0, -4.0, 0.5), (0.0, 0.0, 0.0), (1.0, 16 / 9))
    seen = ball(camera, (0.0, 0.0, 0.0), radius, *SIZE)
    for given in (seen["normal"], None):
        assert np.all(mirrored(run, camera, seen["depth"], given, "confidence", sky=False) == 0.0)


@pytest.mark.parametrize(
    ("eye", "center", "radius"),
    [
        ((0.0, -4.0, 1.5), (0.2, 0.5, 1.0), 0.9),
        ((1.5, -3.5, 0.8), (-0.3, 0.3, 0.7), 0.7),
    ],
)
def test_a_ball_mirrors_floor_and_wall(run, eye, center, radius):
    """Rays off a curved mirror, met by analysis wherever the picture shows what they meet."""
    camera = look_at(eye, (0.2, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    depth, normal, place, view = taken(camera, [FLOOR, WALL])
    seen = ball(camera, center, radius, *SIZE)
    there = seen["depth"] < depth
    depth = np.where(there, seen["depth"], depth)
    normal, place = (
        np.where(there[..., None], seen[name], plain) for name, plain in (("normal", normal), ("position", place))
    )
    way = view - 2.0 * (view * normal).sum(-1, keepdims=True) * normal
    far, _ = meet(place, way, [FLOOR, WALL])
    at, deep = projected(camera, place + np.minimum(far, 1e9)[..., None] * way)
    column, row = np.moveaxis(np.clip(np.nan_to_num(at).astype(int), 0, np.array(SIZE) - 1), -1, 0)
    shown = ((at > 1.0) & (at < np.array(SIZE) - 1.0)).all(-1) & (deep > 0.0) & ~there[row, column]
    sure = mirrored(run, camera, depth, normal, "confidence", sky=False)[..., 0]
    error = np.abs(mirrored(run, camera, depth, normal, sky=False)[..., :2] - at).max(-1)
    met = there & shown & (sure > 0.999)
    assert (there & shown).sum() > 150 and met.sum() > 0.99 * (there & shown).sum()
    assert np.median(error[met]) < 0.01 and np.quantile(error[met], 0.9) < 0.4
    assert (sure[there & ~shown] > 0.0).mean() < 0.035


def test_reflectance_is_schlicks(run):
    """The floor under an even picture that the sky closes: out is 1 + F (2 - 1), alone it is F 2."""
    camera = look_at((0.0, -4.0, 0.7), (0.0, 3.0, 0.6), (1.0, 16 / 9))
    depth, normal, _, view = taken(camera, [FLOOR])
    floor = depth < 1e9
    image = np.where(floor[..., None], np.float32([1, 1, 1, 1]), np.float32([2, 2, 2, 1]))
    base = {"reflectance": 0.04}
    sure = mirrored(run, camera, depth, normal, "confidence", image, **base)[..., 0]
    assert np.all(sure[~floor] == 0.0)
    whole = floor & (sure > 0.999)
    assert whole.sum() > 1000
    cosine = -view[..., 2]
    expected = 0.04 + 0.96 * (1.0 - cosine) ** 5
    assert expected[whole].min() < 0.5 and expected[whole].max() > 0.85
    alone = mirrored(run, camera, depth, normal, "reflection", image, **base)
    out = mirrored(run, camera, depth, normal, "out", image, **base)
    # The row under the horizon is mirrored to the row above it, half of which is floor.
    clear = whole & np.roll(whole, 3, 0) & (alone[..., 0] > 0)
    low = clear & (np.arange(SIZE[1])[:, None] > np.argmax(floor.any(1)) + 3)
    np.testing.assert_allclose(alone[low], expected[low][:, None] * [2, 2, 2, 1], rtol=2e-5)
    np.testing.assert_allclose(out[low][:, :3], (1 + expected[low])[:, None] * [1, 1, 1], rtol=2e-5)
    assert np.all(out[..., 3] == 1.0)
    half = mirrored(run, camera, depth, normal, "reflection", image, strength=0.5, **base)
    np.testing.assert_allclose(half, 0.5 * alone, atol=1e-6)
    under = mirrored(run, camera, depth, normal, "reflection", image, sky=False, **base)
    assert np.all(under == 0.0)


def test_reflection_over_the_picture_is_out(run, hdr):
    camera = look_at((0.0, -4.0, 1.5), (0.2, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    depth, normal, *_ = taken(camera, [FLOOR, WALL])
    image = hdr(*SIZE, opaque=True)
    values = {"reflectance": 0.1, "border": 20 / 90, "roughness": 0.2}
    out, alone = (mirrored(run, camera, depth, normal, one, image, **values) for one in ("out", "reflection"))
    np.testing.assert_allclose(out[..., :3], alone[..., :3] + (1 - alone[..., 3:]) * image[..., :3], rtol=1e-4)


def test_metal_tints_and_masks_hide(run):
    camera = look_at((0.0, -4.0, 1.5), (0.2, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    depth, normal, _, view = taken(camera, [FLOOR, WALL])
    flat = lambda *parts: np.broadcast_to(np.float32(parts), (*depth.shape, len(parts)))  # noqa: E731
    mask = np.ones(depth.shape)
    mask[:, :80] = 0.0
    inputs = {
        "image": flat(1, 1, 1, 1),
        "depth": depth,
        "normal": normal,
        "camera": camera,
        "material": flat(1, 0),
        "albedo": flat(0.9, 0.6, 0.2, 1),
        "mask": mask,
    }
    found = run(ScreenReflections(**MIRROR), inputs, output="reflection")
    sure = run(ScreenReflections(**MIRROR), inputs, output="confidence")[..., 0]
    whole = (sure > 0.999) & (normal[..., 2] > 0.5)
    color = np.array([0.9, 0.6, 0.2])
    expected = color + (1 - color) * ((1 + view[..., 2:]) ** 5)
    np.testing.assert_allclose(found[whole][:, :3], (mask[..., None] * expected)[whole], atol=1e-5)


@pytest.mark.parametrize(
    ("pattern", "pixels"),
    [
        ("above", [(62, 80), (66, 60), (70, 100), (75, 80)]),
        ("quarters", [(70, 76), (74, 76), (74, 80), (78, 80), (78, 84)]),
    ],
)
def test_rough_rays_scatter_as_ggx(run, pattern, pixels):
    """The mean over the lobe, by numpy's own sampling of GGX's facets, of a wall that is bright on one side, or in two
    quarters: of rays in one plane, askew, more would meet them."""
    camera = look_at((0.0, -4.0, 2.0), (0.0, 3.0, 1.0), (0.9, 0.9 * 16 / 9))
    depth, normal, place, view = taken(camera, [FLOOR, WALL])
    is_bright = lambda at: (at[..., 2] > 0.9) if pattern == "above" else ((at[..., 2] > 0.9) == (at[..., 0] > 0))  # noqa: E731
    bright = is_bright(place) & (normal[..., 1] < -0.5)
    image = np.where(bright[..., None], np.float32([1, 1, 1, 1]), np.float32([0, 0, 0, 1]))
    alpha, random = 0.3**2, np.random.default_rng(4)
    found = mirrored(
        run, camera, depth, normal, "out", image, roughness=0.3, reflectance=1.0, quality="reference", thickness=1e6
    )[..., 0]
    sure = mirrored(run, camera, depth, normal, "confidence", roughness=0.3, quality="reference")[..., 0]
    checked = 0
    for y, x in pixels:
        if normal[y, x, 2] < 0.5 or sure[y, x] < 0.9:
            continue
        u, turn = random.random(200000), 2 * np.pi * random.random(200000)
        slope = alpha * np.sqrt(u / (1 - u))  # facets as often as they are: D cos
        facet = np.stack([slope * np.cos(turn), slope * np.sin(turn), np.ones_like(u)], -1)
        facet /= np.linalg.norm(facet, axis=-1, keepdims=True)
        v = -view[y, x]
        vh = facet @ v
        way = 2 * vh[:, None] * facet - v
        nv, nl = v[2], np.maximum(way[:, 2], 1e-9)
        shadow = lambda c: 2 * c / (c + np.sqrt(c * c + alpha**2 * (1 - c * c)))  # noqa: E731
        weight = np.where((vh > 0) & (way[:, 2] > 0), shadow(nl) * vh * shadow(nv) / (nv * facet[:, 2]), 0.0)
        far, _ = meet(place[y, x], way, [WALL])
        with np.errstate(invalid="ignore"):
            hit = place[y, x] + far[:, None] * way
        at, _ = projected(camera, np.nan_to_num(hit, posinf=1e6, neginf=-1e6))
        seen = np.isfinite(far) & ((at > 0) & (at < SIZE)).all(-1)
        assert abs((weight * (seen & is_bright(hit))).sum() / weight.sum() - found[y, x]) < 0.03
        checked += 1
    assert checked >= 3


def test_fades_with_distance_and_border(run):
    camera = look_at((0.0, -4.0, 1.5), (0.2, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    depth, normal, place, view = taken(camera, [FLOOR, WALL])
    far, _ = meet(place, view * np.array([1.0, 1.0, -1.0]), [WALL])
    whole = mirrored(run, camera, depth, normal, "confidence")[..., 0] > 0.999
    whole &= normal[..., 2] > 0.5
    found = mirrored(run, camera, depth, normal, "confidence", distance=4.0, fade=0.5)[..., 0]
    np.testing.assert_allclose(found[whole], np.clip((4.0 - far[whole]) / 2.0, 0, 1), atol=2e-3)
    at = mirrored(run, camera, depth, normal)[..., :2]
    found = mirrored(run, camera, depth, normal, "confidence", border=0.2)[..., 0]
    inside = np.clip(np.minimum(at, np.array(SIZE) - at).min(-1) / (0.2 * SIZE[1]), 0, 1)
    whole &= inside * 0.2 * SIZE[1] > 0.51  # nearer to the border, colors do not say where they are from
    np.testing.assert_allclose(found[whole], (inside * inside * (3 - 2 * inside))[whole], atol=1e-4)


def test_nothing_mirrors_nothing(run):
    camera = look_at((0.0, -4.0, 1.5), (0.2, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    for empty in (1e10, np.inf, 0.0, -1.0, np.nan):
        depth = np.full(SIZE[::-1], empty)
        for roughness in (0.0, 0.5):
            assert np.all(mirrored(run, camera, depth, output="confidence", roughness=roughness) == 0.0)
            np.testing.assert_array_equal(
                mirrored(run, camera, depth, output="out", roughness=roughness), ramp().astype(np.float32)
            )


def far_rod(eye: Array, way: Array, radius: float) -> Array:
    """How far along rays they meet a rod over the floor, along x; infinite where they miss it."""
    out, ahead = eye[..., 1:] - np.array([0.0, 0.2]), way[..., 1:]
    square, half = (ahead**2).sum(-1), (out * ahead).sum(-1)
    under = half**2 - square * ((out**2).sum(-1) - radius**2)
    far = (-half - np.sqrt(np.maximum(under, 0.0))) / square
    return np.where((under > 0) & (far > 0), far, np.inf)


@pytest.mark.parametrize("radius", [0.04, 0.1])
def test_a_rod_mirrors_as_thick_as_it_is(run, radius):
    """Rays cast at the rod by numpy: the floor mirrors a rod, not a wall as deep as the largest thickness."""
    size = (320, 180)
    camera = look_at((0.0, -4.0, 1.5), (0.0, 3.0, 0.0), (1.2, 1.2 * 16 / 9))
    depth, normal, place, view = taken(camera, [FLOOR, WALL], size)
    way, eye = rays(camera, *size), np.array(camera.eye)
    near = far_rod(np.broadcast_to(eye, way.shape), way, radius)
    rod = near < depth
    depth = np.where(rod, near, depth)
    image = ramp(size)
    image[..., 2] = rod
    floor = (normal[..., 2] > 0.5) & ~rod
    normal[rod] = 0.0
    up = view * np.array([1.0, 1.0, -1.0])
    expected = np.isfinite(far_rod(place, up, radius))[floor]
    shown = mirrored(run, camera, depth, image=image, thickness=2.0)[floor][:, 2] > 0.5
    assert expected.sum() > 900
    assert (shown != expected).sum() <= 5 * size[0]  # rows: its two edges; a wall half a unit deep had 19 and 29


def test_rays_pass_behind_what_is_thin(run):
    """A board near the camera: rays from the floor far behind it pass, unless it is as thick as that: it is not, and
    what reaches the border may be.
    """
    camera = look_at((0.0, -4.0, 1.5), (0.0, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    depth, normal, *_ = taken(camera, [FLOOR, WALL])
    for across, down, least in ((np.s_[70:90], np.s_[50:58], 0), (np.s_[:], np.s_[:50], 100)):
        board = np.zeros(depth.shape, bool)
        board[down, across] = True
        far = np.where(board, 2.0, depth)
        facing = np.where(board[..., None], -np.array(camera.forward), normal)
        image = ramp()
        image[..., 2] = board
        floor = facing[..., 2] > 0.5
        seen = [
            (mirrored(run, camera, far, facing, image=image, thickness=most)[floor][:, 2] > 0.5).sum()
            for most in (0.01, 1e4)
        ]
        assert seen[0] == 0
        assert seen[1] == 0 if least == 0 else seen[1] > least


LAMP, LUMINANCE = (0.3, 1.6), 60.0


def lobe(normal_view: Array, alpha: float, random: np.random.Generator, count: int) -> tuple[Array, Array]:
    """Directions off a floor, by facets of GGX as often as they are, and their weights."""
    u, turn = random.random(count), 2 * np.pi * random.random(count)
    slope = alpha * np.sqrt(u / (1 - u))
    facet = np.stack([slope * np.cos(turn), slope * np.sin(turn), np.ones_like(u)], -1)
    facet /= np.linalg.norm(facet, axis=-1, keepdims=True)
    cosine = facet @ normal_view
    way = 2 * cosine[:, None] * facet - normal_view

    def lit(c: Array) -> Array:
        return 2 * c / (c + np.sqrt(c * c + alpha**2 * (1 - c * c)))

    up = np.maximum(way[:, 2], 1e-9)
    weight = lit(up) * cosine * lit(normal_view[2]) / (normal_view[2] * facet[:, 2])
    return way, np.where((cosine > 0) & (way[:, 2] > 0), weight, 0.0)


@pytest.mark.parametrize(("roughness", "radius", "most"), [(0.25, 0.06, 0.05), (0.4, 0.06, 0.06)])
def test_a_small_lamp_leaves_no_speckle(run, roughness, radius, most):
    camera = look_at((0.0, -4.0, 1.5), (0.2, 3.0, 0.9), (1.2, 1.2 * 16 / 9))
    depth, normal, place, view = taken(camera, [FLOOR, WALL])
    bright = (normal[..., 1] < -0.5) & (np.hypot(place[..., 0] - LAMP[0], place[..., 2] - LAMP[1]) < radius)
    image = np.where(bright[..., None], np.float32([LUMINANCE] * 3 + [1]), np.float32([0.1, 0.1, 0.1, 1]))
    node = ScreenReflections(roughness=roughness, reflectance=1.0, border=0.0, distance=1e6, fade=0.0, thickness=1e6)
    inputs = {"image": image, "depth": depth, "normal": normal, "camera": camera}
    light = run(node, inputs, output="reflection")[..., 0]
    random = np.random.default_rng(2)
    exact, noisy = [], []
    for y, x in np.argwhere(normal[..., 2] > 0.5):
        if y % 3 or x % 3 or not 40 < x < 120 or y > 84:
            continue
        way, weight = lobe(-view[y, x], roughness**2, random, 20000)
        far, _ = meet(place[y, x], way, [WALL])
        at, _ = projected(camera, place[y, x] + np.where(np.isfinite(far), far, 0.0)[:, None] * way)
        column, row = np.clip(np.nan_to_num(at), 0, np.array(SIZE) - 1).astype(int).T
        seen = np.isfinite(far) & ((at > 0) & (at < SIZE)).all(-1)
        exact.append((weight * seen * image[row, column, 0]).sum() / weight.sum())
        noisy.append(light[y, x])
    exact, noisy = np.array(exact), np.array(noisy)
    assert len(exact) > 150
    error = noisy - exact
    assert np.sqrt((error**2).mean()) < most
    assert abs(noisy.mean() / exact.mean() - 1.0) < 0.08
