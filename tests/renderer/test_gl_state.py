"""What a draw leaves of OpenGL's state, and what others have left there: a window library draws in the same context.

The reference is what OpenGL says of a picture without blending, depth and culling: each pixel is what its shader wrote.
"""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest
from halation.renderer import DeviceTexture, Renderer
from halation.renderer.device import Bindings
from halation.renderer.opengl.device import OpenGLDevice
from halation.resources.mesh import ATTRIBUTES, Mesh

SIZE = (6, 5)
WRITTEN = (0.25, -3.0, 7.0, 0.5)
"""What shaders write: neither covered nor between 0 and 1, so that whoever blends it changes it."""

LEFT = (4.0, 4.0, 4.0, 4.0)
"""What is in a texture before."""

FRAGMENT = f"""#version 410 core
layout(location = 0) out vec4 color;
void main() {{ color = vec4{WRITTEN}; }}
"""
TWO = FRAGMENT.replace("void main() {", "layout(location = 1) out vec4 other;\nvoid main() { other = vec4(1.0);")
BETWEEN = """#version 410 core
uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() { color = texture(picture, gl_FragCoord.xy / vec2(6.0, 5.0) * 3.0 - 1.0); }
"""
VERTEX = """#version 410 core
in vec3 place;
in vec3 albedo;
out vec3 tint;
void main() { gl_Position = vec4(place, 1.0); tint = albedo; }
"""
TINTED = """#version 410 core
in vec3 tint;
layout(location = 0) out vec4 color;
void main() { color = vec4(tint, 0.5); }
"""
COMPUTE = f"""#version 430 core
layout(local_size_x = 1) in;
layout(rgba32f, binding = 0) writeonly uniform image2D target;
uniform int first_row;
void main() {{ imageStore(target, ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row), vec4{WRITTEN}); }}
"""
FLAGS = {"blending": moderngl.BLEND, "depth": moderngl.DEPTH_TEST, "culling": moderngl.CULL_FACE}
FLAGS["all"] = moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE


@pytest.fixture
def device(renderer: Renderer) -> Iterator[OpenGLDevice]:
    """The device of the tests, with the state that it had."""
    device = renderer.device
    assert isinstance(device, OpenGLDevice)
    with device.make_current():
        device.take_error()
        yield device
        assert device.take_error() == ""
        device.context.disable(FLAGS["all"])
        device.context.cull_face = "back"


@pytest.fixture(params=FLAGS)
def left_on(request: pytest.FixtureRequest, device: OpenGLDevice) -> None:
    """What a window library has left on, as it is worst: sums of light, and both sides taken for the back."""
    device.context.enable(FLAGS[request.param])
    device.context.blend_func = moderngl.ONE, moderngl.ONE
    device.context.cull_face = "front_and_back"


def upload_texture(device: OpenGLDevice, pixels: np.ndarray) -> DeviceTexture:
    texture = device.create_texture((pixels.shape[1], pixels.shape[0]), 4, "f4")
    texture.write(pixels)
    return texture


def read_texture(device: OpenGLDevice, texture: DeviceTexture) -> np.ndarray:
    pixels = np.empty((*texture.size[::-1], 4), np.float32)
    device.finish()
    texture.read_into(pixels)
    return pixels


def fill(device: OpenGLDevice, color: tuple[float, ...] = LEFT) -> DeviceTexture:
    return upload_texture(device, np.full((SIZE[1], SIZE[0], 4), color, np.float32))


def make_wall(depth: float, light: float) -> list[list[float]]:
    """A triangle over all of the picture at a depth from -1 to 1, of this light."""
    values = {"place": (), "albedo": (light,) * 3}
    corners = [(-1.0, -1.0, depth), (3.0, -1.0, depth), (-1.0, 3.0, depth)]
    return [
        [*corner, *(n for name, size in list(ATTRIBUTES.items())[1:] for n in values.get(name, (0.0,) * size))]
        for corner in corners
    ]


@pytest.mark.usefixtures("left_on")
def test_a_pass_draws_what_its_shader_writes_whatever_others_left_on(device: OpenGLDevice) -> None:
    target, program = fill(device), device.create_program(FRAGMENT)
    device.draw(program, [target], Bindings())
    np.testing.assert_array_equal(read_texture(device, target), np.full((5, 6, 4), WRITTEN, np.float32))
    target.release(), program.release()


@pytest.mark.usefixtures("left_on")
@pytest.mark.parametrize("depths", [(-0.5, 0.5), (0.5, -0.5)])
def test_of_two_walls_the_nearer_one_is_seen_from_both_sides(device: OpenGLDevice, depths: tuple[float, float]) -> None:
    """In whatever order they come, and twice: the depth of the first picture is gone."""
    target, program = fill(device), device.create_program(TINTED, VERTEX)
    nearer = 1.0 if depths[0] < depths[1] else 2.0
    for order in (slice(None), slice(None, None, -1)):
        vertices = np.array([*make_wall(depths[0], 1.0)[order], *make_wall(depths[1], 2.0)[order]], np.float32)
        mesh = device.create_mesh(Mesh("walls", vertices, np.arange(6, dtype=np.uint32)))
        device.draw_mesh(program, [target], Bindings(), mesh)
        np.testing.assert_array_equal(
            read_texture(device, target), np.full((5, 6, 4), (nearer, nearer, nearer, 0.5), np.float32)
        )
        mesh.release()
    target.release(), program.release()


