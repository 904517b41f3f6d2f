"""Pixels of a scene that is known exactly prove how they are meant, or nothing."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest
from halation.errors import InputError
from halation.nodes import CameraModel
from halation.nodes._declare.camera import look_at
from halation.render_layers import evidence
from halation.render_layers.camera import solve_camera
from halation.render_layers.conventions import Convention, DepthKind, MotionDirection, VectorSpace, find_habit
from halation.render_layers.naming import RenderProgram, Role
from raycast import RaycastImage, cast_rays

WIDTH, HEIGHT = 160, 90
FOCAL = (1.1, 1.1 * WIDTH / HEIGHT)
CAMERA = look_at((2.0, -7.0, 2.5), (0.3, 2.0, 2.0), FOCAL)
BEFORE = look_at((1.9, -7.1, 2.45), (0.33, 2.0, 1.97), FOCAL)
SEEN = cast_rays(CAMERA, WIDTH, HEIGHT)
WIDE = cast_rays(look_at((2.0, -7.0, 2.5), (0.3, 2.0, 0.5), (0.7, 0.7 * WIDTH / HEIGHT)), WIDTH, HEIGHT)
NEAR, FAR = 2.0, 20.0


def depth_of(view: RaycastImage, kind: str) -> np.ndarray:
    """What a renderer of that habit writes, sky included, in single precision."""
    with np.errstate(divide="ignore"):
        made = {
            "planar": np.where(view.hit, view.depth, 1e10),
            "radial": np.where(view.hit, view.distance, np.inf),
            "inverse": np.where(view.hit, 1.0 / view.depth, 0.0),
            "negative": np.where(view.hit, -view.depth, -np.inf),
            "normalized": np.where(view.hit, (view.depth - NEAR) / (FAR - NEAR), 1.0),
            "inverted": np.where(view.hit, np.clip((12.0 - view.depth) / 8.0, 0.0, 1.0), 0.0),
        }[kind]
    return made.astype(np.float32)


def axes_of(camera: CameraModel, ahead: float) -> np.ndarray:
    return np.stack([camera.right, -np.array(camera.down), ahead * np.array(camera.forward)])


# --- depth --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["planar", "radial", "inverse", "negative"])
def test_positions_tell_the_kind_of_depth(kind: str) -> None:
    found = evidence.match_depth_with_positions(depth_of(SEEN, kind), SEEN.position, CAMERA)
    assert found is not None and (found.kind, found.is_measured) == (kind, True)
    assert found.scale == ((-1.0,) if kind == "negative" else (1.0,))


@pytest.mark.parametrize(
    ("kind", "scale", "offset"),
    [("normalized", FAR - NEAR, NEAR), ("inverted", -8.0, 12.0)],
)
def test_positions_tell_what_0_and_1_stand_for(kind: str, scale: float, offset: float) -> None:
    found = evidence.match_depth_with_positions(depth_of(SEEN, kind), SEEN.position, CAMERA)
    assert found is not None and found.kind == DepthKind.NORMALIZED
    assert found.scale[0] == pytest.approx(scale, rel=1e-5) and found.offset[0] == pytest.approx(offset, rel=1e-5)
    assert f"0 is {offset:.4g} and 1 is {offset + scale:.4g}" in found.reason


@pytest.mark.parametrize(
    ("near", "far", "is_found"),
    [(2.0, 20.0, True), (9.0, 9.5, False), (-4e4, 4e4, False), (-1e3, 1e3, True)],
)
def test_a_depth_from_0_to_1_must_show_some_of_it(near: float, far: float, is_found: bool) -> None:
    """Between 9 and 9.5 lies less than a tenth of the picture; of 80,000 its depths use less than a thousandth."""
    depth = np.clip((np.where(SEEN.hit, SEEN.depth, far) - near) / (far - near), 0.0, 1.0)
    free = (depth > 0.0) & (depth < 1.0)
    assert (free.mean() < 0.1, np.ptp(depth[free]) < 1e-3) == (near == 9.0, near == -4e4)
    found = evidence.match_depth_with_positions(depth, SEEN.position, CAMERA)
    assert (found is not None and found.kind == DepthKind.NORMALIZED) == is_found


def test_other_numbers_are_no_depth() -> None:
    noise = np.random.default_rng(5).random((HEIGHT, WIDTH)).astype(np.float32)
    assert evidence.match_depth_with_positions(noise, SEEN.position, CAMERA) is None
    assert evidence.match_depth_with_positions(noise * 50.0, SEEN.position, CAMERA) is None
    assert evidence.match_depth_with_positions(noise, np.zeros((HEIGHT, WIDTH, 3)), CAMERA) is None


@pytest.mark.parametrize("kind", ["planar", "radial", "inverse", "negative"])
def test_planes_tell_the_kind_of_depth_without_positions(kind: str) -> None:
    found = evidence.judge_depth_by_planes(depth_of(WIDE, kind))
    assert found is not None and (found.kind, found.is_measured) == (kind, True)


@pytest.mark.parametrize(
    "depth",
    [
        np.zeros((40, 60)),
        np.full((40, 60), 3.0),
        np.full((40, 60), np.nan),
        np.ones((1, 1)),
        np.ones((2, 50)),
        np.random.default_rng(6).random((40, 60)),
        depth_of(WIDE, "normalized"),
    ],
    ids=["zero", "constant", "nan", "one pixel", "two rows", "noise", "normalized"],
)
def test_without_planes_nothing_is_claimed(depth: np.ndarray) -> None:
    assert evidence.judge_depth_by_planes(depth.astype(np.float32)) is None


# --- positions and normals ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("space", "ahead"), [(VectorSpace.CAMERA, -1.0), (VectorSpace.CAMERA_AHEAD, 1.0)])
def test_positions_in_the_axes_of_the_camera(space: VectorSpace, ahead: float) -> None:
    position = (SEEN.position - np.array(CAMERA.eye)) @ axes_of(CAMERA, ahead).T * SEEN.hit[..., None]
    solved = solve_camera(position).camera
    assert evidence.find_position_space(solved, position).kind == space
    normal = SEEN.normal @ axes_of(CAMERA, ahead).T
    found = evidence.match_normals_with_positions(normal, position, solved, space)
    assert found is not None and found.kind == space
    assert evidence.match_depth_with_positions(depth_of(SEEN, "planar"), position, solved).kind == DepthKind.PLANAR


def test_positions_in_the_world() -> None:
    found = evidence.find_position_space(CAMERA, SEEN.position)
    assert found.kind == VectorSpace.WORLD and "stands at 2, -7, 2.5" in found.reason


@pytest.mark.parametrize(
    ("space", "turned"),
    [
        (VectorSpace.WORLD, np.eye(3)),
        (VectorSpace.CAMERA, axes_of(CAMERA, -1.0)),
        (VectorSpace.CAMERA_AHEAD, axes_of(CAMERA, 1.0)),
    ],
)
@pytest.mark.parametrize("coded", [False, True])
def test_positions_tell_the_axes_of_normals(space: VectorSpace, turned: np.ndarray, coded: bool) -> None:
    normal = SEEN.normal @ turned.T
    normal = np.where(SEEN.hit[..., None], 0.5 * normal + 0.5, 0.0) if coded else normal
    found = evidence.match_normals_with_positions(normal.astype(np.float32), SEEN.position, CAMERA)
    assert found is not None and found.kind == space and found.is_measured
    assert (found.scale[0], found.offset[0]) == ((2.0, -1.0) if coded else (1.0, 0.0))


def test_a_camera_along_the_axes_leaves_normals_to_the_world() -> None:
    level = look_at((0.5, -7.0, 2.0), (0.5, 2.0, 2.0), FOCAL)
    view = cast_rays(level, WIDTH, HEIGHT)
    assert evidence.match_normals_with_positions(view.normal, view.position, level).kind == VectorSpace.WORLD


def test_other_vectors_are_no_normals() -> None:
    random = np.random.default_rng(7)
    noise = random.normal(size=(HEIGHT, WIDTH, 3))
    noise /= np.linalg.norm(noise, axis=2, keepdims=True)
    assert evidence.match_normals_with_positions(noise, SEEN.position, CAMERA) is None
    assert evidence.match_normals_with_positions(np.zeros_like(noise), SEEN.position, CAMERA) is None
    assert evidence.match_normals_with_positions(noise[:2], SEEN.position[:2], CAMERA) is None
    assert evidence.match_normals_with_positions(np.full_like(noise, np.nan), SEEN.position, CAMERA) is None


# --- motion -------------------------------------------------------------------------------------------------------


def motion() -> np.ndarray:
    """Current minus previous, in pixels, y down, by projecting every place into the frame before."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    rows = np.reshape(BEFORE.rows, (3, 4))
    then = SEEN.position @ rows[:, :3].T + rows[:, 3]
    moved = np.stack([x, y], axis=-1) - then[..., :2] / then[..., 2:] * (WIDTH, HEIGHT)
    return np.where(SEEN.hit[..., None], moved, 0.0)


