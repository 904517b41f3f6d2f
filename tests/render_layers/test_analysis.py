"""One look at a file says which layer is what, how it is meant, and which camera took it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.errors import InputError
from halation.media import LayerRequest, read_layers
from halation.nodes import CameraModel, Kind
from halation.nodes._declare.camera import look_at
from halation.render_layers.analysis import RenderAnalysis, analyze_render
from halation.render_layers.naming import RenderProgram, Role
from halation.resources.sandbox import UNRESTRICTED
from raycast import RaycastImage, cast_rays

ROOT = Path(__file__).parents[2]
NEON = ROOT / "presets/samples/neon.exr"
CROP = ROOT / "tests/data/blender45_multilayer.exr"
NEON_BEFORE = ROOT / "tests/data/blender50_frame_before.exr"
WIDTH, HEIGHT = 96, 54
CAMERA = look_at((2.0, -7.0, 2.5), (0.3, 2.0, 1.5), (1.1, 1.1 * WIDTH / HEIGHT))
BEFORE = look_at((1.9, -7.1, 2.45), (0.33, 2.0, 1.47), (1.1, 1.1 * WIDTH / HEIGHT))
SEEN = cast_rays(CAMERA, WIDTH, HEIGHT)


def written(
    path: Path,
    layers: Mapping[str, np.ndarray],
    attributes: Mapping[str, Any] | None = None,
    display: tuple[int, int, int, int] | None = None,
) -> Path:
    """`{"P.XYZ": array}` as one part of 32-bit floats."""
    names = [f"{name}.{letter}" for name, _, letters in (key.rpartition(".") for key in layers) for letter in letters]
    block = np.concatenate([np.atleast_3d(array) for array in layers.values()], axis=2).astype(np.float32)
    spec = oiio.ImageSpec(block.shape[1], block.shape[0], block.shape[2], "float")
    spec.channelnames = names
    if display:
        spec.x, spec.y, spec.full_width, spec.full_height = display
    for name, value in (attributes or {}).items():
        spec.attribute(name, *((oiio.TypeDesc("matrix"), value) if isinstance(value, tuple) else (value,)))
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), spec) and file.write_image(np.ascontiguousarray(block)) and file.close()
    return path


def ndc(camera: CameraModel) -> tuple[float, ...]:
    """The header's matrix for row vectors, from -1 to 1 upward."""
    rows = np.array([[2.0, 0.0, -1.0], [0.0, -2.0, 1.0], [0.0, 0.0, 1.0]]) @ np.reshape(camera.rows, (3, 4))
    return tuple(map(float, np.stack([rows[0], rows[1], rows[2], rows[2]]).T.ravel()))