def test_where_no_triangle_is_a_picture_of_a_mesh_is_empty(device: OpenGLDevice) -> None:
    target, program = fill(device), device.create_program(TINTED, VERTEX)
    vertices = np.array(make_wall(0.0, 1.0), np.float32)
    vertices[:, 0] = np.array((-1.0, 0.0, -1.0)) + 1.0 / 3.0  # columns 1 to 4 at the bottom
    mesh = device.create_mesh(Mesh("wall", vertices, np.arange(3, dtype=np.uint32)))
    device.take_written()
    device.draw_mesh(program, [target], Bindings(), mesh)
    assert device.take_written() == {target.native_handle}
    found = read_texture(device, target)
    assert found[0, 2, 3] == 0.5 and not found[:, :1].any() and not found[:, 5:].any()
    mesh.release(), target.release(), program.release()


@pytest.mark.parametrize(
    ("part", "drawn"),
    [
        ({"viewport": (1, 2, 3, 2)}, (slice(2, 4), slice(1, 4))),
        ({"rows": (1, 3)}, (slice(1, 3), slice(None))),
        ({"rows": (4, 5)}, (slice(4, 5), slice(None))),
        ({"viewport": (0, 0, 6, 5)}, (slice(None), slice(None))),
    ],
    ids=str,
)
@pytest.mark.parametrize("count", [1, 2])
def test_a_part_is_drawn_and_the_next_draw_is_whole(
    device: OpenGLDevice, part: dict, drawn: tuple[slice, slice], count: int
) -> None:
    targets, program = [fill(device) for _ in range(count)], device.create_program(TWO if count == 2 else FRAGMENT)
    device.take_written()
    device.draw(program, targets, Bindings(), **part)
    assert device.take_written() == {target.native_handle for target in targets} and not device.take_written()
    for target, color in zip(targets, (WRITTEN, (1.0,) * 4), strict=False):
        expected = np.full((5, 6, 4), LEFT, np.float32)
        expected[drawn] = color
        np.testing.assert_array_equal(read_texture(device, target), expected)
    device.draw(program, targets, Bindings())
    for target, color in zip(targets, (WRITTEN, (1.0,) * 4), strict=False):
        np.testing.assert_array_equal(read_texture(device, target), np.full((5, 6, 4), color, np.float32))
    for each in (*targets, program):
        each.release()


def test_a_compute_program_writes_from_its_first_row_on(device: OpenGLDevice) -> None:
    target, program = fill(device), device.create_compute_program(COMPUTE)
    device.take_written()
    device.dispatch(program, [target], Bindings(), (6, 3, 1), reads_images=False, first_row=1)
    assert device.take_written() == {target.native_handle}
    expected = np.full((5, 6, 4), LEFT, np.float32)
    expected[1:4] = WRITTEN
    np.testing.assert_array_equal(read_texture(device, target), expected)
    target.release(), program.release()


def test_nothing_that_may_be_released_stays_bound(device: OpenGLDevice) -> None:
    """After a draw, a picture of a mesh and a clear, what others draw without a target of their own changes nothing."""
    target, program, solid = fill(device), device.create_program(FRAGMENT), device.create_program(TINTED, VERTEX)
    mesh = device.create_mesh(Mesh("wall", np.array(make_wall(0.0, 1.0), np.float32), np.arange(3, dtype=np.uint32)))
    uses = {
        "draw": lambda: device.draw(program, [target], Bindings()),
        "draw_mesh": lambda: device.draw_mesh(solid, [target], Bindings(), mesh),
        "clear": lambda: device.clear(target, LEFT),
    }
    for name, use in uses.items():
        use()
        before = read_texture(device, target)
        bound = device.context.fbo
        assert bound.size == (1, 1), f"{name} leaves a framebuffer of {bound.size} bound"
        device.context.clear(9.0, 9.0, 9.0, 9.0)
        np.testing.assert_array_equal(read_texture(device, target), before, err_msg=name)
    for each in (target, program, solid, mesh):
        each.release()


def test_a_draw_that_interpolates_leaves_textures_as_they_were(device: OpenGLDevice) -> None:
    """From a width left of a picture to one right of it, by numpy's clamped interpolation, and the nearest pixels."""
    across, down = np.array((1.0, 4.0, 2.0)), np.array((10.0, 30.0))
    pixels = np.repeat((across[None, :] + down[:, None])[..., None], 4, axis=2).astype(np.float32)
    picture, target, program = upload_texture(device, pixels), fill(device), device.create_program(BETWEEN)
    x, y = (3.0 * ((np.arange(count) + 0.5) / count) - 1.0 for count in SIZE)
    smooth = np.interp(3.0 * x - 0.5, range(3), across) + np.interp(2.0 * y - 0.5, range(2), down)[:, None]
    near = across[np.clip(np.floor(3.0 * x), 0, 2).astype(int)]
    near = near + down[np.clip(np.floor(2.0 * y), 0, 1).astype(int)][:, None]
    for interpolated in (False, True, False):
        device.draw(program, [target], Bindings([picture], interpolated=interpolated))
        expected = smooth if interpolated else near
        np.testing.assert_allclose(read_texture(device, target)[..., 0], expected, atol=0.1)  # of weights in 8 bits
    for each in (picture, target, program):
        each.release()


def test_a_region_is_read_as_it_lies_and_a_clear_fills_all(device: OpenGLDevice) -> None:
    pixels = np.random.default_rng(3).random((5, 6, 4), np.float32)
    texture = upload_texture(device, pixels)
    np.testing.assert_array_equal(device.read_region(texture, (2, 1, 3, 4)), pixels[1:5, 2:5])
    device.take_written()
    device.clear(texture, WRITTEN)
    assert device.take_written() == {texture.native_handle}
    np.testing.assert_array_equal(read_texture(device, texture), np.full((5, 6, 4), WRITTEN, np.float32))
    texture.release()
