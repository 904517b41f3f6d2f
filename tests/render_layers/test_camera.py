"""The camera comes back out of what it saw."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from halation.errors import InputError
from halation.media import LayerRequest, read_layers
from halation.nodes import CameraModel, Kind
from halation.nodes._declare.camera import look_at
from halation.render_layers.camera import measure_camera, read_header_camera, solve_camera
from halation.render_layers.report import measure_field_of_view
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import astuple
from raycast import cast_rays

ROOT = Path(__file__).parents[2]
WIDTH, HEIGHT = 96, 54
FOCAL = (1.1, 1.1 * WIDTH / HEIGHT)
CAMERA = look_at((2.0, -7.0, 2.5), (0.3, 2.0, 1.0), FOCAL)
SEEN = cast_rays(CAMERA, WIDTH, HEIGHT)
PIXELS = np.array([WIDTH, HEIGHT])


def off_center(camera: CameraModel) -> CameraModel:
    """The same with its axis at 0.3, 0.8 of the picture, as in a crop."""
    rows = np.reshape(camera.rows, (3, 4)) + np.outer((-0.2, 0.3, 0.0), camera.rows[8:12])
    return CameraModel(tuple(rows.ravel()))


def rolled(camera: CameraModel) -> CameraModel:
    """The same turned by 30 degrees about its axis; pixels are square."""
    rows = np.reshape(camera.rows, (3, 4)).copy()
    rows[:2] -= 0.5 * rows[2]
    across, down = rows[0] * WIDTH, rows[1] * HEIGHT
    c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
    rows[0], rows[1] = (c * across - s * down) / WIDTH, (s * across + c * down) / HEIGHT
    rows[:2] += 0.5 * rows[2]
    return CameraModel(tuple(rows.ravel()))


@pytest.mark.parametrize("camera", [CAMERA, off_center(CAMERA), rolled(CAMERA)])
def test_the_field_of_view_lies_between_the_rays_of_opposite_edges(camera: CameraModel) -> None:
    """As if the axis met the center, where it does not."""
    rows = np.reshape(camera.rows, (3, 4))[:, :3].copy()
    rows[:2] += np.subtract(0.5, camera.center)[:, None] * rows[2]
    left, right, top, bottom = (
        np.linalg.solve(rows, (*edge, 1.0)) for edge in ((0.0, 0.5), (1.0, 0.5), (0.5, 0.0), (0.5, 1.0))
    )
    angles = [
        math.degrees(math.acos(a @ b / (np.linalg.norm(a) * np.linalg.norm(b))))
        for a, b in ((left, right), (top, bottom))
    ]
    assert measure_field_of_view(camera) == pytest.approx(angles, rel=1e-6)


def layers(path: Path) -> list[np.ndarray]:
    wants = [LayerRequest("Position", Kind.VECTOR, 3), LayerRequest("Depth", Kind.FIELD)]
    return [pixels.array for pixels in read_layers(path, wants, sandbox=UNRESTRICTED)]


@pytest.mark.parametrize("camera", [CAMERA, off_center(CAMERA), rolled(CAMERA)], ids=["plain", "crop", "rolled"])
@pytest.mark.parametrize("with_depth", [False, True])
def test_exact_positions_give_the_exact_camera(camera: CameraModel, with_depth: bool) -> None:
    view = cast_rays(camera, WIDTH, HEIGHT)
    solved = solve_camera(view.position, view.depth if with_depth else None)
    assert np.allclose(solved.camera.rows, camera.rows, rtol=0.0, atol=1e-10)
    assert solved.residual < 1e-10 and solved.worst < 1e-9 and solved.share == 1.0


@pytest.mark.parametrize("name", ["presets/samples/neon.exr", "tests/data/blender45_multilayer.exr"])
@pytest.mark.parametrize("with_depth", [False, True])
def test_renders_give_theirs_to_a_ten_thousandth_of_a_pixel(name: str, with_depth: bool) -> None:
    position, depth = layers(ROOT / name)
    solved = solve_camera(position, depth[..., 0] if with_depth else None)
    assert solved.residual < 1e-4 and solved.worst < 1e-3 and solved.share > 0.99


def test_a_render_and_a_crop_of_another_version_have_the_same_camera() -> None:
    """Blender 5.0 in 480x270, and the rectangle of 88x60 at 120,90 of 320x180 by Blender 4.5; a lens of 38 mm on 36."""
    whole = solve_camera(layers(ROOT / "presets/samples/neon.exr")[0]).camera
    part = solve_camera(layers(ROOT / "tests/data/blender45_multilayer.exr")[0]).camera
    assert whole.focal == pytest.approx((38 / 36, 38 / 36 * 480 / 270), rel=1e-6)
    assert whole.center == pytest.approx((0.5, 0.5), abs=1e-5)
    assert part.focal == pytest.approx((38 / 36 * 320 / 88, 38 / 36 * 320 / 60), rel=1e-5)
    assert part.center == pytest.approx(((160 - 120) / 88, (90 - 90) / 60), abs=1e-4)
    assert np.allclose(part.eye, whole.eye, atol=2e-6) and np.allclose(part.forward, whole.forward, atol=2e-6)


@pytest.mark.parametrize("sky", [1e10, np.inf, -np.inf, np.nan, 0.0, 7.5])
def test_sky_is_left_out(sky: float) -> None:
    camera = look_at((2.0, -7.0, 2.5), (0.3, 2.0, 3.0), FOCAL)
    view = cast_rays(camera, WIDTH, HEIGHT)
    assert 0.3 < 1.0 - view.hit.mean() < 0.6
    position = np.where(view.hit[..., None], view.position, sky).astype(np.float32)
    solved = solve_camera(position)
    assert solved.residual < 1e-4 and np.allclose(solved.camera.eye, camera.eye, atol=1e-4)
    depth = np.where(view.hit, view.depth, sky if sky != 7.5 else 1e10)
    assert solve_camera(position, depth).residual < 1e-4


def test_silhouettes_averaged_with_what_is_behind_do_no_harm() -> None:
    """A renderer that filters positions: sky at 0 drags those of the edges far away."""
    four = cast_rays(CAMERA, 4 * WIDTH, 4 * HEIGHT)
    mixed = four.position.reshape(HEIGHT, 4, WIDTH, 4, 3).mean(axis=(1, 3))
    solved = solve_camera(mixed)
    assert solved.residual < 1e-2 and np.allclose(solved.camera.eye, CAMERA.eye, atol=0.02)
    exact = SEEN.position.copy()
    edges = np.random.default_rng(1).random((HEIGHT, WIDTH)) < 0.1
    exact[edges] *= np.random.default_rng(2).random((HEIGHT, WIDTH, 1))[edges]
    found = solve_camera(exact)
    assert found.residual < 1e-9 and 0.85 < found.share < 0.95
    assert np.allclose(found.camera.rows, CAMERA.rows, atol=1e-8)


def test_a_third_of_the_places_may_be_wrong() -> None:
    random = np.random.default_rng(3)
    wrong = random.random((HEIGHT, WIDTH)) < 0.33
    position = np.where(wrong[..., None], random.uniform(-9.0, 9.0, (HEIGHT, WIDTH, 3)), SEEN.position)
    solved = solve_camera(position)
    assert solved.residual < 1e-6 and np.allclose(solved.camera.eye, CAMERA.eye, atol=1e-4)


@pytest.mark.parametrize(("nearest", "farthest", "bound"), [(2.0, 20.0, 2e-3), (0.5, 500.0, 1e-3), (0.1, 1e4, 1e-3)])
def test_places_count_by_how_far_off_they_are_seen(nearest: float, farthest: float, bound: float) -> None:
    """Blocks at random depths, each place off by a tenth of a pixel: the far ones, off by the most, do not rule."""
    rows = np.reshape(CAMERA.rows, (3, 4))
    x, y = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH, (np.arange(HEIGHT) + 0.5) / HEIGHT)
    for seed in range(4):
        random = np.random.default_rng(seed)
        blocks = random.uniform(math.log(nearest), math.log(farthest), (HEIGHT // 6, WIDTH // 6))
        depth = np.exp(blocks.repeat(6, 0).repeat(6, 1) + random.normal(size=(HEIGHT, WIDTH)) * 0.05)
        places = np.linalg.solve(rows[:, :3], (np.stack([x * depth, y * depth, depth], -1) - rows[:, 3])[..., None])
        noise = random.normal(size=(HEIGHT, WIDTH, 3)) * 1e-3 * depth[..., None]
        solved = solve_camera(places[..., 0] + noise)
        assert np.allclose(solved.camera.eye, CAMERA.eye, rtol=0.0, atol=bound) and solved.residual < 0.14


def test_half_floats_still_tell_the_camera() -> None:
    solved = solve_camera(SEEN.position.astype(np.float16))
    assert solved.residual < 0.1 and np.allclose(solved.camera.eye, CAMERA.eye, atol=0.02)


@pytest.mark.parametrize(
    ("position", "words"),
    [
        (np.zeros((20, 30, 3)), "too few pixels"),
        (np.full((20, 30, 3), np.nan), "too few pixels"),
        (np.ones((1, 1, 3)), "too few pixels"),
        (np.random.default_rng(4).uniform(-1.0, 1.0, (40, 60, 3)), "no pinhole camera"),
        (cast_rays(look_at((0.0, 0.0, 9.0), (0.1, -3.0, 0.0), FOCAL), 40, 30).position, "in one plane"),
    ],
    ids=["zero", "nan", "one pixel", "noise", "plane"],
)
def test_what_no_camera_can_be_solved_from(position: np.ndarray, words: str) -> None:
    with pytest.raises(InputError, match=words):
        solve_camera(position)


def test_an_orthographic_camera_is_told() -> None:
    y, x = np.mgrid[0:40, 0:60] / 10.0
    with pytest.raises(InputError, match="no perspective"):
        solve_camera(np.stack([x, y, np.sin(x) * np.cos(y)], axis=-1))


def test_a_small_picture_has_a_camera() -> None:
    solved = solve_camera(cast_rays(CAMERA, 7, 5).position)
    assert np.allclose(solved.camera.eye, CAMERA.eye, atol=1e-8)


# --- cameras in headers -------------------------------------------------------------------------------------------


def row_vectors(matrix: np.ndarray) -> tuple[float, ...]:
    """A matrix for columns as Imath keeps it."""
    return tuple(map(float, matrix.T.ravel()))


def ndc(camera: CameraModel, unit: bool) -> tuple[float, ...]:
    """The world in coordinates from 0 to 1 downward, or from -1 to 1 upward, with OpenGL's third row."""
    rows = np.reshape(camera.rows, (3, 4))
    signed = rows if unit else np.array([[2.0, 0.0, -1.0], [0.0, -2.0, 1.0], [0.0, 0.0, 1.0]]) @ rows
    return row_vectors(3.0 * np.stack([signed[0], signed[1], 1.01 * rows[2] - (0.0, 0.0, 0.0, 0.2), rows[2]]))