def motion(view: RaycastImage = SEEN, before: CameraModel = BEFORE) -> np.ndarray:
    """Previous minus current in pixels, y up."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    rows = np.reshape(before.rows, (3, 4))
    then = view.position @ rows[:, :3].T + rows[:, 3]
    moved = then[..., :2] / then[..., 2:] * (WIDTH, HEIGHT) - np.stack([x, y], axis=-1)
    return np.where(view.hit[..., None], moved * (1.0, -1.0), 0.0)


def said(found: RenderAnalysis) -> dict[str, tuple[str, bool]]:
    return {role.value: (rule.kind, rule.is_measured) for role, rule in found.conventions.items()}


@pytest.mark.parametrize("path", [NEON, CROP], ids=["5.0", "4.5"])
def test_blender(path: Path) -> None:
    found = analyze_render(path, sandbox=UNRESTRICTED)
    assert found.maker.renderer is RenderProgram.BLENDER
    assert said(found) == {
        "depth": ("planar", True),
        "normal": ("world", True),
        "position": ("world", True),
        "velocity": ("from_previous", False),
    }
    assert found.conventions[Role.VELOCITY].scale == (-1.0, 1.0, -1.0, 1.0)
    assert found.camera.solution is not None and found.camera.solution.residual < 1e-3
    assert found.camera.camera.eye == pytest.approx((-0.2347826, -8.5043478, 2.2043478), abs=3e-6)


def test_the_motion_of_blender_is_proved_by_a_crop_of_the_frame_before() -> None:
    found = analyze_render(NEON, NEON_BEFORE, sandbox=UNRESTRICTED)
    motion = found.conventions[Role.VELOCITY]
    assert (motion.kind, motion.is_measured, motion.scale) == ("from_previous", True, (-1.0, 1.0, -1.0, 1.0))
    position, vector = (
        pixels.array.astype(np.float64)
        for pixels in read_layers(
            NEON,
            [LayerRequest("Position", Kind.VECTOR, 3), LayerRequest("Vector", Kind.VECTOR, 4)],
            sandbox=UNRESTRICTED,
        )
    )
    rows = np.reshape(analyze_render(NEON_BEFORE, sandbox=UNRESTRICTED).camera.camera.rows, (3, 4))
    then = position @ rows[:, :3].T + rows[:, 3]
    y, x = np.mgrid[0:270, 0:480] + 0.5
    moved = np.stack([x, y], axis=-1) - then[..., :2] / then[..., 2:] * (480, 270)
    apart = np.abs(vector[..., :2] * motion.scale[:2] - moved)
    assert np.median(apart) < 1e-3 and np.percentile(apart, 75) < 1e-3  # the ball moves by itself


@pytest.mark.parametrize("sign", [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)], ids=str)
def test_motion_of_any_sign_and_unit_is_found_in_flipped_copies_of_the_sample(tmp_path: Path, sign) -> None:
    """Under a name that says nothing: the cameras of both frames tell, to a ten thousandth of a pixel."""
    position, vector = (
        pixels.array.astype(np.float64)
        for pixels in read_layers(
            NEON,
            [LayerRequest("Position", Kind.VECTOR, 3), LayerRequest("Vector", Kind.VECTOR, 4)],
            sandbox=UNRESTRICTED,
        )
    )
    moved = vector[..., :2] * (-1.0, 1.0)
    for number, unit in enumerate(((1.0, 1.0), (480.0, 270.0), (240.0, 135.0))):  # pixels, pictures, half pictures
        layers = {"P.XYZ": position, "motionvector.XY": moved * sign / unit}
        found = analyze_render(
            written(tmp_path / f"{number}.exr", layers), NEON_BEFORE, sandbox=UNRESTRICTED
        ).conventions[Role.VELOCITY]
        assert (found.kind, found.is_measured) == ("from_previous", True)
        assert found.scale == (sign[0] * unit[0], sign[1] * unit[1])


def test_arnold_with_a_camera_in_its_header(tmp_path: Path) -> None:
    layers = {
        "beauty.RGB": SEEN.normal * 0.5 + 0.5,
        "P.XYZ": SEEN.position,
        "N.XYZ": SEEN.normal,
        "Z.Z": np.where(SEEN.hit, SEEN.depth, 1e30),
    }
    path = written(tmp_path / "a.exr", layers, {"arnold/version": "7.3", "worldToNDC": ndc(CAMERA)})
    found = analyze_render(path, sandbox=UNRESTRICTED)
    assert said(found) == {"depth": ("planar", True), "normal": ("world", True), "position": ("world", True)}
    assert np.allclose(found.camera.camera.rows, CAMERA.rows, atol=1e-5)
    assert found.camera.reason.startswith("solved from the positions; that of the header agrees to ")


def test_a_header_that_tells_another_camera_is_not_believed(tmp_path: Path) -> None:
    path = written(tmp_path / "a.exr", {"P.XYZ": SEEN.position}, {"worldToNDC": ndc(BEFORE)})
    found = analyze_render(path, sandbox=UNRESTRICTED)
    assert np.allclose(found.camera.camera.rows, CAMERA.rows, atol=1e-5)
    assert "px off and was not used" in found.camera.reason


def test_renderman_shades_in_the_axes_of_its_camera(tmp_path: Path) -> None:
    axes = np.stack([CAMERA.right, -np.array(CAMERA.down), CAMERA.forward])
    position = (SEEN.position - np.array(CAMERA.eye)) @ axes.T * SEEN.hit[..., None]
    layers = {"P.XYZ": position, "Nn.XYZ": SEEN.normal @ axes.T, "z.Z": SEEN.depth}
    found = analyze_render(
        written(tmp_path / "a.exr", layers, {"PRManVersion": "26.3", "worldToNDC": ndc(CAMERA)}), sandbox=UNRESTRICTED
    )
    assert said(found) == {
        "depth": ("planar", True),
        "normal": ("camera_ahead", True),
        "position": ("camera_ahead", True),
    }
    assert found.camera.camera.forward == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert found.camera.reason.endswith("the header tells where it stands in the world")


def test_the_header_stands_in_where_nothing_can_be_solved(tmp_path: Path) -> None:
    attributes = {"worldToNDC": ndc(CAMERA)}
    bare = analyze_render(written(tmp_path / "a.exr", {"rgba.RGB": SEEN.normal}, attributes), sandbox=UNRESTRICTED)
    assert bare.camera.reason == "named by the header" and np.allclose(bare.camera.camera.rows, CAMERA.rows, atol=1e-6)
    flat = analyze_render(
        written(tmp_path / "b.exr", {"P.XYZ": np.zeros((HEIGHT, WIDTH, 3))}, attributes), sandbox=UNRESTRICTED
    )
    assert flat.camera.reason == "named by the header (too few pixels have a position)"
    none = analyze_render(written(tmp_path / "c.exr", {"P.XYZ": np.zeros((HEIGHT, WIDTH, 3))}), sandbox=UNRESTRICTED)
    assert none.camera.camera is None and none.camera.reason == "too few pixels have a position"
    assert said(none) == {"position": ("world", False)}


def test_what_pixels_prove_counts_more_than_habits(tmp_path: Path) -> None:
    """Radial depth and normals of the camera under the names of a renderer that writes neither."""
    axes = np.stack([CAMERA.right, -np.array(CAMERA.down), -np.array(CAMERA.forward)])
    layers = {"P.XYZ": SEEN.position, "N.XYZ": SEEN.normal @ axes.T, "Z.Z": SEEN.distance}
    found = analyze_render(written(tmp_path / "a.exr", layers, {"arnold/version": "7.3"}), sandbox=UNRESTRICTED)
    assert said(found) == {"depth": ("radial", True), "normal": ("camera", True), "position": ("world", True)}


def test_depth_without_positions(tmp_path: Path) -> None:
    inverse = np.where(SEEN.hit, 1.0 / np.maximum(SEEN.depth, 1e-9), 0.0)
    for attributes in ({"nuke/version": "15"}, {}):
        found = analyze_render(
            written(tmp_path / f"{len(attributes)}.exr", {"depth.Z": inverse}, attributes), sandbox=UNRESTRICTED
        )
        assert said(found) == {"depth": ("inverse", True)}
    constant = np.full((HEIGHT, WIDTH), 0.5)
    assert said(
        analyze_render(written(tmp_path / "x.exr", {"depth.Z": constant}, {"nuke/version": "15"}), sandbox=UNRESTRICTED)
    ) == {"depth": ("inverse", False)}


def test_the_frame_before_tells_motion(tmp_path: Path) -> None:
    there = cast_rays(BEFORE, WIDTH, HEIGHT)
    now = written(tmp_path / "2.exr", {"P.XYZ": SEEN.position, "motionvector.XY": -motion() / WIDTH})
    then = written(tmp_path / "1.exr", {"P.XYZ": there.position, "motionvector.XY": motion()})
    assert analyze_render(now, sandbox=UNRESTRICTED).conventions[Role.VELOCITY].kind == ""
    found = analyze_render(now, then, sandbox=UNRESTRICTED).conventions[Role.VELOCITY]
    assert found.kind == "from_previous" and found.is_measured
    assert found.scale == pytest.approx((WIDTH, -WIDTH), rel=1e-3)


def test_cameras_prove_motion_only_where_both_are_solved(tmp_path: Path) -> None:
    """A camera that a header names, of either frame, is no proof; nor is a frame before without any camera."""
    layers = {"P.XYZ": SEEN.position, "motionvector.XY": motion()}
    bare, header, other = {"motionvector.XY": motion()}, {"worldToNDC": ndc(CAMERA)}, {"worldToNDC": ndc(BEFORE)}
    now = written(tmp_path / "2.exr", layers)
    named = written(tmp_path / "3.exr", bare, header)
    solved = written(tmp_path / "1.exr", {"P.XYZ": cast_rays(BEFORE, WIDTH, HEIGHT).position})
    for frame, before in (
        (now, written(tmp_path / "0.exr", bare, other)),
        (now, written(tmp_path / "0b.exr", bare)),
        (named, solved),
        (named, written(tmp_path / "0c.exr", bare, other)),
    ):
        assert not analyze_render(frame, before, sandbox=UNRESTRICTED).conventions[Role.VELOCITY].is_measured
    assert analyze_render(now, solved, sandbox=UNRESTRICTED).conventions[Role.VELOCITY].is_measured


def test_blender_motion_keeps_its_other_half(tmp_path: Path) -> None:
    four = np.concatenate([motion(), motion()], axis=2)
    now = written(tmp_path / "2.exr", {"Position.XYZ": SEEN.position, "Vector.XYZW": four}, {"Software": "Blender 4.5"})
    then = written(tmp_path / "1.exr", {"Position.XYZ": cast_rays(BEFORE, WIDTH, HEIGHT).position})
    found = analyze_render(now, then, sandbox=UNRESTRICTED).conventions[Role.VELOCITY]
    assert found.is_measured and found.scale == (-1.0, 1.0, -1.0, 1.0)


def test_pictures_tell_motion_where_positions_are_missing(tmp_path: Path) -> None:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.0

    def picture(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.stack([1.0 + np.sin(x / 3.0), 1.0 + np.cos(y / 4.0), 1.0 + np.sin((x + y) / 5.0)], axis=-1)

    vectors = np.tile((-3.0, 2.0), (HEIGHT, WIDTH, 1))
    now = written(tmp_path / "2.exr", {"rgba.RGB": picture(x - 3.0, y - 2.0), "motionvector.XY": vectors})
    then = written(tmp_path / "1.exr", {"rgba.RGB": picture(x, y)})
    assert analyze_render(now, then, sandbox=UNRESTRICTED).conventions[Role.VELOCITY].scale == (-1.0, 1.0)
    ahead = written(tmp_path / "3.exr", {"rgba.RGB": picture(x - 3.0, y - 2.0), "forward.UV": -vectors})
    found = analyze_render(ahead, then, sandbox=UNRESTRICTED).conventions[Role.VELOCITY]
    assert (found.kind, found.scale, found.is_measured) == ("to_next", (1.0, -1.0), True)


def test_the_frame_before_must_have_the_same_size(tmp_path: Path) -> None:
    small = written(tmp_path / "1.exr", {"rgba.RGB": np.zeros((3, 4, 3))})
    with pytest.raises(InputError, match=r"1\.exr: is 4x3 and .* is 480x270: name the frame before"):
        analyze_render(NEON, small, sandbox=UNRESTRICTED)
    with pytest.raises(InputError, match="there is no such file"):
        analyze_render(NEON, tmp_path / "0.exr", sandbox=UNRESTRICTED)


def test_a_data_window_moves_nothing(tmp_path: Path) -> None:
    part = SEEN.position[10:40, 20:80]
    found = analyze_render(
        written(tmp_path / "a.exr", {"P.XYZ": part}, display=(20, 10, WIDTH, HEIGHT)), sandbox=UNRESTRICTED
    )
    assert found.header.parts[0].data == (20, 10, 60, 30) and found.header.info.size == (WIDTH, HEIGHT)
    assert np.allclose(found.camera.camera.rows, CAMERA.rows, atol=1e-4)


def test_a_file_is_looked_at_once_until_it_changes(tmp_path: Path) -> None:
    path = written(tmp_path / "a.exr", {"Z.Z": SEEN.depth})
    first = analyze_render(path, sandbox=UNRESTRICTED)
    assert (
        analyze_render(path, sandbox=UNRESTRICTED) is first and analyze_render(str(path), sandbox=UNRESTRICTED) is first
    )
    written(path, {"N.XYZ": SEEN.normal})
    os.utime(path, ns=(1, 1))
    assert analyze_render(path, sandbox=UNRESTRICTED).find_layer(Role.NORMAL) is not None


def test_the_header_is_enough_for_the_roles(tmp_path: Path) -> None:
    """A file that is cut short tells its layers; only who asks for pixels hears of the damage."""
    path = tmp_path / "cut.exr"
    path.write_bytes(CROP.read_bytes()[:60000])
    found = analyze_render(path, sandbox=UNRESTRICTED)
    assert found.find_layer(Role.DEPTH).name == "Depth"
    for ask in ("camera", "conventions"):
        with pytest.raises(InputError, match=r"cut\.exr: is cut short or damaged"):
            getattr(found, ask)


def test_plain_pictures_have_a_survey_too(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    spec = oiio.ImageSpec(4, 3, 3, "uint8")
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), spec) and file.write_image(np.zeros((3, 4, 3), np.uint8)) and file.close()
    found = analyze_render(path, sandbox=UNRESTRICTED)
    assert found.find_layer(Role.BEAUTY) is not None and dict(found.conventions) == {} and found.camera.camera is None