@pytest.mark.parametrize("sign", [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)])
@pytest.mark.parametrize(
    ("unit", "words"),
    [
        ((1.0, 1.0), "in pixels,"),
        ((WIDTH, HEIGHT), "in pictures"),
        ((WIDTH / 2, HEIGHT / 2), "half pictures"),
        ((2.0, 2.0), "in pixels times 0.5"),
    ],
)
def test_two_cameras_tell_motion(sign: tuple[float, float], unit: tuple[float, float], words: str) -> None:
    stored = (motion() * sign / unit).astype(np.float32)
    found = evidence.match_velocity_with_cameras(stored, SEEN.position, CAMERA, BEFORE)
    assert found is not None and found.kind == MotionDirection.FROM_PREVIOUS and words in found.reason
    assert found.scale == pytest.approx(np.multiply(sign, unit), rel=1e-4)
    assert ("current minus previous" in found.reason) == (sign[0] > 0.0)
    assert ("y down" in found.reason) == (sign[0] == sign[1])


def test_what_moves_by_itself_does_not_mislead() -> None:
    stored = motion() * (-1.0, 1.0)
    stored[:, : WIDTH // 4] += 9.0
    found = evidence.match_velocity_with_cameras(stored, SEEN.position, CAMERA, BEFORE)
    assert found is not None and found.scale == (-1.0, 1.0)


def test_without_motion_nothing_is_claimed() -> None:
    still = np.zeros((HEIGHT, WIDTH, 2))
    assert evidence.match_velocity_with_cameras(still, SEEN.position, CAMERA, BEFORE) is None
    assert evidence.match_velocity_with_cameras(motion(), SEEN.position, CAMERA, CAMERA) is None
    assert evidence.match_velocity_with_cameras(motion()[::-1], SEEN.position, CAMERA, BEFORE) is None
    assert evidence.match_velocity_with_pictures(still, SEEN.normal, SEEN.normal) is None


@pytest.mark.parametrize("light", [0.1, 1.0, 30.0])
@pytest.mark.parametrize("sign", [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)])
def test_two_pictures_tell_motion(sign: tuple[float, float], light: float) -> None:
    """A smooth pattern, dark or bright, that moves by 3 to the right and 2 down from frame to frame."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.0

    def picture(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return light * np.stack([1.0 + np.sin(x / 3.0), 1.0 + np.cos(y / 4.0), 1.0 + np.sin((x + y) / 5.0)], axis=-1)

    stored = np.zeros((HEIGHT, WIDTH, 2)) + np.multiply((3.0, 2.0), sign)
    found = evidence.match_velocity_with_pictures(stored, picture(x - 3.0, y - 2.0), picture(x, y))
    assert found is not None and found.scale == sign and found.is_measured
    along, down = sign[0] > 0.0, sign[0] == sign[1]
    assert ("along with" if along else "against") in found.reason and f"y {'down' if down else 'up'}" in found.reason
    assert (
        evidence.match_velocity_with_pictures(stored, np.ones((HEIGHT, WIDTH, 3)), np.ones((HEIGHT, WIDTH, 3))) is None
    )


# --- anything ----------------------------------------------------------------------------------------------------


ODD = np.array([0.0, -0.0, 1.0, -1.0, 1e-45, 1e-38, 1e38, -1e38, np.inf, -np.inf, np.nan, 1e10, 0.5], np.float32)


@pytest.mark.parametrize("seed", range(12))
def test_whatever_numbers_there_are_nothing_breaks(seed: int) -> None:
    """Finite or not, of any size, in pictures of any shape; warnings are errors here."""
    random = np.random.default_rng(seed)
    height, width = random.integers(1, 60, 2)

    def numbers(channels: int) -> np.ndarray:
        usual = random.normal(size=(height, width, channels)) * 10.0 ** random.integers(-30, 9)
        share = random.choice([0.0, 0.2, 0.5, 1.0])
        odd = random.random((height, width, channels)) < share
        return np.where(odd, random.choice(ODD, (height, width, channels)), usual).astype(np.float32)

    depth, position, velocity = numbers(1)[..., 0], numbers(3), numbers(4)
    found = [
        evidence.match_depth_with_positions(depth, position, CAMERA),
        evidence.judge_depth_by_planes(depth),
        evidence.match_normals_with_positions(numbers(3), position, CAMERA),
        evidence.find_position_space(CAMERA, position),
        evidence.match_velocity_with_cameras(velocity, position, CAMERA, BEFORE),
        evidence.match_velocity_with_pictures(velocity, numbers(3), numbers(3)),
    ]
    assert all(rule is None or np.isfinite([*rule.scale, *rule.offset]).all() for rule in found)
    for known in (None, depth):
        with contextlib.suppress(InputError):
            assert np.isfinite(solve_camera(position, known).camera.rows).all()


# --- what is known of renderers -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("role", "name", "renderer", "kind"),
    [
        (Role.DEPTH, "ViewLayer.Depth", RenderProgram.BLENDER, "planar"),
        (Role.DEPTH, "hitdist", RenderProgram.KARMA, "radial"),
        (Role.DEPTH, "Pz", RenderProgram.KARMA, "negative"),
        (Role.DEPTH, "depth", RenderProgram.NUKE, "inverse"),
        (Role.DEPTH, "VRayZDepth", RenderProgram.VRAY, ""),
        (Role.DEPTH, "dd", RenderProgram.MITSUBA, "radial"),
        (Role.DEPTH, "Z", None, "planar"),
        (Role.DEPTH, "hitdist", None, "radial"),
        (Role.VELOCITY, "forward", None, "to_next"),
        (Role.POSITION, "P", None, "world"),
        (Role.NORMAL, "N", RenderProgram.ARNOLD, "world"),
        (Role.NORMAL, "Ng_camera", RenderProgram.KARMA, "camera"),
        (Role.NORMAL, "Nn", RenderProgram.RENDERMAN, "camera_ahead"),
        (Role.POSITION, "__Pworld", RenderProgram.RENDERMAN, "world"),
        (Role.VELOCITY, "Vector", RenderProgram.BLENDER, "from_previous"),
        (Role.VELOCITY, "forward", RenderProgram.NUKE, "to_next"),
        (Role.VELOCITY, "motionvector", RenderProgram.ARNOLD, ""),
    ],
)
def test_habits_of_renderers(role: Role, name: str, renderer: RenderProgram | None, kind: str) -> None:
    found = find_habit(role, name, renderer)
    assert found is not None and found.kind == kind and not found.is_measured and len(found.reason) > 10


def test_roles_without_conventions_have_none() -> None:
    assert find_habit(Role.BEAUTY, "Combined", RenderProgram.BLENDER) is None
    assert Convention("", "nobody knows").words == "not known"


def test_blender_velocity_becomes_current_minus_previous_with_y_down() -> None:
    """Vector is (previous - current, current - next) with y up; what it is scaled to is (v, v of the next frame)."""
    moved, moves = np.array([3.0, 2.0]), np.array([4.0, -1.0])  # current - previous, next - current, y down
    stored = np.array([-moved[0], moved[1], -moves[0], moves[1]])
    assert (stored * find_habit(Role.VELOCITY, "Vector", RenderProgram.BLENDER).scale == [*moved, *moves]).all()