def to_camera(camera: CameraModel, ahead: float) -> np.ndarray:
    """The world in the axes right, up and ahead (1) or back (-1)."""
    axes = np.stack([camera.right, -np.array(camera.down), ahead * np.array(camera.forward)])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = axes, -axes @ camera.eye
    return matrix


@pytest.mark.parametrize("name", ["worldToNDC", "worldtoNDC", "worldToScreen"])
@pytest.mark.parametrize("unit", [False, True])
def test_a_projection_in_the_header_is_the_camera(name: str, unit: bool) -> None:
    found = read_header_camera({name: ndc(CAMERA, unit)}, (WIDTH, HEIGHT))
    assert found is not None and np.allclose(found.rows, CAMERA.rows, atol=1e-12)


@pytest.mark.parametrize("ahead", [1.0, -1.0], ids=["left-handed", "right-handed"])
def test_a_place_and_a_width_in_the_header_are_the_camera(ahead: float) -> None:
    attributes = {
        "worldToCamera": row_vectors(to_camera(CAMERA, ahead)),
        "screenWindowWidth": 1.0 / FOCAL[0],
        "PixelAspectRatio": 1.0,
    }
    found = read_header_camera(attributes, (WIDTH, HEIGHT))
    assert found is not None and np.allclose(found.rows, CAMERA.rows, atol=1e-12)


@pytest.mark.parametrize(
    "attributes",
    [
        {},
        {"worldToNDC": "no"},
        {"worldToNDC": (0.0,) * 16},
        {"worldToNDC": (math.nan,) * 16},
        {"worldToNDC": row_vectors(np.eye(4))},
        {"worldToCamera": row_vectors(to_camera(CAMERA, 1.0))},
        {"worldToCamera": (0.0,) * 16, "screenWindowWidth": 2.0},
    ],
    ids=["none", "text", "zero", "nan", "orthographic", "no field of view", "zero place"],
)
def test_headers_that_name_no_camera(attributes: dict[str, object]) -> None:
    assert read_header_camera(attributes, (WIDTH, HEIGHT)) is None


def test_a_camera_that_is_known_is_checked() -> None:
    assert measure_camera(CAMERA, SEEN.position).residual < 1e-10
    wrong = look_at((2.1, -7.0, 2.5), (0.3, 2.0, 1.0), FOCAL)
    assert measure_camera(wrong, SEEN.position).residual > 0.1
    assert len(astuple(measure_camera(CAMERA, SEEN.position))) == 4
    with pytest.raises(InputError, match="too few"):
        measure_camera(CAMERA, np.zeros((4, 4, 3)))
